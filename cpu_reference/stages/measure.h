#pragma once

#include "cpu_reference/types.h"

namespace skitter::reference {

// The agents whose number modulo `every` is `turn` at tick n. They have been watched for `watched` ticks
// before.
struct WatchTurn {
  uint64_t turn = 0, watched = 0;
};
WatchTurn watchTurn(uint64_t n, uint64_t every);

// What is remembered of a point: x_(n-1), e1 and e2 of it, and P and Q of the open window.
struct Trail {
  SKITTER_TRAIL_FIELDS(REFERENCE_MEMBER)
};

struct TipTrail : Trail {
  static constexpr double air = -1, unseen = -2;
  double slip = air;  // of the stance so far; `air`: not planted; `unseen`: planted since before the watch
};

struct Watched {
  Trail body;
  std::vector<TipTrail> tips;
};

// How near a decision that is counted was to falling the other way; metres, but violation in radians.
struct LegDecisions {
  double slide = 0;      // beyond what counts as skating; of a leg planted at both ticks
  double violation = 0;  // beyond what counts
  double path = 0;       // beyond what counts; of a window that closes
  bool stays = false, closes = false;
  double crossing = 0;  // how far the nearest two bones reach over each other, negative: short of it
  bool paired = false;
};

struct Measured {
  Metric metric;
  Watched watched;
  std::vector<LegDecisions> legs;
  double margin = 0;    // of this tick, if there is a planted foot
  double bodyPath = 0;  // as in LegDecisions
  bool closes = false, supported = false;
};

// `before` of an agent that was `ticks` ticks watched before this one; with 0 it is not read.
Measured measure(const Tuning& tuning, const Heights& heights, const Creature& creature,
                 const AgentBody& body, const std::vector<Foot>& feet, const std::vector<Chain>& chains,
                 uint64_t ticks, const Watched& before, const Metric& sums);

// Signed distance of `centre` from the edge of the convex hull of `points`, negative outside. There is at
// least one.
double stabilityMargin(std::vector<glm::dvec2> points, const glm::dvec2& centre);

// The leg behind on the same side; the number of limbs if there is none.
size_t neighbourOf(const Creature& creature, size_t limb);

// Joint positions of a leg in model space.
std::vector<glm::dvec3> jointsOf(const Limb& limb, const std::vector<glm::dvec2>& directions);

// How far two segments reach over each other, in units of length; positive if they cross.
double reachOver(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c, const glm::dvec2& d);

}  // namespace skitter::reference
