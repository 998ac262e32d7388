#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <vector>

#include "skitter/crowd.h"

namespace skitter::bindings {

// Throws Error(input) for a herd that the crowd has not.
void checkHerd(const Crowd& crowd, uint32_t herd);

// Agents of the herd.
uint32_t agentsOf(const Crowd& crowd, uint32_t herd);

// Seconds of the crowd's first tick; 0 before it.
float dtOf(const Crowd& crowd);

// Each waits for the device.

// Every record but those of watched agents.
HerdState recordsOf(const Crowd& crowd, uint32_t herd);

// World metres, one an agent.
std::vector<glm::dvec3> positionsOf(const Crowd& crowd, uint32_t herd);

// Where a body is and how it moves.
struct Body {
  glm::dvec3 position{0};          // world metres
  glm::quat rotation{1, 0, 0, 0};  // world from model
  float heading = 0;               // radians about +Y, 0 faces +Z, a quarter turn +X
  float speed = 0;                 // horizontal, along the heading, m/s
};
std::vector<Body> bodiesOf(const Crowd& crowd, uint32_t herd);

// World metres, agent after agent and leg after leg: the starts of its bones and the foot, bonesOf + 1 a leg.
// NaN fills up the legs with fewer bones. Throws Error(input) for a crowd without poses.
std::vector<glm::dvec3> jointsOf(const Crowd& crowd, uint32_t herd);
uint32_t legsOf(const Crowd& crowd, uint32_t herd);
uint32_t bonesOf(const Crowd& crowd, uint32_t herd);  // of the longest leg

}  // namespace skitter::bindings
