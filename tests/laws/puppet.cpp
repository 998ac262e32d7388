#include "puppet.h"

#include <array>
#include <cmath>

namespace skitter::test {
namespace {

using laws::Creature;

constexpr double dt = 1.0 / 60, speed = 1, bone = 0.5, hipHeight = 0.8;
constexpr double cycle = 0.6, standing = 0.6;  // seconds, and the share of it for which a foot stands
constexpr double lift = 0.1;
constexpr uint64_t lookTicks = 30, windowTicks = 180;

const std::array<glm::dvec3, 4> hips = {
    {{0.2, hipHeight, 0.4}, {-0.2, hipHeight, 0.4}, {0.2, hipHeight, -0.4}, {-0.2, hipHeight, -0.4}}};
const std::array<double, 4> phases = {0, 0.5, 0.5, 0};

// The knee of a leg of two equal bones from `hip` to `foot`, toward +z of the body or away from it.
glm::dvec3 kneeOf(const glm::dvec3& hip, const glm::dvec3& foot, const glm::dvec3& forward) {
  const glm::dvec3 along = foot - hip;
  const double half = 0.5 * glm::length(along);
  const glm::dvec3 unit = along / (2 * half);
  const glm::dvec3 side = glm::normalize(forward - glm::dot(forward, unit) * unit);
  return hip + half * unit + std::sqrt(std::max(0.0, bone * bone - half * half)) * side;
}

// Where a leg's joints are at rest.
std::array<glm::dvec3, 3> restOf(size_t leg) {
  const glm::dvec3 foot(hips[leg].x, 0, hips[leg].z);
  return {hips[leg], kneeOf(hips[leg], foot, {0, 0, 1}), foot};
}

void addTube(Creature& creature, const glm::dvec3& from, const glm::dvec3& to, uint32_t ofBone) {
  const glm::dvec3 reach(0.03);
  addBox(creature, glm::min(from, to) - reach * glm::dvec3(1, 0, 1),
         glm::max(from, to) + reach * glm::dvec3(1, 0, 1), ofBone);
}

// From rest to the frame of two directions: along the bone, and across the plane of the leg.
glm::dmat4x3 boneFrom(const glm::dvec3& restFrom, const glm::dvec3& restTo, const glm::dvec3& from,
                      const glm::dvec3& to, const glm::dvec3& across) {
  const auto frame = [](const glm::dvec3& along, const glm::dvec3& side) {
    const glm::dvec3 a = glm::normalize(along), c = glm::normalize(side - glm::dot(side, a) * a);
    return glm::dmat3(c, glm::cross(a, c), a);
  };
  const glm::dmat3 turn = frame(to - from, across) * glm::transpose(frame(restTo - restFrom, {1, 0, 0}));
  return {turn[0], turn[1], turn[2], from - turn * restFrom};
}

double smooth(double u) { return u * u * u * (10 - u * (15 - 6 * u)); }

// Where a foot is, and whether it stands.
std::pair<glm::dvec3, bool> footAt(size_t leg, double seconds) {
  const double turn = seconds / cycle + phases[leg], whole = std::floor(turn), share = turn - whole;
  const auto stand = [&](double number) {  // amid the stance below the hip
    return speed * cycle * (number - phases[leg] + 0.5 * standing) + hips[leg].z;
  };
  if (share < standing) return {{hips[leg].x, 0, stand(whole)}, true};
  const double u = (share - standing) / (1 - standing);
  return {{hips[leg].x, lift * 64 * std::pow(u * (1 - u), 3),
           std::lerp(stand(whole), stand(whole + 1), smooth(u))},
          false};
}

Step stepAt(uint64_t tick, const Fault& fault) {
  Step step{.tick = tick,
            .seconds = static_cast<double>(tick) * dt,
            .body = {.asked = speed},
            .moment = {.tick = tick}};
  const double own = fault.clock * step.seconds;
  step.body.position = {0, 0, speed * own};
  const glm::dmat3 plain = step.body.rotation;
  fault.ofBody(step.seconds, step.body);
  step.moment.position = step.body.position;
  const glm::dmat3& turn = step.body.rotation;
  step.moment.bones.push_back({turn[0], turn[1], turn[2], step.body.position});
  for (size_t leg = 0; leg < hips.size(); ++leg) {
    auto [foot, stands] = footAt(leg, own);
    fault.ofFoot(leg, step.seconds, foot);
    const std::array<glm::dvec3, 3> rest = restOf(leg);
    // Legs hang from where the body would be, so that a fault of the body is no fault of theirs.
    const glm::dvec3 hip = glm::dvec3(0, step.body.position.y, speed * own) + plain * hips[leg];
    const glm::dvec3 knee = kneeOf(hip, foot, {0, 0, fault.bendsBack(leg, step.seconds) ? -1 : 1});
    step.moment.bones.push_back(boneFrom(rest[0], rest[1], hip, knee, {1, 0, 0}));
    step.moment.bones.push_back(boneFrom(rest[1], rest[2], knee, foot, {1, 0, 0}));
    step.moment.stands.push_back(stands);
  }
  fault.ofMoment(step.moment);
  return step;
}

}  // namespace

void addBox(Creature& creature, const glm::dvec3& least, const glm::dvec3& most, uint32_t ofBone) {
  const auto first = static_cast<uint32_t>(creature.vertices.size());
  for (uint32_t corner = 0; corner < 8; ++corner)
    creature.vertices.push_back({.rest = {corner & 1 ? most.x : least.x, corner & 2 ? most.y : least.y,
                                          corner & 4 ? most.z : least.z},
                                 .bones = {ofBone, 0, 0, 0}});
  constexpr std::array<uint32_t, 36> faces = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                              2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
  for (const uint32_t index : faces) creature.triangles.push_back(first + index);
}

Creature puppet() {
  Creature creature{.legOfBone = {-1}, .legLength = 1};
  addBox(creature, {-0.2, 0.65, -0.5}, {0.2, 0.95, 0.5}, 0);
  for (size_t leg = 0; leg < hips.size(); ++leg) {
    const std::array<glm::dvec3, 3> rest = restOf(leg);
    const auto thigh = static_cast<uint32_t>(1 + 2 * leg), shin = thigh + 1;
    creature.legs.push_back({{rest[0], thigh}, {rest[1], shin}, {rest[2], shin}});
    creature.legOfBone.insert(creature.legOfBone.end(), 2, static_cast<int>(leg));
    addTube(creature, rest[0], rest[1], thigh);
    addTube(creature, rest[1], rest[2] + glm::dvec3(0, 0.15, 0), shin);
    addBox(creature, rest[2] - glm::dvec3(0.005, 0, 0.005), rest[2] + glm::dvec3(0.005, 0.01, 0.005), shin);
  }
  return creature;
}

std::vector<laws::Figure> walk(double seconds, const Fault& fault) {
  Creature creature = puppet();
  fault.ofModel(creature);
  const laws::Anatomy anatomy(creature);
  const std::vector<float> flat(4, 0.0f);
  const laws::Ground ground{
      .originX = -1000, .originZ = -1000, .spacingX = 2000, .spacingZ = 2000, .heights = flat};
  laws::Tally tally(0, "puppet", "adaptive");
  laws::BodyJudge bodies({&anatomy}, {&creature}, tally);
  std::optional<laws::SkinJudge> skin;
  for (uint64_t tick = 1; static_cast<double>(tick) * dt <= seconds; ++tick) {
    const Step step = stepAt(tick, fault);
    if (tick % windowTicks == 1) {
      if (skin) skin->finish();
      skin.emplace(creature, anatomy, tally, 0, dt);
    }
    skin->look(step.moment, ground);
    if (tick % lookTicks != 0) continue;
    bodies.look(tick, step.seconds, ground, step.body, 0, 0);
    std::vector<laws::Solid> solids = {{&anatomy, &creature, &tally, 0, step.body}};
    if (fault.other)
      solids.push_back({&anatomy, &creature, &tally, 1, step.body}),
          solids.back().body.position += *fault.other;
    laws::judgeApart(tick, solids);
  }
  skin->finish();
  return tally.broken();
}

}  // namespace skitter::test
