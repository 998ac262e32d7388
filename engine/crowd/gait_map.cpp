#include "crowd/gait_map.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>

#include "crowd/leg_order.h"
#include "crowd/regait.h"
#include "shared/adapt.h"
#include "skitter/records.h"

namespace skitter::crowd {
namespace {

constexpr size_t mostSearched = 8;   // legs of a rig all of whose patterns have gaits
constexpr int idleOfMany = 2;        // legs that are idle at most in one with more
constexpr double wantedSpeed = 1.5;  // leg lengths a second, of the shares of time

struct Candidate {
  Regait gait;
  std::vector<float> shares;
};

// Legs that are idle in the pattern go along, for they may be well: nobody waits for them.
Candidate candidateOf(const Rig& rig, const Tuning& tuning, uint32_t idle) {
  Candidate made{.gait = regaitFor(rig, tuning, {.idle = idle}), .shares = {}};
  made.shares = standingShares(tuning, made.gait, idle, wantedSpeed);
  const std::vector<LegOrder> order = legOrder(rig);
  for (size_t l = 0; l < rig.legs.size(); ++l)
    if ((idle >> l & 1u) != 0)
      made.gait.legs[l] = {.group = rig.legs[l].group % made.gait.groups, .lag = order[l].lag};
  return made;
}

double apart(std::span<const float> a, std::span<const float> b) {
  double sum = 0;
  for (size_t l = 0; l < a.size(); ++l) sum += (double{a[l]} - double{b[l]}) * (double{a[l]} - double{b[l]});
  return std::sqrt(sum);
}

void padToVec4(std::vector<float>& values) { values.resize((values.size() + 3) / 4 * 4); }

}  // namespace

std::vector<uint32_t> walkingPatterns(const Rig& rig) {
  const size_t legs = rig.legs.size();
  std::vector<uint32_t> patterns;
  for (uint32_t idle = 1; idle >> legs == 0; ++idle) {
    const int count = std::popcount(idle);
    if (rig.legCount() - count < shared::FEWEST_THAT_WALK) continue;
    if (legs > mostSearched && count > idleOfMany) continue;
    patterns.push_back(idle);
  }
  return patterns;
}

double matern52(double distance, double lengthScale) {
  const double r = std::sqrt(5.0) * distance / lengthScale;
  return (1 + r + r * r / 3) * std::exp(-r);
}

GaitMap gaitMapOf(const Rig& rig, const Tuning& tuning) {
  std::vector<uint32_t> patterns = walkingPatterns(rig);
  patterns.insert(patterns.begin(), 0);
  std::vector<Candidate> all;
  for (const uint32_t idle : patterns) all.push_back(candidateOf(rig, tuning, idle));
  GaitMap map{.candidates = static_cast<uint32_t>(all.size())};
  for (const auto& [gait, shares] : all) {
    map.records.insert(map.records.end(), {static_cast<float>(gait.groups), gait.speed, gait.worth, 0});
    map.records.insert(map.records.end(), {gait.shift.x, gait.shift.y, gait.shift.z, 0});
    for (const LegTurn& leg : gait.legs)
      map.records.insert(map.records.end(), {static_cast<float>(leg.group) + leg.within, leg.lag,
                                             static_cast<float>(leg.neighbours), leg.slowness});
    map.records.insert(map.records.end(), shares.begin(), shares.end());
    padToVec4(map.records);
  }
  const auto best = std::ranges::max_element(all, {}, [](const Candidate& each) { return each.gait.worth; });
  map.records[3] = best->gait.worth;
  map.records[7] = static_cast<float>(best - all.begin());
  constexpr double variance = double{shared::ADAPT_DEVIATION} * double{shared::ADAPT_DEVIATION};
  for (const Candidate& a : all) {
    for (const Candidate& b : all)
      map.records.push_back(
          static_cast<float>(variance * matern52(apart(a.shares, b.shares), double{shared::ADAPT_LENGTH})));
    padToVec4(map.records);
  }
  return map;
}

}  // namespace skitter::crowd
