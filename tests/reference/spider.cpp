#include "spider.h"

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "skitter/records.h"
#include "validation/convert.h"

namespace skitter::test {
namespace {

double radians(double degrees) { return degrees * glm::pi<double>() / 180; }

uint32_t hashed(uint32_t x) {
  x = (x ^ 61u) ^ (x >> 16);
  x *= 9u;
  x ^= x >> 4;
  x *= 0x27d4eb2du;
  return x ^ x >> 15;
}

}  // namespace

Rig spider() {
  constexpr double lengths[4] = {0.10, 0.35, 0.32, 0.23};
  constexpr double elevations[4] = {10, 40, -60, -80};
  constexpr double cones[4] = {55, 45, 45, 40};
  constexpr double azimuths[4] = {40, 75, 108, 145};
  Rig rig;
  rig.name = "test spider";
  rig.groups = {"a", "b"};
  rig.legLength = 1;
  rig.bodyHeight = 0.26f;
  rig.bodyRadius = 0.18f;
  for (int side = 0; side < 2; ++side) {
    for (int pair = 0; pair < 4; ++pair) {
      Leg leg;
      leg.name = (side == 0 ? "L" : "R") + std::to_string(pair + 1);
      leg.group = (pair + side) % 2;
      const double azimuth = radians(azimuths[pair]) * (side == 0 ? 1 : -1);
      glm::dvec3 joint{0.18 * std::sin(azimuth), 0.26, 0.18 * std::cos(azimuth)};
      for (int b = 0; b < 4; ++b) {
        const double elevation = radians(elevations[b]);
        const glm::dvec3 direction{std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
                                   std::cos(elevation) * std::cos(azimuth)};
        Bone bone;
        bone.joint = leg.name + "_" + std::to_string(b);
        bone.start = joint;
        bone.direction = direction;
        bone.length = static_cast<float>(lengths[b]);
        bone.coneHalfAngle = static_cast<float>(radians(cones[b]));
        leg.bones.push_back(bone);
        leg.reach += bone.length;
        joint += lengths[b] * direction;
      }
      leg.home = glm::dvec3(joint.x, 0, joint.z);
      rig.legs.push_back(leg);
    }
  }
  return rig;
}

std::vector<float> rigRecordsOf(const Rig& rig, int padding) {
  std::vector<float> records;
  const auto push = [&](const glm::dvec3& v, double w) {
    for (int i = 0; i < 3; ++i) records.push_back(static_cast<float>(v[i]));
    records.push_back(static_cast<float>(w));
  };
  for (const Leg& leg : rig.legs) {
    push(leg.root(), leg.reach);
    push(leg.home, leg.group);
    // From the rear to the front of each group; the legs before, behind and across must stand.
    const size_t l = static_cast<size_t>(&leg - rig.legs.data()), pair = l % 4, across = (l + 4) % 8;
    double mask = std::ldexp(1.0, static_cast<int>(across));
    if (pair == 1 || pair == 2) mask = 0;
    if (pair > 0) mask += std::ldexp(1.0, static_cast<int>(l) - 1);
    if (pair < 3) mask += std::ldexp(1.0, static_cast<int>(l) + 1);
    push({(3 - static_cast<double>(pair)) / 3, mask, 0}, 0);
    glm::dvec3 x{0}, z{0}, end{0};
    glm::dmat3 before(1);
    const auto pushCarry = [&](double length, double edge) {
      const glm::dmat3 frame(x, glm::cross(z, x), z), carry = glm::transpose(before) * frame;
      push(carry[0], length);
      push(carry[2], edge);
      push(glm::dvec3(0), 0);  // a device reads it, whose frames are others
      before = frame;
    };
    for (const Bone& bone : leg.bones) {
      z = glm::normalize(glm::dvec3(bone.direction));
      x = glm::normalize(glm::cross(glm::dvec3(0, 1, 0), z));
      const double length = bone.length / leg.reach,
                   edge = std::tan(static_cast<double>(bone.coneHalfAngle) / 2);
      push(x, length);
      push(z, edge);
      push(bone.start, 1);
      push(glm::dvec3(0), 0);
      push(glm::dvec3(shared::LIMIT_CONE, 0, 0), 0);
      pushCarry(length, edge);
      end = glm::dvec3(bone.start) + z * static_cast<double>(bone.length);
    }
    for (int i = 0; i < padding; ++i) {
      push(x, 0);
      push(z, 1);
      push(end, 0);
      push(glm::dvec3(0), 0);
      push(glm::dvec3(shared::LIMIT_CONE, 0, 0), 0);
      pushCarry(0, 1);
    }
  }
  return records;
}

reference::Creature spiderCreature() {
  const Rig rig = spider();
  return validation::creatureOf(rigRecordsOf(rig), rig.legCount(), 4, rig.groupCount());
}

Heightfield field(uint32_t samples, float spacing, const std::function<double(double x, double z)>& height) {
  Heightfield terrain;
  terrain.name = "test field";
  terrain.columns = terrain.rows = samples;
  terrain.spacingX = terrain.spacingZ = spacing;
  for (uint32_t j = 0; j < samples; ++j) {
    for (uint32_t i = 0; i < samples; ++i) {
      const double x = terrain.originX() + spacing * static_cast<float>(i);
      const double z = terrain.originZ() + spacing * static_cast<float>(j);
      terrain.heights.push_back(static_cast<float>(height(x, z)));
    }
  }
  return terrain;
}

Heightfield flatField(double height) {
  return field(129, 0.5f, [=](double, double) { return height; });
}

Heightfield roughField() {
  return field(257, 0.5f, [](double x, double z) {
    const auto cell = static_cast<uint32_t>(std::lround(2 * x + 4096) * 8192 + std::lround(2 * z + 4096));
    const double noise = hashed(cell) / 4294967296.0 - 0.5;
    return 0.8 * std::sin(0.35 * x) + 0.5 * std::sin(0.5 * z + 1) + 0.06 * std::sin(2.1 * x + 1.3 * z) +
           0.05 * noise;
  });
}

shared::Parameters parametersFor(const Heightfield& terrain) {
  shared::Parameters p{};
  // The defaults as they are: legs are 1 m long.
#define SET(name, unit, value) p.name = static_cast<float>(value);
  TUNED_PARAMETERS(SET)
  FIXED_PARAMETERS(SET)
#undef SET
  p.dt = 1.0f / 60;
  p.legLength = 1;
  p.homeRadius = 0.75f;
  p.bodyHeight = 0.26f;
  p.bodyRadius = 0.18f;
  p.originX = terrain.originX();
  p.originZ = terrain.originZ();
  p.inverseSpacingX = 1 / terrain.spacingX;
  p.inverseSpacingZ = 1 / terrain.spacingZ;
  p.halfExtentX = terrain.extentX() / 2;
  p.halfExtentZ = terrain.extentZ() / 2;
  p.heightBlend = 1 - std::exp(-p.dt / 0.1f);
  p.tiltBlend = 1 - std::exp(-p.dt / 0.15f);
  p.jerkTicks = 24;
  // The tests' figures are of these.
  p.acceleration = 4;
  p.stretchSlow = 0.92f;
  p.stretchStop = 0.99f;
  p.errorStop = 0.1f;
  p.followLeast = 0;
  p.bellyClearance = 0.18f;
  p.strayShare = 2.5f;
  p.errorLift = 0.05f;
  p.approachError = 0.05f;
  p.pullError = 2e-3f;
  p.ikTolerance = 1e-4f;
  return p;
}

reference::AgentBody bodyAt(double x, double z, double ground) {
  reference::AgentBody body;
  body.tileX = std::floor(x / reference::tileSize);
  body.tileZ = std::floor(z / reference::tileSize);
  body.localX = x - body.tileX * reference::tileSize;
  body.localZ = z - body.tileZ * reference::tileSize;
  body.y = ground;
  return body;
}

reference::Step plantedAt(const reference::AgentBody& body, const glm::dvec3& relative) {
  reference::Step step;
  step.tileX = body.tileX;
  step.tileZ = body.tileZ;
  step.landing = step.liftOff = relative + glm::dvec3(body.localX, body.y, body.localZ);
  step.firstTick = -1;
  step.duration = 1;
  return step;
}

std::vector<reference::Step> stepsAtHome(const reference::Creature& creature,
                                         const reference::AgentBody& body) {
  std::vector<reference::Step> steps;
  for (const reference::Limb& limb : creature.limbs) {
    steps.push_back(plantedAt(body, body.orientation * limb.home));
  }
  return steps;
}

}  // namespace skitter::test
