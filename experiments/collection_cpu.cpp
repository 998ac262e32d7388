#include "experiments/collection_cpu.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "shared/records.h"

namespace skitter::experiments {
namespace {

using namespace shared;

glm::vec3 turned(float angle, const glm::vec3& v) {
  const float t = angle / 2, c = (1 - t * t) / (1 + t * t), s = 2 * t / (1 + t * t);
  return {c * v.x + s * v.z, v.y, c * v.z - s * v.x};
}

glm::vec3 vectorAt(const float* record) { return {record[0], record[1], record[2]}; }

void put(float* record, const glm::vec3& v, float w) {
  record[0] = v.x, record[1] = v.y, record[2] = v.z, record[3] = w;
}

}  // namespace

CollectionCpu::Height CollectionCpu::heightAt(float x, float z) const {
  const auto columns = static_cast<int>(ground_.columns), rows = static_cast<int>(ground_.rows);
  const float u = std::clamp((x - q_.originX) * q_.inverseSpacingX, 0.0f, static_cast<float>(columns - 1));
  const float v = std::clamp((z - q_.originZ) * q_.inverseSpacingZ, 0.0f, static_cast<float>(rows - 1));
  const int i = std::min(static_cast<int>(u), columns - 2), j = std::min(static_cast<int>(v), rows - 2);
  const float a = u - static_cast<float>(i), b = v - static_cast<float>(j);
  const float* near = ground_.heights.data() + static_cast<size_t>(j) * ground_.columns + i;
  const float* far = near + columns;
  const float h0 = near[0] + a * (near[1] - near[0]), h1 = far[0] + a * (far[1] - far[0]);
  const float gx0 = near[1] - near[0], gx1 = far[1] - far[0];
  return {h0 + b * (h1 - h0), (gx0 + b * (gx1 - gx0)) * q_.inverseSpacingX, (h1 - h0) * q_.inverseSpacingZ};
}

void CollectionCpu::run(const HerdState& state, uint32_t legs, float tick, std::vector<float>& steps,
                        std::vector<float>& arcs) const {
  for (uint32_t leg = 0; leg < legs; ++leg)
    collect(state, leg, tick, steps.data() + size_t{4} * STEP_STRIDE * leg,
            arcs.data() + size_t{4} * ARC_STRIDE * leg);
}

void CollectionCpu::collect(const HerdState& state, uint32_t record, float tick, float* step,
                            float* arc) const {
  const size_t agent = record / static_cast<uint32_t>(legs_), leg = record % static_cast<uint32_t>(legs_);
  const float* body = state.body.data() + 4 * agent * BODY_STRIDE;
  const float* gait = state.gait.data() + 4 * agent * GAIT_STRIDE;
  const float* limb = rig_.data() + 4 * leg * static_cast<size_t>(rigStride(bones_));
  const glm::vec3 root = vectorAt(limb), home = vectorAt(limb + 4);
  const float reach = limb[3];
  const glm::vec3 local = vectorAt(body);
  const float bodyX = tileX(body[3]), bodyZ = tileZ(body[3]);
  const float worldX = bodyX * TILE_SIZE + local.x, worldZ = bodyZ * TILE_SIZE + local.z;
  const glm::quat turn(body[11], body[8], body[9], body[10]);
  const float omega = body[12], v3 = body[15];
  const float ticks = gait[3], time = ticks * q_.dt, stance = gait[5] - time;

  const float ahead = time + 0.5f * stance;
  const glm::vec3 tau = turned(omega * ahead, home) + glm::vec3(0, 0, v3 * ahead);
  const glm::vec3 rootThen = turned(omega * time, root) + glm::vec3(0, 0, v3 * time);
  glm::vec2 o(tau.x - rootThen.x, tau.z - rootThen.z);
  const float span = glm::length(o);
  o = span < 1e-6f ? glm::normalize(glm::vec2(home.x - root.x, home.z - root.z)) : o / span;
  const float rho = std::max(span, 0.1f * reach);
  const glm::vec3 up = turn * glm::vec3(0, 1, 0), predicted = turn * tau, rootWorld = turn * rootThen;

  const float least = q_.reachLeast * reach, most = q_.reachMost * reach;
  float bestScore = 3e38f, nearestMiss = 3e38f;
  glm::vec3 best = predicted, nearest = predicted;
  for (int k = 1; k <= 4; ++k) {
    for (int j = -k; j <= k; ++j) {
      const float along = rho * static_cast<float>(k - 3) / 3, across = static_cast<float>(j) * rho / 6;
      glm::vec3 p =
          turn * glm::vec3(tau.x + o.x * along - o.y * across, tau.y, tau.z + o.y * along + o.x * across);
      const Height ground = heightAt(worldX + p.x, worldZ + p.z);
      p.y = ground.y - local.y;
      const float distance = glm::length(p - rootWorld);
      const float miss = std::fabs(distance - std::clamp(distance, least, most));
      if (miss < nearestMiss) nearestMiss = miss, nearest = p;
      const float facing = glm::dot(glm::normalize(glm::vec3(-ground.gx, 1, -ground.gz)), up);
      if (miss > 0 || facing < q_.slopeLeast) continue;
      const glm::vec3 off = p - predicted;
      float score = glm::dot(off, off) / (q_.legLength * q_.legLength);
      if (q_.nearestOnly < 0.5f) {
        const float strain = std::max(0.0f, distance / reach - q_.reachComfort);
        score += q_.slopeWeight * (1 - facing) + q_.reachWeight * strain * strain;
      }
      if (score < bestScore) bestScore = score, best = p;
    }
  }
  const bool lastResort = bestScore > 1e38f;
  if (lastResort) {
    const glm::vec3 d = nearest - rootWorld;
    const float far = glm::length(d);
    best = rootWorld + d * (std::clamp(far, least, most) / std::max(far, 1e-6f));
  }

  const float apart = tilesApart(tileOfTicks(step[7]), stepTile(bodyX, bodyZ));
  const glm::vec3 from =
      glm::vec3(apartX(apart) * TILE_SIZE, 0, apartZ(apart) * TILE_SIZE) + vectorAt(step) - local;
  constexpr float at[3] = {3.0f / 16, 0.5f, 13.0f / 16}, share[3] = {5.0f / 8, 1, 5.0f / 8};
  float height = q_.stepHeight;
  for (int i = 0; i < 3; ++i) {
    const glm::vec3 p = glm::mix(from, best, at[i]);
    const float gap = heightAt(worldX + p.x, worldZ + p.z).y - (local.y + p.y);
    if (gap > -q_.stepClearance) height = std::max(height, (gap * up.y + q_.stepClearance) / share[i]);
  }
  const glm::vec3 lift = up * std::min(height, q_.stepHeightMax);
  put(step, best + local, tick - 1);
  put(step + 4, from + local, packedTicks(lastResort ? -ticks : ticks, stepTile(bodyX, bodyZ)));
  put(arc, lift, 0);
  put(arc + 4, lift, 0);
}

}  // namespace skitter::experiments
