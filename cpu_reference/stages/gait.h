#pragma once

#include <optional>
#include <span>

#include "cpu_reference/types.h"

namespace skitter::reference {

// What a leg was judged by and how far each judgement was from falling the other way. Margins of lengths are
// metres; a margin is infinite where the decision was not asked for.
struct LegDecision {
  bool planted = false, must = false, wants = false, open = false;
  double progress = 1;      // u_l after the last tick
  double offset = 0;        // off_l
  double stretch = 0;       // r_l
  double stoodSince = 0;    // tick
  double windowMargin = 0;  // of its phase from the nearest edge of its window, in windows
  double mustMargin = 0;
  double wantsMargin = 0;
  bool moved = false;              // the ground under the landing, or in its way, is no longer where it was
  double movedMargin = 0;          // metres
  double reaimMargin = 0;          // of the distance between landing and prediction
  double reaimProgressMargin = 0;  // of u_l against reaimLatest
};

// a, D, T and C.
struct Stride {
  double half = 0, duration = 0, swingTime = 0, cycle = 0;
  double durationMargin = 0;  // ticks, of the rounding of D
};
// `duration`, if any, is D instead of the rule's; `slowest` is Creature::slowest, `hurry` Creature::hurry.
Stride strideOf(const Tuning& tuning, int groups, const AgentBody& body,
                const std::optional<double>& duration = {}, double slowest = 1, double hurry = 0);

struct GaitResult {
  Gait gait;
  std::vector<LegDecision> legs;
  int first = -1;             // the leg that must lift and has stood longest
  double mustMargin = 0;      // of the nearest must of all planted legs
  double durationMargin = 0;  // ticks, of the rounding of D
  double settleMargin = 0;    // seconds
};

// Decisions that the caller takes instead of the rule, to recompute the other side of a tie.
struct GaitChoices {
  std::optional<double> duration;  // D
};

// The ground that is looked at in the ticks after an edit of the heights; without it gait knows none.
using WatchedGround = const Heights*;

// `phase` is the last tick's, `body` the new one, `misses` Chain::miss of each leg after the last tick,
// `tick` is n, `idleBefore` the last tick's Gait::idle.
GaitResult gait(const Tuning& tuning, const Creature& creature, const AgentBody& body, double phase,
                std::span<const Step> steps, std::span<const double> misses, double tick,
                const GaitChoices& choices = {}, WatchedGround watched = nullptr, uint32_t idleBefore = 0);

// Where leg `limb` would land, and where its root would then be, `seconds` before touchdown (model space).
glm::dvec3 predictedLanding(const Limb& limb, const AgentBody& body, double seconds, double stanceTime);
glm::dvec3 predictedRoot(const Limb& limb, const AgentBody& body, double seconds);

}  // namespace skitter::reference
