// What a scene's events may be, before its crowd runs.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "assets/scenes/obstacles.h"
#include "crowd/events.h"
#include "crowd/roster.h"
#include "crowd/steer.h"
#include "skitter/error.h"

namespace skitter::crowd {
namespace {

// What messages call the event that is looked at, and the herds that there are then.
struct Where {
  const Scene& scene;
  const Kinds& kinds;  // of the scene's herds
  const Heightfield& terrain;
  Roster& herds;
  std::string event;
};

void check(const Mound& mound, const Where& at) {
  if (!(mound.radius > 0 && std::isfinite(mound.radius) && std::isfinite(mound.height) &&
        std::isfinite(mound.centre.x) && std::isfinite(mound.centre.y)))
    throw inputError(fmt::format("{}.mound: expected a radius above 0, and finite numbers", at.event));
}

// As Heightfield::edit will.
void check(const HeightSamples& edit, const Where& at) {
  const auto& [x, z, columns, rows, heights] = edit;
  const Heightfield& terrain = at.terrain;
  if (uint64_t{x} + columns > terrain.columns || uint64_t{z} + rows > terrain.rows)
    throw inputError(fmt::format("{}.edit: {} x {} samples at {}, {}, expected some of the {} x {} of {}",
                                 at.event, columns, rows, x, z, terrain.columns, terrain.rows, terrain.name));
  if (heights.size() != uint64_t{columns} * rows)
    throw inputError(
        fmt::format("{}.edit: {} heights, expected {}", at.event, heights.size(), uint64_t{columns} * rows));
  if (!std::ranges::all_of(heights, [](float height) { return std::isfinite(height); }))
    throw inputError(fmt::format("{}.edit: a height is not finite", at.event));
}

const skitter::Herd& herdOf(const char* key, uint32_t number, const Where& at) {
  const size_t herds = at.herds.numbers();
  if (number >= herds)
    throw inputError(
        fmt::format("{}.{} is {}, expected less than {}, the number of herds", at.event, key, number, herds));
  const skitter::Herd* herd = at.herds.find(number);
  if (herd == nullptr)
    throw inputError(fmt::format("{}.{} is {}, a herd that was removed, expected one that is there", at.event,
                                 key, number));
  return *herd;
}

void expectCount(const char* key, size_t found, size_t least, const Where& at) {
  if (found < least || found > Event::maxAgents)
    throw inputError(
        fmt::format("{}.{} has {} agents, expected {} to {}", at.event, key, found, least, Event::maxAgents));
}

template <class Name>
void expectAgent(const Name& name, uint32_t agent, const skitter::Herd& herd) {
  const uint64_t places = uint64_t{herd.agents} + herd.reserve;
  if (agent >= places)
    throw inputError(
        fmt::format("{} is {}, expected less than {}, the places of its herd", name(), agent, places));
}

void checkAgents(const char* key, const std::vector<uint32_t>& agents, size_t least,
                 const skitter::Herd& herd, const Where& at) {
  expectCount(key, agents.size(), least, at);
  for (size_t i = 0; i < agents.size(); ++i)
    expectAgent([&] { return fmt::format("{}.{}[{}]", at.event, key, i); }, agents[i], herd);
}

void expectItsReserve(uint32_t number, const skitter::Herd& herd, const Where& at) {
  expectReserve([&] { return fmt::format("{}: herd {}", at.event, number); }, herd.reserve > 0);
}

template <class Name>
void checkGoal(const Name& name, const Goal& goal, const skitter::Herd& herd, const Where& at) {
  expectGoal(name, goal);
  expectItsHerds(name, goal, herd,
                 [&](uint32_t number) -> const skitter::Herd& { return herdOf("goal.herd", number, at); });
}

void check(const GoalChange& change, const Where& at) {
  const skitter::Herd& herd = herdOf("herd", change.herd, at);
  checkAgents("agents", change.agents, 0, herd, at);
  checkGoal([&] { return at.event; }, change.goal, herd, at);
}

void check(const SpeedChange& change, const Where& at) {
  checkAgents("agents", change.agents, 0, herdOf("herd", change.herd, at), at);
  expectSpeed([&] { return at.event; }, "the speed", change.speed);
}

void check(const Teleport& teleport, const Where& at) {
  const skitter::Herd& herd = herdOf("herd", teleport.herd, at);
  expectCount("teleport", teleport.moves.size(), 1, at);
  for (size_t i = 0; i < teleport.moves.size(); ++i) {
    const auto name = [&] { return fmt::format("{}.teleport[{}]", at.event, i); };
    expectAgent([&] { return name() + ".agent"; }, teleport.moves[i].agent, herd);
    expectPlace(name, at.terrain, teleport.moves[i].place);
  }
}

void check(const Addition& addition, const Where& at) {
  const skitter::Herd& herd = herdOf("herd", addition.herd, at);
  expectItsReserve(addition.herd, herd, at);
  expectCount("add", addition.arrivals.size(), 1, at);
  for (size_t i = 0; i < addition.arrivals.size(); ++i) {
    const auto& [place, goal] = addition.arrivals[i];
    const auto name = [&] { return fmt::format("{}.add[{}]", at.event, i); };
    expectPlace(name, at.terrain, place);
    if (goal) checkGoal(name, *goal, herd, at);
  }
}

void check(const Removal& removal, const Where& at) {
  const skitter::Herd& herd = herdOf("herd", removal.herd, at);
  expectItsReserve(removal.herd, herd, at);
  checkAgents("remove", removal.agents, 1, herd, at);
  std::vector<uint32_t> sorted = removal.agents;
  std::ranges::sort(sorted);
  const auto twice = std::ranges::adjacent_find(sorted);
  if (twice != sorted.end())
    throw inputError(fmt::format("{}.remove has agent {} twice, expected once", at.event, *twice));
}

// The rig of a herd that the crowd begins with; nullptr for one that comes, whose file is read later.
const Rig* knownRig(const skitter::Herd& herd, const Where& at) {
  for (const SizedHerd& sized : at.kinds.herds)
    if (&at.scene.herds[sized.herd] == &herd) return &at.kinds.rigs[sized.kind];
  return nullptr;
}

// Agents, or a share of them.
template <class Change>
void checkWhom(const Change& change, const skitter::Herd& herd, const Where& at) {
  checkAgents("agents", change.agents, 0, herd, at);
  if (change.share && !change.agents.empty())
    throw inputError(fmt::format("{} has agents and a share, expected one of them", at.event));
  if (change.share)
    expectWithin([&] { return at.event; }, "the share", double{*change.share}, 0, 1, "of the agents");
}

void check(const Push& push, const Where& at) {
  const skitter::Herd& herd = herdOf("herd", push.herd, at);
  expectReacts([&] { return fmt::format("{}: herd {}", at.event, push.herd); }, herd.reactions);
  checkWhom(push, herd, at);
  expectPush([&] { return at.event; }, push.velocity);
}

void check(const LegChange& change, const Where& at) {
  const skitter::Herd& herd = herdOf("herd", change.herd, at);
  const auto name = [&] { return at.event; };
  expectHurts([&] { return fmt::format("{}: herd {}", at.event, change.herd); }, herd.hurt || herd.reactions);
  checkWhom(change, herd, at);
  if (const Rig* rig = knownRig(herd, at)) legOf(name, *rig, change);
}

void check(const LoadChange& change, const Where& at) {
  const skitter::Herd& herd = herdOf("herd", change.herd, at);
  expectCarries([&] { return fmt::format("{}: herd {}", at.event, change.herd); }, herd);
  checkWhom(change, herd, at);
  expectLoad([&] { return at.event; }, change.load);
}

void check(const HerdAddition& addition, const Where& at) {
  const std::string name = at.event + ".addHerd";
  checkHerd(addition.herd, name);
  checkGoal([&] { return name; }, addition.herd.goal, addition.herd, at);
  at.herds.add(addition.herd, name);
}

void check(const HerdRemoval& removal, const Where& at) {
  herdOf("removeHerd", removal.herd, at);
  at.herds.remove(removal.herd, fmt::format("{}.removeHerd: herd {}", at.event, removal.herd));
}

void check(const ThreatChange& change, const Where& at) {
  if (change.number >= Scene::maxThreats)
    throw inputError(fmt::format("{}.threat.number is {}, expected less than {}", at.event, change.number,
                                 Scene::maxThreats));
  scenes::checkThreat(change.threat, at.event + ".threat");
}

}  // namespace

uint64_t checkEvents(const Scene& scene, const Heightfield& terrain, const Kinds& kinds) {
  Roster herds(scene, kinds);
  uint64_t most = herds.places();
  for (size_t e = 0; e < scene.events.size(); ++e) {
    const Event& event = scene.events[e];
    const Where where{scene, kinds, terrain, herds, fmt::format("{}: events[{}]", scene.name, e)};
    if (!(event.at >= 0 && event.at <= Event::maxTime))
      throw inputError(fmt::format("{}.at is {}, expected 0 to {} s", where.event, event.at, Event::maxTime));
    if (e > 0 && event.at < scene.events[e - 1].at)
      throw inputError(fmt::format("{}.at is {}, expected {} or later, as the event before it", where.event,
                                   event.at, scene.events[e - 1].at));
    std::visit([&](const auto& what) { check(what, where); }, event.what);
    if (std::holds_alternative<HerdAddition>(event.what)) most = std::max(most, herds.places());
  }
  return most;
}

}  // namespace skitter::crowd
