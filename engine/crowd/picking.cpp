#include "crowd/picking.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "crowd/page.h"
#include "gpu/context.h"
#include "gpu/transfer.h"
#include "skitter/decode.h"
#include "skitter/error.h"

namespace skitter {
namespace crowd {
namespace {

// Calls with run, agent of the herd and the middle of its sphere.
template <typename Call>
void eachSphere(std::span<const PickRun> runs, const glm::dvec3& origin, const Call& call) {
  constexpr size_t floats = 4 * shared::BODY_STRIDE;
  for (const PickRun& run : runs)
    for (size_t i = 0; i < run.bodies.size() / floats; ++i) {
      const BodyState body = bodyOf(run.bodies.subspan(i * floats, floats), origin);
      if (!body.present) continue;
      call(run, run.firstAgent + static_cast<uint32_t>(i),
           body.position + glm::dvec3(body.rotation * glm::vec3(0, run.sphere.height, 0)));
    }
}

glm::dvec3 directionOf(const Ray& ray) {
  const glm::dvec3& d = ray.direction;
  const double length = glm::length(d);
  if (length > 0 && std::isfinite(length)) return d / length;
  throw inputError(
      fmt::format("the ray's direction is ({}, {}, {}), expected any length but 0", d.x, d.y, d.z));
}

// Metres along the ray to the sphere, 0 from within; infinite where it misses.
double along(const Ray& ray, const glm::dvec3& direction, const glm::dvec3& middle, double radius) {
  const glm::dvec3 to = middle - ray.start;
  const double nearest = glm::dot(to, direction);
  const double beside = glm::dot(to, to) - nearest * nearest, inside = radius * radius - beside;
  if (glm::dot(to, to) <= radius * radius) return 0;
  if (inside < 0 || nearest < 0) return std::numeric_limits<double>::infinity();
  return nearest - std::sqrt(inside);
}

}  // namespace

PickSphere pickSphereOf(const Rig& rig) { return {rig.bodyHeight, std::max(rig.bodyRadius, rig.bodyHeight)}; }

std::optional<Picked> pick(std::span<const PickRun> runs, const Ray& ray, const glm::dvec3& origin) {
  const glm::dvec3 direction = directionOf(ray);
  std::optional<Picked> best;
  eachSphere(runs, origin, [&](const PickRun& run, uint32_t agent, const glm::dvec3& middle) {
    const double distance = along(ray, direction, middle, double{run.sphere.radius});
    if (distance > ray.length || !std::isfinite(distance) || (best && best->distance <= distance)) return;
    best = {run.herd, agent, distance, ray.start + distance * direction};
  });
  return best;
}

std::optional<Picked> nearest(std::span<const PickRun> runs, const glm::dvec3& point,
                              const glm::dvec3& origin) {
  std::optional<Picked> best;
  eachSphere(runs, origin, [&](const PickRun& run, uint32_t agent, const glm::dvec3& middle) {
    const double distance = glm::distance(point, middle);
    if (!best || distance < best->distance) best = {run.herd, agent, distance, middle};
  });
  return best;
}

}  // namespace crowd

namespace {

// The body records of all herds, a vector a part, and who they are of.
struct Bodies {
  std::vector<std::vector<float>> records;
  std::vector<crowd::PickRun> runs;
};
Bodies bodiesOf(const Crowd& crowd) {
  const Crowd::Impl& impl = implOf(crowd);
  impl.context->waitIdle();
  Bodies bodies;
  for (uint32_t herd = 0; herd < crowd.herdCount(); ++herd)
    for (const crowd::Part& part : crowd::partsOf(impl, herd)) {
      const uint64_t agentBytes = 16 * shared::BODY_STRIDE;
      std::vector<float> records(part.agents * agentBytes / sizeof(float));
      gpu::downloadBytes(*impl.context, part.page->body, std::as_writable_bytes(std::span(records)),
                         part.first * agentBytes);
      bodies.runs.push_back({herd, part.firstAgent, records, crowd::pickSphereOf(part.kind->rig)});
      bodies.records.push_back(std::move(records));
    }
  return bodies;
}

}  // namespace

std::optional<Picked> Crowd::pick(const Ray& ray, const glm::dvec3& origin) const {
  return crowd::pick(bodiesOf(*this).runs, ray, origin);
}

std::optional<Picked> Crowd::nearest(const glm::dvec3& point, const glm::dvec3& origin) const {
  return crowd::nearest(bodiesOf(*this).runs, point, origin);
}

}  // namespace skitter
