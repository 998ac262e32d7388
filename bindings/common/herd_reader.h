#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "skitter/crowd.h"
#include "skitter/decode.h"

namespace skitter::bindings {

// Throws Error(input) for a herd that the crowd has not.
void checkHerd(const Crowd& crowd, uint32_t herd);

// Places of the herd: its agents and its reserve, in which nobody may be.
uint32_t agentsOf(const Crowd& crowd, uint32_t herd);

// Seconds of the crowd's first tick; 0 before it.
float dtOf(const Crowd& crowd);

// Each waits for the device.

// Every record but those of watched agents.
HerdState recordsOf(const Crowd& crowd, uint32_t herd);

// World metres, one an agent.
std::vector<glm::dvec3> positionsOf(const Crowd& crowd, uint32_t herd);

std::vector<BodyState> bodiesOf(const Crowd& crowd, uint32_t herd);
// Radians about +Y: 0 faces +Z, a quarter turn +X.
float headingOf(const BodyState& body);

// World metres, agent after agent and leg after leg: the starts of its bones and the foot, bonesOf + 1 a leg.
// NaN fills up the legs with fewer bones. Throws Error(input) for a crowd without poses.
std::vector<glm::dvec3> jointsOf(const Crowd& crowd, uint32_t herd);
uint32_t legsOf(const Crowd& crowd, uint32_t herd);
uint32_t bonesOf(const Crowd& crowd, uint32_t herd);  // of the longest leg

}  // namespace skitter::bindings
