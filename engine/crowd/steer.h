#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/spelling.h"
#include "skitter/error.h"
#include "skitter/heightfield.h"
#include "skitter/rig.h"
#include "skitter/scene.h"

// What may be said to agents while a crowd runs, by the host and by a scene's events. Each throws
// Error(input); `name` makes the text that says whom it is about.
namespace skitter::crowd {

template <class Name>
void expectWithin(const Name& name, const char* what, double value, double least, double most,
                  const char* unit) {
  if (value >= least && value <= most) return;
  throw inputError(
      fmt::format("{}: {} is {:.6g} {}, expected {:.6g} to {:.6g}", name(), what, value, unit, least, most));
}

template <class Name>
void expectSpeed(const Name& name, const char* what, float speed) {
  expectWithin(name, what, double{speed}, 0, double{Goal::maxSpeed}, "m/s");
}

// Only what the goal's kind reads.
template <class Name>
void expectGoal(const Name& name, const Goal& goal) {
  constexpr double most = Scene::maxCoordinate;
  switch (goal.kind) {
    case Goal::Kind::velocity:
      expectSpeed(name, "the length of goal.velocity", glm::length(goal.velocity));
      return;
    case Goal::Kind::point:
      expectWithin(name, "goal.target x", double{goal.target.x}, -most, most, "m");
      expectWithin(name, "goal.target z", double{goal.target.y}, -most, most, "m");
      [[fallthrough]];
    case Goal::Kind::cross:
      expectSpeed(name, "goal.speed", goal.speed);
      return;
    case Goal::Kind::route:
      if (goal.places.empty() || goal.places.size() > Goal::maxPlaces)
        throw inputError(fmt::format("{}: goal.places are {}, expected 1 to {}", name(), goal.places.size(),
                                     Goal::maxPlaces));
      for (const glm::vec2& place : goal.places)
        for (int i = 0; i < 2; ++i)
          expectWithin(name, i == 0 ? "a goal.places x" : "a goal.places z", double{place[i]}, -most, most,
                       "m");
      return expectSpeed(name, "goal.speed", goal.speed);
    case Goal::Kind::roam:
      expectWithin(name, "goal.target x", double{goal.target.x}, -most, most, "m");
      expectWithin(name, "goal.target z", double{goal.target.y}, -most, most, "m");
      expectWithin(name, "goal.radius", double{goal.radius}, Disc::minRadius, most, "m");
      return expectSpeed(name, "goal.speed", goal.speed);
    case Goal::Kind::follow:
    case Goal::Kind::flee:
      return expectSpeed(name, "goal.speed", goal.speed);
    case Goal::Kind::none:
      return;
  }
  throw inputError(
      fmt::format("{}: goal.kind is {}, expected one of Goal::Kind", name(), static_cast<int>(goal.kind)));
}

// `herd` is the one whose agents have the goal, and leaderOf(number) the herd of that number, which it throws
// for where there is none.
template <class Name, class LeaderOf>
void expectItsHerds(const Name& name, const Goal& goal, const skitter::Herd& herd, const LeaderOf& leaderOf) {
  using enum Goal::Kind;
  const bool needsWays = goal.kind == route || goal.kind == roam || goal.kind == follow || goal.kind == flee;
  if (needsWays && !herd.ways)
    throw inputError(
        fmt::format("{}: goal.kind is route, roam, follow or flee, expected a herd with ways", name()));
  if (goal.kind != follow) return;
  const skitter::Herd& leader = leaderOf(goal.leader);
  const uint64_t places = uint64_t{leader.agents} + leader.reserve;
  if (goal.agent && *goal.agent >= places)
    throw inputError(fmt::format("{}: goal.agent is {}, expected less than {}, the places of herd {}", name(),
                                 *goal.agent, places, goal.leader));
}

template <class Name>
void expectPlace(const Name& name, const Heightfield& terrain, const Place& place) {
  const double x = double{terrain.extentX()} / 2, z = double{terrain.extentZ()} / 2;
  expectWithin(name, "x", double{place.position.x}, -x, x, "m");
  expectWithin(name, "z", double{place.position.y}, -z, z, "m");
  expectWithin(name, "the heading", double{place.heading}, -1000, 1000, "radians");
}

template <class Name>
void expectHurts(const Name& name, bool hurts) {
  if (!hurts)
    throw inputError(fmt::format("{}: hurt is false, expected a herd whose legs can be hurt", name()));
}

template <class Name>
void expectCarries(const Name& name, const skitter::Herd& herd) {
  if (!herd.hurt && !herd.reactions)
    throw inputError(fmt::format("{}: hurt is false, expected true where agents carry", name()));
  if (herd.adapts)
    throw inputError(fmt::format("{}: adapts is true, expected false where agents carry", name()));
}

template <class Name>
void expectLoad(const Name& name, const Load& load) {
  expectWithin(name, "load.mass", double{load.mass}, 0, double{Load::maxMass}, "of the agent's mass");
  for (int i = 0; i < 3; ++i)
    expectWithin(name, std::array{"load.offset x", "load.offset y", "load.offset z"}[static_cast<size_t>(i)],
                 double{load.offset[i]}, -double{Load::maxOffset}, double{Load::maxOffset}, "leg lengths");
}

// And the bone, if any, from which it is lost.
template <class Name>
void expectLeg(const Name& name, const Rig& rig, uint32_t leg, std::optional<uint32_t> bone) {
  if (leg >= rig.legs.size())
    throw inputError(fmt::format("{}: leg is {}, expected less than {}, the legs of {}", name(), leg,
                                 rig.legs.size(), rig.name));
  const size_t bones = rig.legs[leg].bones.size();
  if (bone && *bone >= bones)
    throw inputError(fmt::format("{}: bone is {}, expected less than {}, the bones of leg {}", name(), *bone,
                                 bones, rig.legs[leg].name));
}

template <class Name>
void expectReacts(const Name& name, bool reacts) {
  if (!reacts)
    throw inputError(fmt::format("{}: reactions is false, expected a herd with reactions", name()));
}

template <class Name>
void expectPush(const Name& name, const glm::vec2& velocity) {
  expectWithin(name, "the length of the push", double{glm::length(velocity)}, 0, double{Push::most}, "m/s");
}

// The number of the leg of that name.
template <class Name>
uint32_t legNamed(const Name& name, const Rig& rig, const std::string& leg) {
  const auto found = std::ranges::find(rig.legs, leg, &Leg::name);
  if (found != rig.legs.end()) return static_cast<uint32_t>(found - rig.legs.begin());
  std::vector<std::string> names;
  for (const Leg& each : rig.legs) names.push_back(each.name);
  throw inputError(fmt::format("{}: {} has no leg \"{}\"{}", name(), rig.name, leg,
                               base::expectedOneOf(leg, names, "\"")));
}

// The number of the leg that an event is about, and of which it may say so.
template <class Name>
uint32_t legOf(const Name& name, const Rig& rig, const LegChange& change) {
  const uint32_t leg = legNamed(name, rig, change.leg);
  expectLeg(name, rig, leg, change.bone);
  return leg;
}

template <class Name>
void expectReserve(const Name& name, bool reserves) {
  if (!reserves)
    throw inputError(
        fmt::format("{}: its reserve is 0, expected at least 1 where agents come and go", name()));
}

}  // namespace skitter::crowd
