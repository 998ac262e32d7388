// What the host asks of a crowd after the fact; each waits for the device.
#include <algorithm>
#include <cmath>

#include "crowd/herd.h"
#include "gpu/context.h"
#include "gpu/transfer.h"
#include "skitter/crowd.h"

namespace skitter {
namespace {

using crowd::Page;

template <class T>
void appendRecords(const gpu::Context& context, const gpu::Buffer& buffer, std::vector<T>& records) {
  const std::vector<T> page = gpu::download<T>(context, buffer);
  records.insert(records.end(), page.begin(), page.end());
}

}  // namespace

HerdState Crowd::download(uint32_t herdIndex) const {
  const gpu::Context& context = *impl_->context;
  context.waitIdle();
  HerdState state;
  for (const Page& page : impl_->herds.at(herdIndex).pages) {
    state.agents += page.agents;
    appendRecords(context, page.goal, state.goal);
    appendRecords(context, page.steer, state.steer);
    appendRecords(context, page.body, state.body);
    appendRecords(context, page.gait, state.gait);
    appendRecords(context, page.step, state.step);
    appendRecords(context, page.foot, state.foot);
    appendRecords(context, page.chain, state.chain);
    appendRecords(context, page.pose, state.pose);
    appendRecords(context, page.metric, state.metric);
    if (page.play) appendRecords(context, page.play, state.play);
    if (page.start) appendRecords(context, page.start, state.start);
    if (page.fix) appendRecords(context, page.fix, state.fix);
  }
  return state;
}

Fidelity Crowd::fidelity() const {
  const gpu::Context& context = *impl_->context;
  context.waitIdle();
  Fidelity f;
  double slip = 0, stances = 0, penetration = 0, floating = 0, ticks = 0, planted = 0;
  std::vector<uint64_t> buckets(shared::HISTOGRAM_BUCKETS);
  for (const crowd::Herd& herd : impl_->herds) {
    const double length = herd.rig.legLength;
    for (const Page& page : herd.pages) {
      const std::vector<float> m = gpu::download<float>(context, page.metric);
      for (size_t i = 0; i + 11 < m.size(); i += shared::METRIC_STRIDE * 4) {
        slip += m[i + 4] / length;
        stances += m[i + 5];
        penetration += m[i + 6] / length;
        floating += m[i + 7] / length;
        ticks += m[i + 8];
        planted += m[i + 9];
        f.limitViolation = std::max(f.limitViolation, double{m[i + 11]});
      }
      const std::vector<uint32_t> counts = gpu::download<uint32_t>(context, page.histogram);
      for (size_t i = 0; i < buckets.size(); ++i) buckets[i] += counts[i];
      const std::vector<uint32_t> counters = gpu::download<uint32_t>(context, page.counters);
      f.lastResorts += counters[shared::COUNTER_LAST_RESORTS];
      f.notFinite += counters[shared::COUNTER_NOT_FINITE];
    }
  }
  if (stances > 0) f.slip = slip / stances;
  if (ticks > 0) f.penetration = penetration / ticks;
  if (planted > 0) f.floating = floating / planted;
  uint64_t all = 0, seen = 0;
  for (const uint64_t count : buckets) all += count;
  for (size_t i = 0; i < buckets.size() && all > 0; ++i) {
    seen += buckets[i];
    if (static_cast<double>(seen) < 0.99 * static_cast<double>(all)) continue;
    f.reachErrorP99 = std::exp2(static_cast<double>(i + 1) / 4 - 20);  // the bucket's upper edge
    break;
  }
  return f;
}

uint64_t Crowd::stateHash() const {
  const gpu::Context& context = *impl_->context;
  context.waitIdle();
  uint64_t hash = 0xcbf29ce484222325ull;  // FNV-1a, a word at a time
  for (const crowd::Herd& herd : impl_->herds) {
    // Record by record over the herd, not page by page: how agents are paged must not show.
    for (const auto buffer : {&Page::goal, &Page::body, &Page::gait, &Page::step, &Page::chain, &Page::play})
      for (const Page& page : herd.pages) {
        if (!(page.*buffer)) continue;
        for (const uint32_t word : gpu::download<uint32_t>(context, page.*buffer)) {
          hash = (hash ^ word) * 0x100000001b3ull;
          hash ^= hash >> 32;
        }
      }
  }
  return hash;
}

}  // namespace skitter
