#pragma once

#include <optional>
#include <span>

#include "crowd/herd.h"
#include "skitter/picking.h"

namespace skitter::crowd {

// A herd's body records, agent by agent, and the sphere that an agent is picked by.
struct PickHerd {
  uint32_t herd = 0;
  std::span<const float> bodies;
  float height = 0, radius = 0;  // metres, of the sphere's middle above the ground, in model space
};
PickHerd pickHerdOf(uint32_t herd, std::span<const float> bodies, const Rig& rig);

std::optional<Picked> pick(std::span<const PickHerd> herds, const Ray& ray, const glm::dvec3& origin);
std::optional<Picked> nearest(std::span<const PickHerd> herds, const glm::dvec3& point,
                              const glm::dvec3& origin);

}  // namespace skitter::crowd
