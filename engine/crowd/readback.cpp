// What the host asks of a crowd after the fact; each waits for the device.
#include "crowd/readback.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <span>

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

using crowd::Page;
using crowd::Part;

constexpr AgentSample kAll{};

// Appends the sample's records of the part, agent after agent and, of an agent, leg after leg. legs = 0:
// there is one per agent.
void appendRecords(const gpu::Context& context, const Part& part, const gpu::Buffer& buffer, int legs,
                   const AgentSample& sample, std::vector<float>& records) {
  if (!buffer) return;
  const crowd::RunSample here = crowd::sampleOf(part.firstAgent, part.agents, sample);
  if (here.count == 0) return;
  const uint32_t first = part.first + here.first, last = first + (here.count - 1) * sample.stride;
  const auto anAgent = static_cast<uint64_t>(std::max(1, legs));
  const uint64_t held = legs > 0 ? crowd::wholeBlocks(part.page->agents) * anAgent : part.page->agents;
  const uint64_t each = buffer.size() / held;
  const size_t end = records.size();
  records.resize(end + here.count * anAgent * each / sizeof(float));
  const auto bytes = std::as_writable_bytes(std::span(records).subspan(end));
  if (legs == 0 && sample.stride == 1) {
    gpu::downloadBytes(context, buffer, bytes, first * each);
    return;
  }
  std::vector<uint64_t> places;
  places.reserve(here.count * anAgent);
  for (uint32_t i = 0; i < here.count; ++i) {
    const auto agent = static_cast<int>(first + i * sample.stride);
    for (int leg = 0; leg < static_cast<int>(anAgent); ++leg)
      places.push_back(each * static_cast<uint64_t>(legs > 0 ? shared::legRecord(agent, leg, legs) : agent));
  }
  if (sample.stride > 1) {
    gpu::downloadPieces(context, buffer, bytes, places, each);
    return;
  }
  // The blocks that hold the agents.
  const uint64_t begin = first / shared::BLOCK * shared::BLOCK * anAgent * each;
  std::vector<std::byte> blocks(crowd::wholeBlocks(last + 1) * anAgent * each - begin);
  gpu::downloadBytes(context, buffer, blocks, begin);
  for (size_t i = 0; i < places.size(); ++i)
    std::memcpy(bytes.data() + i * each, blocks.data() + places[i] - begin, each);
}

// A page's watched agents come from its start; in the herd each has the place of its number.
void appendWatch(const Crowd::Impl& crowd, const Part& part, uint32_t offset, std::vector<float>& watch) {
  const crowd::Watch now = crowd::watchAt(crowd.tick, crowd.watchEvery, *part.page);
  const auto floats = static_cast<size_t>(4 * shared::watchStride(part.kind->legs));
  const std::vector<float> slots = gpu::download<float>(*crowd.context, part.page->watch);
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

HerdState recordsOf(const Crowd::Impl& crowd, std::span<const Part> parts, std::span<const Record> records,
                    const AgentSample& sample) {
  if (sample.stride == 0) throw inputError("a sample of agents with stride 0, expected at least 1");
  crowd.context->waitIdle();
  HerdState state;
  state.tick = crowd.tick;
  state.sample = sample;
  for (const Part& part : parts) {
    state.agents += crowd::sampleOf(part.firstAgent, part.agents, sample).count;
    for (const Record record : records) {
      const crowd::Per per = crowd::infoOf(record).per;
      if (per == crowd::Per::watched || !crowd::keeps(*part.kind, crowd.options, record)) continue;
      appendRecords(*crowd.context, part, part.page->of(record), per == crowd::Per::leg ? part.kind->legs : 0,
                    sample, state.of(record));
    }
  }
  return state;
}

uint64_t droppedFootfallsOf(const Crowd::Impl& crowd, std::span<const Part> parts) {
  crowd.context->waitIdle();
  uint64_t dropped = 0;
  for (const Part& part : parts) dropped += crowd::rowOf(*crowd.context, part)[shared::ROW_FOOTFALLS_DROPPED];
  return dropped;
}

std::vector<Footfall> footfallsOf(const Crowd::Impl& crowd, std::span<const Part> parts) {
  const gpu::Context& context = *crowd.context;
  context.waitIdle();
  std::vector<Footfall> all;
  if (crowd.options.footfalls == 0) return all;
  for (const Part& part : parts) {
    const Page& page = *part.page;
    const uint32_t count = gpu::download<uint32_t>(context, page.counters)[shared::COUNTER_FOOTFALLS];
    std::vector<float> events(size_t{std::min(count, page.footfallRoom)} * 4 * shared::FOOTFALL_STRIDE);
    gpu::downloadBytes(context, page.footfall, std::as_writable_bytes(std::span(events)));
    for (size_t i = 0; i < std::min(count, page.footfallRoom); ++i) {
      Footfall footfall = footfallOf(std::span(events).subspan(i * 4 * shared::FOOTFALL_STRIDE),
                                     page.firstAgent + part.first, crowd.dt);
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

// All but what measure keeps of those whom it watches.
HerdState stateOf(const Crowd::Impl& crowd, std::span<const Part> parts, const AgentSample& sample) {
  HerdState state = recordsOf(crowd, parts, allRecords, sample);
  state.watchEvery = crowd.watchEvery;
  state.sleep = crowd.options.sleep;
  state.watched = crowd.tick > 0 && crowd.tick <= crowd.watchUntil;
  state.footfallsKept = crowd.options.footfalls > 0 && droppedFootfallsOf(crowd, parts) == 0;
  if (state.footfallsKept) state.footfalls = footfallsOf(crowd, parts);
  if (!parts.empty() && parts.front().kind->trails) state.trail = parts.front().kind->trails->trailWords();
  return state;
}

}  // namespace

namespace crowd {

HerdState downloadRecords(const Crowd::Impl& crowd, uint32_t herd, std::span<const Record> records,
                          const AgentSample& sample) {
  return recordsOf(crowd, partsOf(crowd, herd), records, sample);
}

uint32_t presentIn(const Crowd::Impl& crowd, const SizeRun& run) {
  constexpr std::array body{Record::body};
  const HerdState state = recordsOf(crowd, partsOf(crowd, run), body, kAll);
  uint32_t count = 0;
  for (size_t agent = 0; agent < state.agents; ++agent)
    count += state.body[agent * 4 * shared::BODY_STRIDE + 7] == 0;
  return count;
}

HerdState download(const Crowd::Impl& crowd, const SizeRun& run, const AgentSample& sample) {
  const std::vector<Part> parts = partsOf(crowd, run);
  HerdState state = stateOf(crowd, parts, sample);
  state.watchOffset = run.firstAgent % crowd.watchEvery;
  for (const Part& part : parts)
    if (part.page->watch) appendWatch(crowd, part, state.watchOffset, state.watch);
  return state;
}

}  // namespace crowd

HerdState Crowd::download(uint32_t herd, const AgentSample& sample) const {
  const std::vector<crowd::SizeRun>& runs = impl_->herdAt(herd).runs;
  if (runs.size() == 1) return crowd::download(*impl_, runs.front(), sample);
  return stateOf(*impl_, crowd::partsOf(*impl_, herd), sample);
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
  return footfallsOf(*impl_, crowd::partsOf(*impl_, herd));
}

uint64_t Crowd::droppedFootfalls(uint32_t herd) const {
  return droppedFootfallsOf(*impl_, crowd::partsOf(*impl_, herd));
}

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
  const gpu::Context& context = *impl_->context;
  context.waitIdle();
  std::vector<float> records;
  uint64_t hash = 0xcbf29ce484222325ull;  // FNV-1a, a word at a time
  const auto add = [&](uint32_t word) {
    hash = (hash ^ word) * 0x100000001b3ull;
    hash ^= hash >> 32;
  };
  for (uint32_t herd = 0; herd < herdCount(); ++herd) {
    const std::vector<Part> parts = crowd::partsOf(*impl_, herd);
    // Record by record over the herd, not page by page: how agents are paged must not show.
    for (const Record record : allRecords)
      for (const Part& part : parts) {
        if (!crowd::isHashed(record, part.kind->controller)) continue;
        records.clear();
        appendRecords(context, part, part.page->of(record),
                      crowd::infoOf(record).per == crowd::Per::leg ? part.kind->legs : 0, kAll, records);
        for (const float value : records) add(std::bit_cast<uint32_t>(value));
      }
    if (!parts.empty() && parts.front().kind->trails)
      for (const uint32_t word : parts.front().kind->trails->trailWords()) add(word);
  }
  return hash;
}

}  // namespace skitter
