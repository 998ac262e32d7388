#pragma once

#include <optional>
#include <span>

#include "crowd/herd.h"
#include "skitter/picking.h"

namespace skitter::crowd {

// The sphere that an agent is picked by, metres.
struct PickSphere {
  float height = 0;  // of its middle above the ground, in model space
  float radius = 0;
};
PickSphere pickSphereOf(const Rig& rig);

// Body records of a herd's agents that are picked by one sphere, agent by agent.
struct PickRun {
  uint32_t herd = 0, firstAgent = 0;  // the latter of the herd
  std::span<const float> bodies;
  PickSphere sphere;
};

std::optional<Picked> pick(std::span<const PickRun> runs, const Ray& ray, const glm::dvec3& origin);
std::optional<Picked> nearest(std::span<const PickRun> runs, const glm::dvec3& point,
                              const glm::dvec3& origin);

}  // namespace skitter::crowd
