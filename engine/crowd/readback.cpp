// What the host asks of a crowd after the fact; each waits for the device.
#include "crowd/readback.h"

#include <algorithm>
#include <array>
#include <bit>
#include <span>
#include <utility>
#include <vector>

#include "crowd/gathering.h"
#include "crowd/page.h"
#include "crowd/record.h"
#include "crowd/watch.h"
#include "gpu/context.h"
#include "gpu/transfer.h"
#include "skitter/crowd.h"
#include "skitter/decode.h"
#include "skitter/error.h"

namespace skitter {
namespace {

using crowd::Gathering;
using crowd::Page;
using crowd::Part;

constexpr AgentSample kAll{};

// A page's watched agents come from its start; in the herd each has the place of its number.
void appendWatch(const Crowd::Impl& crowd, const Part& part, uint32_t offset, std::span<const float> slots,
                 std::vector<float>& watch) {
  const crowd::Watch now = crowd::watchAt(crowd.tick, crowd.watchEvery, *part.page);
  const auto floats = static_cast<size_t>(4 * shared::watchStride(part.kind->legs));
  const auto placeOf = [&](uint32_t agent) {
    return (size_t{offset} + part.firstAgent + agent - part.first) / crowd.watchEvery * floats;
  };
  watch.resize(placeOf(part.first + part.agents + crowd.watchEvery - 1));
  for (uint32_t slot = 0; slot < now.count; ++slot) {
    const uint32_t agent = now.first + slot * crowd.watchEvery;
    if (agent < part.first || agent >= part.first + part.agents) continue;
    std::copy_n(slots.begin() + static_cast<ptrdiff_t>(slot * floats), floats,
                watch.begin() + static_cast<ptrdiff_t>(placeOf(agent)));
  }
}

// A herd's, or a run's, agents as they are read.
class Reading {
 public:
  Reading(const Crowd::Impl& crowd, std::vector<Part> parts, const AgentSample& sample)
      : crowd_(crowd), parts_(std::move(parts)) {
    if (sample.stride == 0) throw inputError("a sample of agents with stride 0, expected at least 1");
    state_.tick = crowd.tick;
    state_.sample = sample;
    for (const Part& part : parts_)
      state_.agents += crowd::sampleOf(part.firstAgent, part.agents, sample).count;
  }

  void addRecords(std::span<const Record> records, Gathering& gathering) {
    for (const Record record : records)
      if (crowd::infoOf(record).per != crowd::Per::watched)
        gathering.add(crowd_, parts_, record, state_.sample, state_.of(record));
  }
  void addWatch(Gathering& gathering) { addBuffers(&Page::watch, watch_, gathering); }
  void addCounters(Gathering& gathering) { addBuffers(&Page::counters, counters_, gathering); }
  // The counters have been downloaded.
  void addFootfalls(Gathering& gathering) {
    events_.resize(parts_.size());
    for (size_t p = 0; p < parts_.size(); ++p) {
      const uint32_t count = std::min(counters_[p][shared::COUNTER_FOOTFALLS], parts_[p].page->footfallRoom);
      events_[p].resize(size_t{count} * 4 * shared::FOOTFALL_STRIDE);
      gathering.add(parts_[p].page->footfall, std::span(events_[p]));
    }
  }

  // The counters have been downloaded.
  uint64_t droppedFootfalls() const {
    uint64_t dropped = 0;
    for (size_t p = 0; p < parts_.size(); ++p) {
      const int row = shared::counterRow(static_cast<int>(parts_[p].row));
      dropped += counters_[p][static_cast<size_t>(row + shared::ROW_FOOTFALLS_DROPPED)];
    }
    return dropped;
  }
  std::vector<Footfall> footfalls() const {
    std::vector<Footfall> all;
    for (size_t p = 0; p < events_.size(); ++p) {
      const Part& part = parts_[p];
      for (std::span<const float> rest(events_[p]); !rest.empty();
           rest = rest.subspan(4 * shared::FOOTFALL_STRIDE)) {
        Footfall footfall = footfallOf(rest, part.page->firstAgent + part.first, crowd_.dt);
        if (footfall.agent >= part.agents) continue;
        footfall.agent += part.firstAgent;
        all.push_back(footfall);
      }
    }
    // The device appends them in any order.
    std::sort(all.begin(), all.end(), [](const Footfall& a, const Footfall& b) {
      return a.agent != b.agent ? a.agent < b.agent : a.leg < b.leg;
    });
    return all;
  }

  // Adds the rest of what Crowd::download gives. All of it has been downloaded.
  HerdState whole() && {
    state_.watchEvery = crowd_.watchEvery;
    state_.sleep = crowd_.options.sleep;
    state_.watched = crowd_.tick > 0 && crowd_.tick <= crowd_.watchUntil;
    state_.footfallsKept = keepsAllFootfalls();
    if (state_.footfallsKept) state_.footfalls = footfalls();
    if (!parts_.empty() && parts_.front().kind->trails)
      state_.trail = parts_.front().kind->trails->trailWords();
    return std::move(state_);
  }
  // Adds whom measure watches, too. The numbers of a run's agents in their kind say who these are.
  HerdState whole(const crowd::SizeRun& run) && {
    state_.watchOffset = run.firstAgent % crowd_.watchEvery;
    for (size_t p = 0; p < parts_.size(); ++p)
      if (parts_[p].page->watch) appendWatch(crowd_, parts_[p], state_.watchOffset, watch_[p], state_.watch);
    return std::move(*this).whole();
  }
  HerdState recordsAlone() && { return std::move(state_); }
  bool keepsAllFootfalls() const { return crowd_.options.footfalls > 0 && droppedFootfalls() == 0; }

 private:
  template <class T>
  void addBuffers(gpu::Buffer Page::*buffer, std::vector<std::vector<T>>& into, Gathering& gathering) {
    into.resize(parts_.size());
    for (size_t p = 0; p < parts_.size(); ++p) {
      into[p].resize((parts_[p].page->*buffer).size() / sizeof(T));
      gathering.add(parts_[p].page->*buffer, std::span(into[p]));
    }
  }

  const Crowd::Impl& crowd_;
  std::vector<Part> parts_;
  HerdState state_;
  // Part by part.
  std::vector<std::vector<float>> watch_, events_;
  std::vector<std::vector<uint32_t>> counters_;
};

// Reads what Crowd::download gives; what measure keeps of those whom it watches only where that is wanted.
void readAll(const Crowd::Impl& crowd, std::span<Reading> readings, bool wantsWatch) {
  crowd.context->waitIdle();
  Gathering gathering(*crowd.context);
  for (Reading& reading : readings) {
    reading.addRecords(allRecords, gathering);
    if (wantsWatch) reading.addWatch(gathering);
    if (crowd.options.footfalls > 0) reading.addCounters(gathering);
  }
  gathering.finish();
  for (Reading& reading : readings)
    if (reading.keepsAllFootfalls()) reading.addFootfalls(gathering);
  gathering.finish();
}

HerdState recordsOf(const Crowd::Impl& crowd, std::vector<Part> parts, std::span<const Record> records,
                    const AgentSample& sample) {
  crowd.context->waitIdle();
  Gathering gathering(*crowd.context);
  Reading reading(crowd, std::move(parts), sample);
  reading.addRecords(records, gathering);
  gathering.finish();
  return std::move(reading).recordsAlone();
}

Reading countersOf(const Crowd::Impl& crowd, uint32_t herd) {
  crowd.context->waitIdle();
  Gathering gathering(*crowd.context);
  Reading reading(crowd, crowd::partsOf(crowd, herd), kAll);
  reading.addCounters(gathering);
  gathering.finish();
  return reading;
}

}  // namespace

namespace crowd {

HerdState downloadRecords(const Crowd::Impl& crowd, uint32_t herd, std::span<const Record> records,
                          const AgentSample& sample) {
  return recordsOf(crowd, partsOf(crowd, herd), records, sample);
}

std::vector<HerdState> downloadRecords(const Crowd::Impl& crowd, std::span<const Record> records,
                                       const AgentSample& sample) {
  crowd.context->waitIdle();
  Gathering gathering(*crowd.context);
  std::vector<Reading> readings;
  for (uint32_t herd = 0; herd < crowd.herds.size(); ++herd)
    readings.emplace_back(crowd, partsOf(crowd, herd), sample);
  for (Reading& reading : readings) reading.addRecords(records, gathering);
  gathering.finish();
  std::vector<HerdState> states;
  for (Reading& reading : readings) states.push_back(std::move(reading).recordsAlone());
  return states;
}

uint32_t presentIn(const Crowd::Impl& crowd, const SizeRun& run) {
  constexpr std::array body{Record::body};
  const HerdState state = recordsOf(crowd, partsOf(crowd, run), body, kAll);
  uint32_t count = 0;
  for (size_t agent = 0; agent < state.agents; ++agent)
    count += state.body[agent * 4 * shared::BODY_STRIDE + 7] == 0;
  return count;
}

std::vector<HerdState> download(const Crowd::Impl& crowd, std::span<const HerdRun> runs,
                                std::span<const AgentSample> samples) {
  std::vector<Reading> readings;
  for (size_t r = 0; r < runs.size(); ++r)
    readings.emplace_back(crowd, partsOf(crowd, *runs[r].run), samples.empty() ? kAll : samples[r]);
  readAll(crowd, readings, true);
  std::vector<HerdState> states;
  for (size_t r = 0; r < runs.size(); ++r) states.push_back(std::move(readings[r]).whole(*runs[r].run));
  return states;
}

HerdState download(const Crowd::Impl& crowd, const SizeRun& run, const AgentSample& sample) {
  Reading reading(crowd, partsOf(crowd, run), sample);
  readAll(crowd, {&reading, 1}, true);
  return std::move(reading).whole(run);
}

}  // namespace crowd

HerdState Crowd::download(uint32_t herd, const AgentSample& sample) const {
  const std::vector<crowd::SizeRun>& runs = impl_->herdAt(herd).runs;
  if (runs.size() == 1) return crowd::download(*impl_, runs.front(), sample);
  Reading reading(*impl_, crowd::partsOf(*impl_, herd), sample);
  readAll(*impl_, {&reading, 1}, false);
  return std::move(reading).whole();
}

std::vector<Reaction> Crowd::reactions(uint32_t herd) const {
  constexpr std::array records = {Record::reaction};
  const HerdState state = crowd::downloadRecords(*impl_, herd, records);
  std::vector<Reaction> all(state.agents);
  for (size_t agent = 0; agent < all.size() && !state.reaction.empty(); ++agent) {
    const float* record = state.reaction.data() + agent * 4 * shared::REACTION_STRIDE;
    all[agent] = {.phase = static_cast<ReactionPhase>(record[0]),
                  .falls = static_cast<uint32_t>(record[16]),
                  .stands = static_cast<uint32_t>(record[17]),
                  .down = record[18],
                  .downBefore = record[19]};
  }
  return all;
}

std::vector<Search> Crowd::searches(uint32_t herd) const {
  constexpr std::array records = {Record::search};
  const HerdState state = crowd::downloadRecords(*impl_, herd, records);
  std::vector<Search> all(state.agents);
  for (size_t agent = 0; agent < all.size() && !state.search.empty(); ++agent) {
    const float* record = state.search.data() + agent * 4 * shared::SEARCH_STRIDE;
    all[agent] = {.phase = static_cast<SearchPhase>(record[2]),
                  .trials = static_cast<uint32_t>(record[3]),
                  .best = record[7]};
  }
  return all;
}

std::vector<Footfall> Crowd::footfalls(uint32_t herd) const {
  Reading reading = countersOf(*impl_, herd);
  if (impl_->options.footfalls == 0) return {};
  Gathering gathering(*impl_->context);
  reading.addFootfalls(gathering);
  gathering.finish();
  return reading.footfalls();
}

uint64_t Crowd::droppedFootfalls(uint32_t herd) const { return countersOf(*impl_, herd).droppedFootfalls(); }

std::vector<FootfallBuffer> Crowd::footfallBuffers(uint32_t herd) const {
  std::vector<FootfallBuffer> buffers;
  for (const crowd::SizeRun& run : impl_->herdAt(herd).runs)
    for (const Part& part : crowd::partsOf(*impl_, run))
      buffers.push_back({.events = part.page->footfall.handle(),
                         .counters = part.page->counters.handle(),
                         .countOffset = shared::COUNTER_FOOTFALLS * 4,
                         .room = part.page->footfallRoom,
                         .firstAgent = run.firstAgent,
                         .agents = run.agents,
                         .firstOfHerd = run.firstOfHerd});
  return buffers;
}

uint64_t Crowd::sleeping() const {
  impl_->context->waitIdle();
  if (!impl_->options.sleep || impl_->tick == 0) return 0;
  uint64_t awake = 0;
  for (uint32_t k = 0; k < impl_->kinds.size(); ++k) {
    const std::vector<crowd::HerdRun> runs = crowd::runsOf(*impl_, k);
    // A herd that has just come was in no tick.
    if (runs.empty() || runs.front().herd->since >= impl_->tick) continue;
    for (const Page& page : impl_->kinds[k].pages)
      awake += gpu::download<uint32_t>(*impl_->context, page.counters)[shared::COUNTER_AWAKE];
  }
  return impl_->agentsInTick > awake ? impl_->agentsInTick - awake : 0;
}

uint64_t Crowd::stateHash() const {
  impl_->context->waitIdle();
  Gathering gathering(*impl_->context);
  std::vector<float> records;
  uint64_t hash = 0xcbf29ce484222325ull;  // FNV-1a, a word at a time
  const auto add = [&](uint32_t word) {
    hash = (hash ^ word) * 0x100000001b3ull;
    hash ^= hash >> 32;
  };
  for (uint32_t herd = 0; herd < herdCount(); ++herd) {
    const std::vector<Part> parts = crowd::partsOf(*impl_, herd);
    if (parts.empty()) continue;
    // Record by record over the herd, not page by page: how agents are paged must not show.
    for (const Record record : allRecords) {
      if (!crowd::isHashed(record, parts.front().kind->controller)) continue;
      gathering.add(*impl_, parts, record, kAll, records);
      gathering.finish();
      for (const float value : records) add(std::bit_cast<uint32_t>(value));
    }
    if (parts.front().kind->trails)
      for (const uint32_t word : parts.front().kind->trails->trailWords()) add(word);
  }
  return hash;
}

}  // namespace skitter
