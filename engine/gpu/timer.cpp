#include "gpu/timer.h"

#include <algorithm>
#include <cassert>
#include <cstring>

namespace skitter::gpu {

StageTimer::StageTimer(const Context& context, uint32_t maxStages, bool enabled)
    : context_(&context), maxStages_(maxStages) {
  entries_.reserve(maxStages);
  if (!enabled || !context.timestamps() || maxStages == 0) return;
  pool_ = guarded("the stage timer", [&] {
    return vk::raii::QueryPool(
        context.device(),
        vk::QueryPoolCreateInfo{.queryType = vk::QueryType::eTimestamp, .queryCount = 2 * maxStages});
  });
  context.name(*pool_, "stage timer");
}

void StageTimer::reset(vk::CommandBuffer cmd) {
  entries_.clear();
  stamps_ = 0;
  measuring_ = wanted_;
  if (measures()) cmd.resetQueryPool(*pool_, 0, 2 * maxStages_);
}

// After all earlier work, or a stage would be charged with the tail of the one before.
uint32_t StageTimer::stamp(vk::CommandBuffer cmd) {
  if (measures()) cmd.writeTimestamp2(vk::PipelineStageFlagBits2::eAllCommands, *pool_, stamps_);
  return stamps_++;
}

StageTimer::Entry* StageTimer::open() {
  const auto found =
      std::find_if(entries_.rbegin(), entries_.rend(), [](const Entry& e) { return e.ended == kOpen; });
  return found == entries_.rend() ? nullptr : &*found;
}

void StageTimer::begin(vk::CommandBuffer cmd, const char* stage) {
  if (!context_) return;
  context_->beginLabel(cmd, stage);
  assert(entries_.size() < maxStages_);
  entries_.push_back({stage, stamp(cmd), kOpen});
}

void StageTimer::end(vk::CommandBuffer cmd, [[maybe_unused]] const char* stage) {
  if (!context_) return;
  Entry* const entry = open();
  assert(entry && std::strcmp(entry->stage, stage) == 0);
  entry->ended = stamp(cmd);
  context_->endLabel(cmd);
}

void StageTimer::next(vk::CommandBuffer cmd, const char* stage) {
  if (!context_) return;
  Entry* const last = open();
  if (!last) return begin(cmd, stage);
  context_->endLabel(cmd);
  context_->beginLabel(cmd, stage);
  assert(entries_.size() < maxStages_);
  last->ended = stamp(cmd);
  entries_.push_back({stage, last->ended, kOpen});
}

std::vector<StageTime> StageTimer::milliseconds() const {
  if (!measures() || entries_.empty()) return {};
  std::vector<uint64_t> ticks(stamps_);
  const vk::Result result = guarded("the stage timer", [&] {
    return (*context_->device())
        .getQueryPoolResults(*pool_, 0, uint32_t(ticks.size()), ticks.size() * sizeof(uint64_t), ticks.data(),
                             sizeof(uint64_t), vk::QueryResultFlagBits::e64);
  });
  if (result != vk::Result::eSuccess) {
    throw deviceError("the stage timer: " + vk::to_string(result));
  }
  const uint32_t bits = context_->limits().timestampBits;
  const uint64_t mask = bits >= 64 ? ~0ull : (1ull << bits) - 1;
  std::vector<StageTime> times;
  for (const Entry& entry : entries_) {
    assert(entry.ended != kOpen);
    const uint64_t elapsed = (ticks[entry.ended] - ticks[entry.began]) & mask;
    times.push_back({entry.stage, double(elapsed) * context_->limits().timestampPeriod * 1e-6});
  }
  return times;
}

}  // namespace skitter::gpu
