#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "skitter/crowd.h"
#include "skitter/decode.h"

// Whoever names a herd that is not there gets an Error(input).
namespace skitter::bindings {

// Seconds of the crowd's first tick; 0 before it.
float dtOf(const Crowd& crowd);

uint32_t legsOf(const Crowd& crowd, uint32_t herd);
uint32_t bonesOf(const Crowd& crowd, uint32_t herd);  // of the longest leg

// How large the creature of each place is, times the rig that was loaded.
std::vector<float> sizesOf(const Crowd& crowd, uint32_t herd);

// AgentId::bits() of who is in each place of the herd; those of AgentId() where nobody is.
std::vector<uint64_t> agentIdsOf(const Crowd& crowd, uint32_t herd);

// Each of these waits for the device. Lists have an entry for each place, the reserve's among them.

// Every record but those of watched agents, and one kind of them.
HerdState recordsOf(const Crowd& crowd, uint32_t herd);
std::vector<float> recordsOf(const Crowd& crowd, uint32_t herd, Record record);

// World metres.
std::vector<glm::dvec3> positionsOf(const Crowd& crowd, uint32_t herd);

std::vector<BodyState> bodiesOf(const Crowd& crowd, uint32_t herd);
// Radians about +Y: 0 faces +Z, a quarter turn +X.
float headingOf(const BodyState& body);

// World metres, agent after agent and leg after leg: the starts of its bones and the foot, bonesOf + 1 a leg.
// NaN fills up the legs with fewer bones. Throws Error(input) for a crowd without poses.
std::vector<glm::dvec3> jointsOf(const Crowd& crowd, uint32_t herd);

// Throws Error(input) for numbers that are not finite.
void expectFinite(const char* name, const glm::dvec3& vector);
// Throws Error(input) for numbers that are not finite, but for an infinite length, a length below 0 and a
// direction of length 0.
Ray rayOf(const glm::dvec3& start, const glm::dvec3& direction, double length);

// As Crowd::pick() and Crowd::nearest(), in world metres. They throw as the two above.
std::optional<Picked> pick(const Crowd& crowd, const glm::dvec3& start, const glm::dvec3& direction,
                           double length);
std::optional<Picked> nearest(const Crowd& crowd, const glm::dvec3& point);

}  // namespace skitter::bindings
