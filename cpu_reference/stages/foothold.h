#pragma once

#include <optional>
#include <span>
#include <vector>

#include "cpu_reference/stages/route.h"
#include "cpu_reference/types.h"

namespace skitter::reference {

// The cost of a leg length beyond a border, squared.
inline constexpr double othersWeight = 100;

// Another agent, as one sees it that chooses a foothold: metres, metres per second.
struct Passer {
  glm::dvec2 place{0};  // from the agent to it
  glm::dvec2 velocity{0}, ownVelocity{0};
  double radius = 0, ownRadius = 0;  // of footprints
};

// Between the agent and somebody else at one time: places q, relative to the body, are the agent's up to
// n . q = most.
struct Border {
  glm::dvec2 n{0};
  double most = 0;
  // Float32 errors of n, and of `most` in metres.
  double turns = 0, shifts = 0;
};

struct Candidate {
  glm::dvec3 point{0};  // on the ground, relative
  double distance = 0;  // from the root at touchdown, metres
  double facing = 0;    // m, cosine between the ground's normal and the body's up
  bool fits = false;
  double score = 0;
  double beyond = 0, beyondError = 0;  // the farthest border that it is beyond, and float32's error; metres
  double misfit = 0;                   // metres by which the distance is out of range
  // How far each condition of fitting is from its threshold, positive inside: metres, metres, cosine.
  double leastMargin = 0, mostMargin = 0, facingMargin = 0;
};

struct FootholdResult {
  Step step;
  int chosen = 0;
  bool lastResort = false;
  std::vector<Candidate> candidates;
  glm::dvec3 target{0}, root{0};  // tau and r', model space
  double side = 0;                // |o|: below it the ladder's direction is badly conditioned
  double stretch = 0;             // rho
  Route route;
};

// Decisions that the caller takes instead of the rule, to recompute the other side of a tie.
struct FootholdChoices {
  std::optional<int> candidate;
  bool lastResort = false;  // of the forced candidate
  std::optional<int> way;   // of Route::ways
};

// `body` is the new one, `step` the leg's last, `gait` this tick's with its durations, `tick` is n.
// `lifts`: the leg lifts now; otherwise it is aimed anew. `hanging`: where its foot is, relative, of a leg
// that lifts without having carried. `passers`: of a herd that avoids, the agent's neighbours.
FootholdResult foothold(const Tuning& tuning, const Heights& heights, const Limb& limb, const AgentBody& body,
                        const Gait& gait, const Step& step, bool lifts, double tick,
                        const FootholdChoices& choices = {}, const std::optional<glm::dvec3>& hanging = {},
                        std::span<const Passer> passers = {});

}  // namespace skitter::reference
