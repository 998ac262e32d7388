#pragma once

#include <optional>
#include <span>

#include "cpu_reference/types.h"
#include "cpu_reference/ways/way.h"

namespace skitter::reference {

// What decides, beside body and velocity, whether an agent sleeps.
struct Rest {
  Gait gait;              // as the last tick left it
  bool allowed = false;   // CrowdOptions::sleep
  bool edited = false;    // the heights, in the last two seconds
  bool breathes = false;  // the bodies of the agent's controller do
  int round = 1;          // ticks in which a herd that avoids looks around once, else 1
};

struct NavigateResult {
  Goal goal;
  glm::dvec2 desired{0};  // velocity x, z
  bool asleep = false;
  // Distances to the decisions, metres; infinite where a decision was not asked for.
  double arrivalMargin = 0;
  glm::dvec2 edgeMargin{0};
  // Likewise of sleep: of |v| from what counts as standing (m/s), and of the phase from the first ticks of a
  // breath. The other conditions compare records as they are, and no rounding can turn them.
  double standMargin = 0, breathMargin = 0;
  std::optional<WayResult> way = {};  // of an agent who has a field to go by
};

// A decision that the caller takes instead of the rule, to recompute the other side of a tie.
struct NavigateChoices {
  int arrived = -1;                  // 0 or 1: forced
  glm::ivec2 turnedBack = {-1, -1};  // per axis, 0 or 1: forced
  int stands = -1, breathedOut = -1;
  WayChoices way = {};
};

// `ways`: the fields of its kind, and `places` those of its goals in series.
NavigateResult navigate(const Tuning& tuning, const AgentBody& body, const Goal& goal, const Rest& rest = {},
                        const NavigateChoices& choices = {}, std::span<const WayField> ways = {},
                        std::span<const WayPlace> places = {});

}  // namespace skitter::reference
