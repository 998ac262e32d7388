#include "bindings/common/herd_reader.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <utility>

#include "crowd/herd.h"
#include "crowd/places.h"
#include "crowd/readback.h"
#include "skitter/decode.h"
#include "skitter/error.h"

namespace skitter::bindings {
namespace {

HerdState stateOf(const Crowd& crowd, uint32_t herd, std::span<const Record> records) {
  return crowd::downloadRecords(implOf(crowd), herd, records);
}

BodyState bodyAt(const HerdState& state, size_t agent) {
  constexpr size_t floats = 4 * shared::BODY_STRIDE;
  return bodyOf(std::span(state.body).subspan(agent * floats, floats));
}

std::string textOf(const glm::dvec3& v) { return fmt::format("({:g}, {:g}, {:g})", v.x, v.y, v.z); }

}  // namespace

float dtOf(const Crowd& crowd) { return implOf(crowd).dt; }

uint32_t legsOf(const Crowd& crowd, uint32_t herd) {
  return static_cast<uint32_t>(crowd.rig(herd).legCount());
}

uint32_t bonesOf(const Crowd& crowd, uint32_t herd) {
  return static_cast<uint32_t>(crowd.rig(herd).maxBones());
}

std::vector<float> sizesOf(const Crowd& crowd, uint32_t herd) {
  std::vector<float> sizes;
  for (const crowd::SizeRun& run : implOf(crowd).herdAt(herd).runs)
    sizes.insert(sizes.end(), run.agents, implOf(crowd).kinds[run.kind].size);
  return sizes;
}

std::vector<uint64_t> agentIdsOf(const Crowd& crowd, uint32_t herd) {
  std::vector<uint64_t> ids(crowd.places(herd), AgentId().bits());
  const crowd::Presence& presence = implOf(crowd).herdAt(herd).presence;
  for (uint32_t agent = 0; agent < ids.size(); ++agent)
    if (presence.has(agent)) ids[agent] = AgentId(herd, agent, presence.generations[agent]).bits();
  return ids;
}

void expectFinite(const char* name, const glm::dvec3& vector) {
  if (!std::isfinite(glm::dot(vector, vector)))
    throw inputError(fmt::format("{} is {}, expected finite numbers", name, textOf(vector)));
}

Ray rayOf(const glm::dvec3& start, const glm::dvec3& direction, double length) {
  expectFinite("start", start);
  expectFinite("direction", direction);
  if (!(glm::length(direction) > 0))
    throw inputError(fmt::format("direction is {}, expected any length but 0", textOf(direction)));
  if (!(length >= 0)) throw inputError(fmt::format("length is {:g}, expected at least 0", length));
  return {start, direction, length};
}

std::optional<Picked> pick(const Crowd& crowd, const glm::dvec3& start, const glm::dvec3& direction,
                           double length) {
  return crowd.pick(rayOf(start, direction, length));
}

std::optional<Picked> nearest(const Crowd& crowd, const glm::dvec3& point) {
  expectFinite("point", point);
  return crowd.nearest(point);
}

HerdState recordsOf(const Crowd& crowd, uint32_t herd) { return stateOf(crowd, herd, allRecords); }
std::vector<float> recordsOf(const Crowd& crowd, uint32_t herd, Record record) {
  return std::move(stateOf(crowd, herd, std::array{record}).of(record));
}

std::vector<glm::dvec3> positionsOf(const Crowd& crowd, uint32_t herd) {
  const HerdState state = stateOf(crowd, herd, std::array{Record::body});
  std::vector<glm::dvec3> positions(state.agents);
  for (size_t agent = 0; agent < positions.size(); ++agent) positions[agent] = bodyAt(state, agent).position;
  return positions;
}

std::vector<BodyState> bodiesOf(const Crowd& crowd, uint32_t herd) {
  const HerdState state = stateOf(crowd, herd, std::array{Record::body});
  std::vector<BodyState> bodies(state.agents);
  for (size_t agent = 0; agent < bodies.size(); ++agent) bodies[agent] = bodyAt(state, agent);
  return bodies;
}

float headingOf(const BodyState& body) { return std::atan2(body.heading.x, body.heading.y); }

std::vector<glm::dvec3> jointsOf(const Crowd& crowd, uint32_t herd) {
  const HerdState state = stateOf(crowd, herd, std::array{Record::body, Record::pose});
  if (state.pose.empty() && state.agents > 0)
    throw inputError("joints are known only of a crowd that was made with poses (the option pose)");
  const size_t bones = bonesOf(crowd, herd), legs = legsOf(crowd, herd);
  std::vector<glm::dvec3> joints(state.agents * legs * (bones + 1),
                                 glm::dvec3(std::numeric_limits<double>::quiet_NaN()));
  auto* chain = joints.data();
  for (uint32_t agent = 0; agent < state.agents; ++agent) {
    const crowd::Kind& kind = implOf(crowd).kindOf(herd, agent);
    const glm::dvec3 position = bodyAt(state, agent).position;
    for (size_t leg = 0; leg < legs; ++leg, chain += bones + 1) {
      const size_t own = kind.rig.legs[leg].bones.size();
      for (size_t bone = 0; bone < own; ++bone)
        chain[bone] = position + glm::dvec3(crowd::placedBone(state, kind, agent, leg, bone).position);
      chain[own] = position + glm::dvec3(crowd::placedTip(state, kind, agent, leg));
    }
  }
  return joints;
}

}  // namespace skitter::bindings
