#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "cpu_reference/types.h"

namespace skitter::reference {

// Key poses of a creature's legs, evenly spaced over a cycle.
struct KeyPoses {
  using Directions = std::vector<glm::dvec2>;  // (X, Y) of each bone
  struct Leg {
    Directions standing;
    std::vector<Directions> keys, tangents;  // tangents over the time from one key to the next
    double land = 0,
           stand = 0;  // phase at which the foot begins to stand, share of the cycle for which it does
  };
  std::vector<Leg> legs;
  double stride = 1;  // metres a cycle
};

// exp(dt A) of x' = v, v' = -frequency^2 x - 2 damping frequency v: what (x, v) goes to in dt seconds.
glm::dmat2 springStep(double frequency, double damping, double dt);

// A bone's (X, Y) on the closed curve, at s in [0, 1] of the way from key k to the next.
glm::dvec2 closedCurve(const KeyPoses::Leg& pose, size_t bone, size_t k, double s);

struct SprungLeg {
  Foot foot;
  Chain chain;
  KeyPoses::Directions rates;  // 1/s
  KeyPoses::Directions goals;  // G
  double stanceMargin = 0;     // shares of the cycle between the phase and the nearer edge of the stance
  double walkMargin = 0;       // of w and 1/2
};
// `limb` is the leg's, `phase` and `body` the new ones; `directions` and `rates` the last tick's.
SprungLeg poseSwing(const Tuning& tuning, const KeyPoses& poses, const Limb& limb, size_t leg,
                    const AgentBody& body, double phase, const KeyPoses::Directions& directions,
                    const KeyPoses::Directions& rates);

}  // namespace skitter::reference
