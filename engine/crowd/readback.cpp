// What the host asks of a crowd after the fact; each waits for the device.
#include <algorithm>
#include <bit>
#include <cassert>
#include <cstring>
#include <initializer_list>
#include <span>

#include "crowd/page.h"
#include "crowd/watch.h"
#include "gpu/context.h"
#include "gpu/transfer.h"
#include "skitter/crowd.h"

namespace skitter {
namespace {

using crowd::Page;

constexpr AgentSample kAll{};

// Of a page's records those of the sample, agent after agent and of an agent leg after leg; legs = 0: one an
// agent.
void appendRecords(const gpu::Context& context, const Page& page, const gpu::Buffer& buffer, int legs,
                   const AgentSample& sample, std::vector<float>& records) {
  if (!buffer) return;
  const crowd::PageSample here = crowd::sampleOf(page, sample);
  const auto anAgent = static_cast<uint64_t>(std::max(1, legs));
  const uint64_t held = legs > 0 ? crowd::wholeBlocks(page.agents) * anAgent : page.agents;
  const uint64_t each = buffer.size() / held;
  const size_t end = records.size();
  records.resize(end + here.count * anAgent * each / sizeof(float));
  const auto bytes = std::as_writable_bytes(std::span(records).subspan(end));
  if (legs == 0 && sample.stride == 1) {
    gpu::downloadBytes(context, buffer, bytes, here.first * each);
    return;
  }
  std::vector<uint64_t> places;
  places.reserve(here.count * anAgent);
  for (uint32_t i = 0; i < here.count; ++i)
    for (int leg = 0; leg < static_cast<int>(anAgent); ++leg) {
      const auto agent = static_cast<int>(here.first + i * sample.stride);
      places.push_back(static_cast<uint64_t>(legs > 0 ? shared::legRecord(agent, leg, legs) : agent));
    }
  if (sample.stride > 1) {
    for (uint64_t& place : places) place *= each;
    gpu::downloadPieces(context, buffer, bytes, places, each);
    return;
  }
  const std::vector<std::byte> all = gpu::download<std::byte>(context, buffer);
  for (size_t i = 0; i < places.size(); ++i)
    std::memcpy(bytes.data() + i * each, all.data() + places[i] * each, each);
}

// A page's watched agents come from its start; in the herd each has the place of its number.
void appendWatch(const Crowd::Impl& crowd, const crowd::Herd& herd, const Page& page,
                 std::vector<float>& watch) {
  const crowd::Watch now = crowd::watchAt(crowd.tick, crowd.watchEvery, page);
  const auto floats = static_cast<size_t>(4 * shared::watchStride(herd.legs));
  const std::vector<float> slots = gpu::download<float>(*crowd.context, page.watch);
  watch.resize(((size_t{page.firstAgent} + page.agents + crowd.watchEvery - 1) / crowd.watchEvery) * floats);
  const size_t first = (size_t{page.firstAgent} + now.first) / crowd.watchEvery * floats;
  std::copy_n(slots.begin(), now.count * floats, watch.begin() + static_cast<ptrdiff_t>(first));
}

}  // namespace

HerdState Crowd::download(uint32_t herdIndex, const AgentSample& sample) const {
  assert(sample.stride > 0);
  impl_->context->waitIdle();
  HerdState state;
  state.tick = impl_->tick;
  state.sample = sample;
  state.watchEvery = impl_->watchEvery;
  state.sleep = impl_->options.sleep;
  state.watched = impl_->tick > 0 && impl_->tick <= impl_->watchUntil;
  const crowd::Herd& herd = impl_->herds.at(herdIndex);
  for (const Page& page : herd.pages) {
    const auto append = [&](const gpu::Buffer& buffer, std::vector<float>& records, int legs = 0) {
      appendRecords(*impl_->context, page, buffer, legs, sample, records);
    };
    state.agents += crowd::sampleOf(page, sample).count;
    append(page.goal, state.goal);
    append(page.steer, state.steer);
    append(page.body, state.body);
    append(page.gait, state.gait);
    append(page.step, state.step, herd.legs);
    append(page.arc, state.arc, herd.legs);
    if (crowd::hasFootRecords(herd, impl_->options)) append(page.foot, state.foot, herd.legs);
    append(page.chain, state.chain, herd.legs);
    append(page.miss, state.miss);
    if (crowd::keepsFeet(impl_->options)) append(page.tip, state.tip, herd.legs);
    append(page.pose, state.pose);
    append(page.metric, state.metric);
    append(page.play, state.play);
    append(page.start, state.start, herd.legs);
    append(page.fix, state.fix, herd.legs);
    append(page.spring, state.spring, herd.legs);
    if (page.watch) appendWatch(*impl_, herd, page, state.watch);
  }
  state.footfallsKept = impl_->options.footfalls > 0 && droppedFootfalls(herdIndex) == 0;
  if (state.footfallsKept) state.footfalls = footfalls(herdIndex);
  return state;
}

std::vector<Footfall> Crowd::footfalls(uint32_t herd) const {
  const gpu::Context& context = *impl_->context;
  context.waitIdle();
  std::vector<Footfall> all;
  if (impl_->options.footfalls == 0) return all;
  for (const Page& page : impl_->herds.at(herd).pages) {
    const uint32_t count = gpu::download<uint32_t>(context, page.counters)[shared::COUNTER_FOOTFALLS];
    std::vector<float> events(size_t{std::min(count, page.footfallRoom)} * 4 * shared::FOOTFALL_STRIDE);
    gpu::downloadBytes(context, page.footfall, std::as_writable_bytes(std::span(events)));
    for (size_t i = 0; i < std::min(count, page.footfallRoom); ++i) {
      const float* e = events.data() + i * 4 * shared::FOOTFALL_STRIDE;
      all.push_back({static_cast<uint32_t>(e[4]), static_cast<uint32_t>(e[5]), static_cast<uint64_t>(e[6]),
                     double{e[6]} * impl_->dt, glm::vec3(e[0], e[1], e[2]), e[3]});
    }
  }
  // The device appends them in any order.
  std::sort(all.begin(), all.end(), [](const Footfall& a, const Footfall& b) {
    return a.agent != b.agent ? a.agent < b.agent : a.leg < b.leg;
  });
  return all;
}

uint64_t Crowd::droppedFootfalls(uint32_t herd) const {
  impl_->context->waitIdle();
  uint64_t dropped = 0;
  for (const Page& page : impl_->herds.at(herd).pages)
    dropped += gpu::download<uint32_t>(*impl_->context, page.counters)[shared::COUNTER_FOOTFALLS_DROPPED];
  return dropped;
}

std::vector<FootfallBuffer> Crowd::footfallBuffers(uint32_t herd) const {
  std::vector<FootfallBuffer> buffers;
  for (const Page& page : impl_->herds.at(herd).pages)
    buffers.push_back(
        {page.footfall.handle(), page.counters.handle(), shared::COUNTER_FOOTFALLS * 4, page.footfallRoom});
  return buffers;
}

uint64_t Crowd::sleeping() const {
  impl_->context->waitIdle();
  if (!impl_->options.sleep || impl_->tick == 0) return 0;
  uint64_t sleeping = agentCount();
  for (const crowd::Herd& herd : impl_->herds)
    for (const Page& page : herd.pages)
      sleeping -= gpu::download<uint32_t>(*impl_->context, page.counters)[shared::COUNTER_AWAKE];
  return sleeping;
}

uint64_t Crowd::stateHash() const {
  const gpu::Context& context = *impl_->context;
  context.waitIdle();
  std::vector<float> records;
  uint64_t hash = 0xcbf29ce484222325ull;  // FNV-1a, a word at a time
  for (const crowd::Herd& herd : impl_->herds) {
    struct Hashed {
      gpu::Buffer Page::*buffer;
      int legs = 0;
    };
    const std::initializer_list<Hashed> kinds = {{&Page::goal},
                                                 {&Page::body},
                                                 {&Page::gait},
                                                 {&Page::step, herd.legs},
                                                 {&Page::arc, herd.legs},
                                                 {&Page::chain, herd.legs},
                                                 {&Page::miss},
                                                 {&Page::play},
                                                 {&Page::spring, herd.legs}};
    // Record by record over the herd, not page by page: how agents are paged must not show.
    for (const Hashed& kind : kinds)
      for (const Page& page : herd.pages) {
        records.clear();
        appendRecords(context, page, page.*kind.buffer, kind.legs, kAll, records);
        for (const float value : records) {
          hash = (hash ^ std::bit_cast<uint32_t>(value)) * 0x100000001b3ull;
          hash ^= hash >> 32;
        }
      }
  }
  return hash;
}

}  // namespace skitter
