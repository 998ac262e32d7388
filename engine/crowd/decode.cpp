#include "skitter/decode.h"

#include <fmt/format.h>

#include "skitter/error.h"
#include "skitter/records.h"

namespace skitter {
namespace {

glm::vec4 load(std::span<const float> record, size_t index) {
  if (record.size() < 4 * (index + 1))
    throw inputError(
        fmt::format("a record of {} floats, expected at least {}", record.size(), 4 * (index + 1)));
  const float* v = record.data() + 4 * index;
  return {v[0], v[1], v[2], v[3]};
}

glm::quat quaternion(const glm::vec4& xyzw) { return {xyzw.w, xyzw.x, xyzw.y, xyzw.z}; }

// A place in a tile; the difference of tiles is exact, so that nothing is lost far from the world's origin.
glm::dvec3 placeIn(double tileX, double tileZ, const glm::vec4& local, const glm::dvec3& origin) {
  return glm::dvec3(shared::TILE_SIZE * tileX, 0, shared::TILE_SIZE * tileZ) - origin + glm::dvec3(local);
}

}  // namespace

BodyState bodyOf(std::span<const float> body, const glm::dvec3& origin) {
  const glm::vec4 local = load(body, 0), way = load(body, 1), rates = load(body, 3);
  return {.position = placeIn(shared::tileX(local.w), shared::tileZ(local.w), local, origin),
          .rotation = quaternion(load(body, 2)),
          .heading = glm::vec2(way),
          .velocity = way.z * glm::vec3(way.x, 0, way.y),
          .turnRate = rates.x,
          .present = way.w == 0};
}

StepState stepOf(std::span<const float> step, std::span<const float> body, const glm::dvec3& origin) {
  const glm::vec4 landing = load(step, 0), liftOff = load(step, 1);
  const float bodyTile = load(body, 0).w;
  const float x = shared::tileX(bodyTile), z = shared::tileZ(bodyTile);
  const float apart = shared::tilesApart(shared::tileOfTicks(liftOff.w), shared::stepTile(x, z));
  const double tileX = double{x} + shared::apartX(apart), tileZ = double{z} + shared::apartZ(apart);
  return {.liftOff = placeIn(tileX, tileZ, liftOff, origin),
          .landing = placeIn(tileX, tileZ, landing, origin),
          .firstTick = landing.w,
          .ticks = shared::ticksOf(liftOff.w),
          .lastResort = liftOff.w < 0};
}

FootState footOf(std::span<const float> foot, const BodyState& body) {
  const glm::vec4 target = load(foot, 0);
  return {.place = body.position + glm::dvec3(target), .progress = target.w};
}

TipState tipOf(std::span<const float> tip, const BodyState& body) {
  const glm::vec4 place = load(tip, 0);
  return {.place = body.position + glm::dvec3(place), .error = place.w};
}

BonePose bonePoseOf(std::span<const float> pose, uint32_t entry) {
  const size_t first = size_t{entry} * shared::POSE_STRIDE;
  return {.rotation = quaternion(load(pose, first)), .position = glm::vec3(load(pose, first + 1))};
}

glm::mat3x4 jointRowsOf(std::span<const float> pose, uint32_t joint) {
  const size_t first = size_t{joint} * shared::MATRIX_STRIDE;
  return {load(pose, first), load(pose, first + 1), load(pose, first + 2)};
}

Footfall footfallOf(std::span<const float> event, uint32_t firstAgent, double dt) {
  const glm::vec4 place = load(event, 0), what = load(event, 1);
  return {.agent = static_cast<uint32_t>(what.x) - firstAgent,
          .leg = static_cast<uint32_t>(what.y),
          .tick = static_cast<uint64_t>(what.z),
          .seconds = double{what.z} * dt,
          .place = glm::vec3(place),
          .speed = place.w};
}

}  // namespace skitter
