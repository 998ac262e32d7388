#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "laws/bodies.h"
#include "laws/skin_judge.h"

// A creature made of numbers that walks by the laws: a box on four legs of two bones. Whoever breaks a law
// says how.
namespace skitter::test {

// Leg length 1 m. Bone 0 is the body, 1 + 2 leg + k a leg's; legs are front left, front right, hind left and
// hind right.
laws::Creature puppet();

struct Step {
  uint64_t tick;
  double seconds;
  laws::Body body;
  laws::Moment moment;
};

// What is done to it. Each has no effect by default.
struct Fault {
  std::function<void(laws::Creature&)> ofModel = [](auto&) {};
  // Before its legs are posed: its body, and where its feet go.
  std::function<void(double seconds, laws::Body&)> ofBody = [](double, auto&) {};
  std::function<void(size_t leg, double seconds, glm::dvec3&)> ofFoot = [](size_t, double, auto&) {};
  std::function<bool(size_t leg, double seconds)> bendsBack = [](size_t, double) { return false; };
  std::function<void(laws::Moment&)> ofMoment = [](auto&) {};  // after that
  double clock = 1;                                            // its own seconds for each that passes
  std::optional<glm::dvec3> other = {};                        // where another one stands, relative to it
};

// A box of the skin, moved by one bone.
void addBox(laws::Creature& creature, const glm::dvec3& least, const glm::dvec3& most, uint32_t ofBone);

// The warnings for a walk of `seconds` along +z on flat ground, at 1 m/s.
std::vector<laws::Figure> walk(double seconds, const Fault& fault = {});

}  // namespace skitter::test
