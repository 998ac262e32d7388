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

// A herd's body records, agent by agent.
struct PickHerd {
  uint32_t herd = 0;
  std::span<const float> bodies;
  PickSphere sphere;
};

std::optional<Picked> pick(std::span<const PickHerd> herds, const Ray& ray, const glm::dvec3& origin);
std::optional<Picked> nearest(std::span<const PickHerd> herds, const glm::dvec3& point,
                              const glm::dvec3& origin);

}  // namespace skitter::crowd
