// The sums that measure keeps, as figures.
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "crowd/controller.h"
#include "crowd/page.h"
#include "gpu/context.h"
#include "gpu/transfer.h"
#include "shared/levels.h"
#include "skitter/crowd.h"

namespace skitter {
namespace {

constexpr size_t kFloats = shared::METRIC_STRIDE * 4;

// The metric records of any number of agents added up; lengths in leg lengths.
struct Sums {
  double ticks = 0, legTicks = 0, planted = 0, stays = 0, skates = 0, slip = 0, stances = 0;
  double penetration = 0, penetrationBeyond = 0, floating = 0, floatingBeyond = 0;
  double depth = 0, pairs = 0, crossings = 0;
  double supported = 0, unstable = 0, margin = 0;
  bool limitsAreKept = false;  // by some herd
  double limitedLegTicks = 0, violations = 0, violation = 0;
  double footJerk = 0, footPath = 0, bodyJerk = 0, bodyPath = 0;
  double reachError = 0, deepest = 0, leastMargin = HUGE_VAL;

  explicit Sums(bool keepsLimits) : limitsAreKept(keepsLimits) {}

  void add(std::span<const float, kFloats> m, const crowd::Kind& kind) {
    const double length = kind.rig.legLength;
    ticks += m[0];
    const double ownLegTicks = double{m[0]} * kind.legs - m[15];  // less those of lost legs
    legTicks += ownLegTicks;
    planted += m[1];
    stays += m[2];
    skates += m[3];
    slip += m[4] / length;
    stances += m[5];
    reachError = std::max(reachError, m[6] / length);
    penetration += m[8] / length;
    penetrationBeyond += m[9] / length;
    floating += m[10] / length;
    floatingBeyond += m[11] / length;
    depth += m[12] / length;
    deepest = std::max(deepest, m[13] / length);
    if (crowd::traitsOf(kind.controller).keepsLimits) {
      limitedLegTicks += ownLegTicks;
      violations += m[14];
      violation = std::max(violation, 2 * std::atan(double{m[7]}));
    }
    pairs += m[16];
    crossings += m[17];
    supported += m[18];
    unstable += m[19];
    margin += m[20] / length;
    if (m[18] > 0) leastMargin = std::min(leastMargin, m[21] / length);
    footJerk += m[24];
    footPath += m[25];
    bodyJerk += m[26];
    bodyPath += m[27];
  }

  Fidelity figures() const {
    const auto over = [](double sum, double count) { return count > 0 ? sum / count : 0; };
    Fidelity f;
    f.agentTicks = static_cast<uint64_t>(ticks);
    f.stances = static_cast<uint64_t>(stances);
    f.slip = over(slip, stances);
    f.skating = over(skates, stays);
    f.penetration = over(penetration, legTicks);
    f.penetrationBeyond = over(penetrationBeyond, legTicks);
    f.floating = over(floating, planted);
    f.floatingBeyond = over(floatingBeyond, planted);
    f.segmentPenetration = over(depth, legTicks);
    f.segmentPenetrationMost = deepest;
    f.crossing = over(crossings, pairs);
    f.reachErrorMost = reachError;
    if (limitsAreKept) {
      f.limitViolation = violation;
      f.limitViolations = over(violations, limitedLegTicks);
    }
    f.footJerk = over(footJerk, footPath);
    f.bodyJerk = over(bodyJerk, bodyPath);
    f.margin = over(margin, supported);
    f.marginLeast = supported > 0 ? leastMargin : 0;
    f.unstable = over(unstable, ticks);
    return f;
  }
};

double percentile99(const std::vector<uint64_t>& buckets) {
  uint64_t all = 0, seen = 0;
  for (const uint64_t count : buckets) all += count;
  for (size_t i = 0; i < buckets.size() && all > 0; ++i) {
    seen += buckets[i];
    if (static_cast<double>(seen) < 0.99 * static_cast<double>(all)) continue;
    return std::exp2(static_cast<double>(i + 1) / 4 - 20);  // the bucket's upper edge
  }
  return 0;
}

template <class Each>
void eachAgent(const Crowd::Impl& crowd, const crowd::Part& part, const Each& each) {
  if (!crowd.options.measure) return;
  std::vector<float> m(part.agents * kFloats);
  gpu::downloadBytes(*crowd.context, part.page->metric, std::as_writable_bytes(std::span(m)),
                     part.first * kFloats * sizeof(float));
  for (size_t at = 0; at < m.size(); at += kFloats)
    each(std::span<const float, kFloats>(m.data() + at, kFloats));
}

// The figures of the herds from `first` to before `end`.
Fidelity figuresOf(const Crowd::Impl& crowd, uint32_t first, uint32_t end) {
  crowd.context->waitIdle();
  bool limitsAreKept = false;
  for (uint32_t h = first; h < end; ++h)
    if (!crowd.herds[h].isGone())
      limitsAreKept = limitsAreKept || crowd::traitsOf(crowd.kindOf(h).controller).keepsLimits;
  Sums sums(limitsAreKept);
  std::vector<uint64_t> buckets(shared::HISTOGRAM_BUCKETS);
  uint64_t lastResorts = 0, notFinite = 0;
  for (uint32_t h = first; h < end; ++h)
    for (const crowd::Part& part : crowd::partsOf(crowd, h)) {
      eachAgent(crowd, part, [&](std::span<const float, kFloats> m) { sums.add(m, *part.kind); });
      if (part.page->histogram) {
        std::array<uint32_t, shared::HISTOGRAM_BUCKETS> counts;
        gpu::downloadBytes(*crowd.context, part.page->histogram, std::as_writable_bytes(std::span(counts)),
                           part.row * sizeof counts);
        for (size_t i = 0; i < buckets.size(); ++i) buckets[i] += counts[i];
      }
      const crowd::CounterRow row = crowd::rowOf(*crowd.context, part);
      lastResorts += row[shared::ROW_LAST_RESORTS];
      notFinite += row[shared::ROW_NOT_FINITE];
    }
  Fidelity f = sums.figures();
  f.reachErrorP99 = std::min(percentile99(buckets), f.reachErrorMost);
  f.lastResorts = lastResorts;
  f.notFinite = notFinite;
  return f;
}

}  // namespace

std::vector<LevelFigures> Crowd::levels() const {
  if (!impl_->rates) return {};
  using namespace shared;
  impl_->context->waitIdle();
  std::vector<LevelFigures> all(Levels::count);
  const std::vector<uint32_t> words = gpu::download<uint32_t>(*impl_->context, impl_->rates->words);
  for (size_t k = 0; k < all.size(); ++k) {
    all[k].rate = 1u << k;
    all[k].agents = words[LEVELS_AGENTS + k];
    all[k].agentTicks = uint64_t{words[LEVELS_TICKS + 2 * k + 1]} << 32 | words[LEVELS_TICKS + 2 * k];
  }
  std::vector<Sums> sums(Levels::count, Sums(false));
  for (uint32_t h = 0; h < herdCount(); ++h)
    for (const crowd::Part& part : crowd::partsOf(*impl_, h)) {
      const std::vector<float> rates = gpu::download<float>(*impl_->context, part.page->rate);
      size_t at = 4 * RATE_STRIDE * size_t{part.first};
      eachAgent(*impl_, part, [&](std::span<const float, kFloats> m) {
        sums[static_cast<size_t>(rates[at])].add(m, *part.kind);
        at += 4 * RATE_STRIDE;
      });
    }
  for (size_t k = 0; k < all.size(); ++k)
    if (const Fidelity figures = sums[k].figures(); figures.stances > 0) all[k].slip = figures.slip;
  return all;
}

Fidelity Crowd::fidelity() const { return figuresOf(*impl_, 0, herdCount()); }

Fidelity Crowd::fidelity(uint32_t herd) const {
  impl_->herdAt(herd);  // none of them all would be no error
  return figuresOf(*impl_, herd, herd + 1);
}

std::vector<Fidelity> Crowd::agentFidelity(uint32_t herd) const {
  impl_->context->waitIdle();
  std::vector<Fidelity> agents;
  for (const crowd::Part& part : crowd::partsOf(*impl_, herd))
    eachAgent(*impl_, part, [&](std::span<const float, kFloats> m) {
      Sums sums(crowd::traitsOf(part.kind->controller).keepsLimits);
      sums.add(m, *part.kind);
      agents.push_back(sums.figures());
    });
  return agents;
}

}  // namespace skitter
