// What the host asks of a crowd after the fact; each waits for the device.
#include <algorithm>
#include <cassert>
#include <span>

#include "crowd/page.h"
#include "crowd/watch.h"
#include "gpu/context.h"
#include "gpu/transfer.h"
#include "skitter/crowd.h"

namespace skitter {
namespace {

using crowd::Page;

void appendRecords(const gpu::Context& context, const Page& page, const gpu::Buffer& buffer,
                   const AgentSample& sample, std::vector<float>& records) {
  if (!buffer) return;
  const uint64_t each = buffer.size() / page.agents;
  const crowd::PageSample here = crowd::sampleOf(page, sample);
  const size_t end = records.size();
  records.resize(end + here.count * each / sizeof(float));
  const auto bytes = std::as_writable_bytes(std::span(records).subspan(end));
  if (sample.stride == 1)
    gpu::downloadBytes(context, buffer, bytes, here.first * each);
  else
    gpu::downloadPieces(context, buffer, bytes, here.first * each, each, sample.stride * each);
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
  state.sample = sample;
  state.watchEvery = impl_->watchEvery;
  state.watched = impl_->tick > 0 && impl_->tick <= impl_->watchUntil;
  const crowd::Herd& herd = impl_->herds.at(herdIndex);
  for (const Page& page : herd.pages) {
    const auto append = [&](const gpu::Buffer& buffer, std::vector<float>& records) {
      appendRecords(*impl_->context, page, buffer, sample, records);
    };
    state.agents += crowd::sampleOf(page, sample).count;
    append(page.goal, state.goal);
    append(page.steer, state.steer);
    append(page.body, state.body);
    append(page.gait, state.gait);
    append(page.step, state.step);
    append(page.foot, state.foot);
    append(page.chain, state.chain);
    append(page.pose, state.pose);
    append(page.metric, state.metric);
    append(page.play, state.play);
    append(page.start, state.start);
    append(page.fix, state.fix);
    append(page.spring, state.spring);
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

uint64_t Crowd::stateHash() const {
  const gpu::Context& context = *impl_->context;
  context.waitIdle();
  std::vector<uint32_t> words;
  uint64_t hash = 0xcbf29ce484222325ull;  // FNV-1a, a word at a time
  for (const crowd::Herd& herd : impl_->herds) {
    // Record by record over the herd, not page by page: how agents are paged must not show.
    for (const auto buffer :
         {&Page::goal, &Page::body, &Page::gait, &Page::step, &Page::chain, &Page::play, &Page::spring})
      for (const Page& page : herd.pages) {
        if (!(page.*buffer)) continue;
        words.resize((page.*buffer).size() / sizeof(uint32_t));
        gpu::downloadBytes(context, page.*buffer, std::as_writable_bytes(std::span(words)));
        for (const uint32_t word : words) {
          hash = (hash ^ word) * 0x100000001b3ull;
          hash ^= hash >> 32;
        }
      }
  }
  return hash;
}

}  // namespace skitter
