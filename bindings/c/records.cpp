#include <algorithm>

#include "bindings/c/handles.h"

using namespace skitter;
using c::crowdOf;
using c::given;
using c::guarded;

namespace {

static_assert(4 * shared::FOOTFALL_STRIDE == 8 && shared::GOAL_STRIDE == 2);  // as the header says

Record recordOf(skitter_record record) {
  const int number = static_cast<int>(record);
  if (number < 0 || static_cast<size_t>(number) >= allRecords.size())
    throw inputError(fmt::format("record is {}, expected a skitter_record", number));
  return static_cast<Record>(number);
}

skitter_record_buffer bufferFrom(const RecordBuffer& buffer) {
  return {.buffer = buffer.buffer,
          .offset = buffer.offset,
          .bytes = buffer.bytes,
          .first_agent = buffer.firstAgent,
          .agents = buffer.agents,
          .first = buffer.first,
          .stride = buffer.stride,
          .legs = buffer.legs};
}

skitter_footfall_buffer footfallsFrom(const FootfallBuffer& buffer) {
  return {.events = buffer.events,
          .counters = buffer.counters,
          .count_offset = buffer.countOffset,
          .room = buffer.room,
          .first_agent = buffer.firstAgent,
          .agents = buffer.agents,
          .first_of_herd = buffer.firstOfHerd};
}

skitter_goal_buffer goalsFrom(const GoalBuffer& buffer) {
  return {.goals = buffer.goals,
          .first = buffer.first,
          .first_agent = buffer.firstAgent,
          .agents = buffer.agents};
}

}  // namespace

skitter_result skitter_crowd_buffers(const skitter_crowd* crowd, uint32_t herd, skitter_record record,
                                     skitter_record_buffer* buffers, size_t room, size_t* count) {
  return guarded([&] {
    const Crowd& asked = crowdOf(crowd);
    c::Told<skitter_record_buffer> told(buffers, room, "buffers", count);
    told.write(asked.buffers(herd, recordOf(record)), bufferFrom);
  });
}

skitter_result skitter_record_at(const skitter_record_buffer* buffer, uint32_t agent, uint32_t leg,
                                 uint32_t* at) {
  return guarded([&] {
    const skitter_record_buffer& in = given(buffer, "buffer");
    given(at, "at");
    if (agent < in.first_agent || agent - in.first_agent >= in.agents)
      throw inputError(fmt::format("agent is {}, expected one of the page's {} from {} on", agent, in.agents,
                                   in.first_agent));
    if (leg >= std::max(in.legs, 1u))
      throw inputError(fmt::format("leg is {}, expected less than {}", leg, std::max(in.legs, 1u)));
    const RecordBuffer page{
        .firstAgent = in.first_agent, .first = in.first, .stride = in.stride, .legs = in.legs};
    *at = page.recordAt(agent, leg);
  });
}

skitter_result skitter_crowd_footfall_buffers(const skitter_crowd* crowd, uint32_t herd,
                                              skitter_footfall_buffer* buffers, size_t room, size_t* count) {
  return guarded([&] {
    const Crowd& asked = crowdOf(crowd);
    c::Told<skitter_footfall_buffer> told(buffers, room, "buffers", count);
    told.write(asked.footfallBuffers(herd), footfallsFrom);
  });
}

skitter_result skitter_crowd_goal_buffers(const skitter_crowd* crowd, uint32_t herd,
                                          skitter_goal_buffer* buffers, size_t room, size_t* count) {
  return guarded([&] {
    const Crowd& asked = crowdOf(crowd);
    c::Told<skitter_goal_buffer> told(buffers, room, "buffers", count);
    told.write(asked.goalBuffers(herd), goalsFrom);
  });
}

skitter_result skitter_crowd_records(const skitter_crowd* crowd, uint32_t herd, skitter_record record,
                                     float* numbers, size_t room, size_t* count) {
  return guarded([&] {
    const Crowd& asked = crowdOf(crowd);
    given(count, "count");
    if (room > 0) given(numbers, "numbers");
    const std::vector<float> records = bindings::recordsOf(asked, herd, recordOf(record));
    if (room > 0) c::checkRoom("numbers", room, records.size());
    *count = records.size();
    if (room > 0) std::ranges::copy(records, numbers);
  });
}
