#include "crowd/kinds.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <tuple>

#include "crowd/controller.h"
#include "crowd/spawn.h"
#include "crowd/steer.h"
#include "skitter/error.h"

namespace skitter::crowd {
namespace {

// What makes a kind. Names every member, so that a new one cannot be forgotten.
auto membersOf(const skitter::Herd& herd) {
  const auto& [rig, controller, clips, cuts, keys, solver, stepping, tuning, agents, reserve, spawn, goal,
               sizes, avoid, ways, threat, forage, phase, colour, tint, hurt, reactions, adapts] = herd;
  return std::tuple_cat(std::tie(rig, controller, clips, cuts, keys, solver, stepping, tuning, avoid, ways,
                                 threat, forage, hurt, reactions, adapts),
                        std::tuple(reserve > 0));
}

// `areEqual` compares what the rigs of two herds, by number, are.
template <class Equal>
Kinds grouped(const Scene& scene, const Equal& areEqual) {
  Kinds kinds;
  for (uint32_t h = 0; h < scene.herds.size(); ++h) {
    checkHerd(scene.herds[h], fmt::format("{}: herds[{}]", scene.name, h));
    for (const float size : sizesOf(scene.herds[h])) kinds.herds.push_back({.herd = h, .size = size});
  }
  for (uint32_t i = 0; i < kinds.herds.size(); ++i) {
    const auto isOfIt = [&](uint32_t other) {
      const SizedHerd &a = kinds.herds[other], &b = kinds.herds[i];
      return a.size == b.size && membersOf(scene.herds[a.herd]) == membersOf(scene.herds[b.herd]) &&
             areEqual(a.herd, b.herd);
    };
    const auto found = std::ranges::find_if(kinds.firstHerds, isOfIt);
    kinds.herds[i].kind = static_cast<uint32_t>(found - kinds.firstHerds.begin());
    if (found == kinds.firstHerds.end()) kinds.firstHerds.push_back(i);
  }
  if (kinds.firstHerds.size() > mostKinds)
    throw inputError(fmt::format(
        "{}: {} herds differ in rig, controller, clips, cuts, keys, solver, stepping, tuning, "
        "avoid, ways, threat, forage, hurt, reactions, adapts or size, expected at most {}: each of them, "
        "and each "
        "size "
        "of one, has pipelines of its own; equal herds share them, whatever their agents, spawn and goal",
        scene.name, kinds.firstHerds.size(), mostKinds));
  return kinds;
}

// Whether legs are proposed where the model has none.
bool proposes(const skitter::Herd& herd) { return traitsOf(herd.controller).needsClips; }

void checkHurt(const skitter::Herd& herd, const std::string& what) {
  if (!traitsOf(herd.controller).canBeHurt)
    throw inputError(
        fmt::format("{}.controller is {}, expected adaptive, loop or planted: its legs can be hurt", what,
                    nameOf(herd.controller)));
  if (herd.solver != Solver::activeSet)
    throw inputError(fmt::format("{}.solver is {}, expected {}: its legs can be hurt", what,
                                 nameOf(herd.solver), nameOf(Solver::activeSet)));
}

void checkReactions(const skitter::Herd& herd, const std::string& what) {
  if (herd.controller != Controller::adaptive)
    throw inputError(fmt::format("{}.controller is {}, expected adaptive: it has reactions", what,
                                 nameOf(herd.controller)));
  if (herd.solver != Solver::activeSet)
    throw inputError(fmt::format("{}.solver is {}, expected {}: it has reactions", what, nameOf(herd.solver),
                                 nameOf(Solver::activeSet)));
}

void checkAdapts(const skitter::Herd& herd, const std::string& what) {
  if (herd.controller != Controller::adaptive)
    throw inputError(
        fmt::format("{}.controller is {}, expected adaptive: it adapts", what, nameOf(herd.controller)));
  if (!herd.hurt && !herd.reactions)
    throw inputError(fmt::format("{}.hurt is false, expected true: it adapts", what));
}

// The ranges of a scene file.
void checkSpawn(const Spawn& spawn, const std::string& what) {
  constexpr double most = Scene::maxCoordinate;
  const auto name = [&] { return what; };
  expectWithin(name, "spawn.spacing", double{spawn.spacing}, double{0.01f}, most, "m");
  expectWithin(name, "spawn.centre x", double{spawn.centre.x}, -most, most, "m");
  expectWithin(name, "spawn.centre z", double{spawn.centre.y}, -most, most, "m");
  expectWithin(name, "spawn.heading", double{spawn.heading}, -1000, 1000, "radians");
}

// The ranges of a scene file.
void checkWays(const Ways& ways, const std::string& what) {
  const auto expect = [&](const char* key, float value, float least, float most) {
    if (!(value >= least && value <= most))
      throw inputError(fmt::format("{}: ways.{} is {}, expected {} to {}", what, key, value, least, most));
  };
  expect("climb", ways.climb, 0, Ways::maxClimb);
  expect("steepest", ways.steepest, Ways::minLimit, Ways::maxLimit);
  expect("step", ways.step, Ways::minLimit, Ways::maxLimit);
}

// The ranges of a scene file.
void checkForage(const skitter::Herd& herd, const std::string& what) {
  const Forage& forage = *herd.forage;
  const auto expect = [&](const std::string& key, auto value, double least, double most) {
    if (!(static_cast<double>(value) >= least && static_cast<double>(value) <= most))
      throw inputError(fmt::format("{}: forage.{} is {}, expected {} to {}", what, key, value, least, most));
  };
  const auto expectDisc = [&](const std::string& key, const glm::vec2& centre, float radius) {
    constexpr double most = Scene::maxCoordinate;
    expect(key + ".centre[0]", centre.x, -most, most);
    expect(key + ".centre[1]", centre.y, -most, most);
    expect(key + ".radius", radius, Disc::minRadius, most);
  };
  if (sizesOf(herd).size() > 1)
    throw inputError(fmt::format("{}: forages in {} sizes, expected one: each would be a colony of its own",
                                 what, sizesOf(herd).size()));
  if (forage.food.size() > Forage::maxSources || forage.branches.size() > Forage::maxBranches)
    throw inputError(fmt::format("{}: forage has {} sources of food and {} branches, expected at most {}",
                                 what, forage.food.size(), forage.branches.size(), Forage::maxSources));
  expectDisc("nest", forage.nest.centre, forage.nest.radius);
  for (size_t i = 0; i < forage.food.size(); ++i) {
    const FoodSource& source = forage.food[i];
    expectDisc(fmt::format("food[{}]", i), source.centre, source.radius);
    expect(fmt::format("food[{}].amount", i), source.amount, 0, FoodSource::maxAmount);
  }
  for (size_t i = 0; i < forage.branches.size(); ++i)
    expectDisc(fmt::format("branches[{}]", i), forage.branches[i].centre, forage.branches[i].radius);
  expect("cell", forage.cell, Forage::minCell, Forage::maxCell);
  expect("threshold", forage.threshold, 0, Forage::maxThreshold);
  expect("power", forage.power, 1, Forage::maxPower);
  expect("layHome", forage.layHome, 0, Forage::maxLaid);
  expect("layOut", forage.layOut, 0, Forage::maxLaid);
  expect("life", forage.life, Forage::minLife, Forage::maxLife);
  expect("patience", forage.patience, 1, Forage::maxPatience);
  expect("rest", forage.rest, 0, Forage::maxRest);
  if (forage.load.mass == 0) return;
  expectLoad([&] { return what + ".forage"; }, forage.load);
  expectCarries([&] { return what; }, herd);
}

}  // namespace

void checkHerd(const skitter::Herd& herd, const std::string& what) {
  using skitter::Herd;
  checkTuning(herd.tuning, what + ".tuning");
  if (herd.hurt) checkHurt(herd, what);
  if (herd.reactions) checkReactions(herd, what);
  if (herd.adapts) checkAdapts(herd, what);
  if (herd.sizes.size() > Herd::maxSizes)
    throw inputError(
        fmt::format("{}.sizes are {}, expected at most {}", what, herd.sizes.size(), Herd::maxSizes));
  for (size_t s = 0; s < herd.sizes.size(); ++s)
    if (!(herd.sizes[s] >= Herd::minSize && herd.sizes[s] <= Herd::maxSize))
      throw inputError(fmt::format("{}.sizes[{}] is {}, expected {} to {}", what, s, herd.sizes[s],
                                   Herd::minSize, Herd::maxSize));
  // Of agents alone, of one size, there is said how much memory they need.
  if (const uint64_t places = uint64_t{herd.agents} + herd.reserve;
      (herd.sizes.size() > 1 || herd.reserve > 0) && places > Scene::maxAgents)
    throw inputError(
        fmt::format("{}: {} agents and reserve, expected at most {}", what, places, Scene::maxAgents));
  checkSpawn(herd.spawn, what);
  expectGoal([&] { return what; }, herd.goal);
  if (herd.ways) checkWays(*herd.ways, what);
  expectWithin([&] { return what; }, "threat", double{herd.threat}, 0, Scene::maxCoordinate, "m");
  if (herd.forage) checkForage(herd, what);
  if (herd.phase && !(*herd.phase >= 0 && *herd.phase <= 1))
    throw inputError(fmt::format("{}.phase is {}, expected 0 to 1", what, *herd.phase));
  if (herd.tint && !(*herd.tint >= 0 && *herd.tint <= 1))
    throw inputError(fmt::format("{}.tint is {}, expected 0 to 1", what, *herd.tint));
  for (int i = 0; herd.colour && i < 3; ++i)
    if (!((*herd.colour)[i] >= 0 && (*herd.colour)[i] <= 1))
      throw inputError(fmt::format("{}.colour[{}] is {}, expected 0 to 1", what, i, (*herd.colour)[i]));
}

Rig rigOf(const skitter::Herd& herd) {
  if (herd.rig == "spider") return spiderRig();
  return proposes(herd) ? proposedRig(herd.rig) : loadRig(herd.rig);
}

Kinds kindsOf(const Scene& scene) {
  Kinds kinds = grouped(scene, [](uint32_t, uint32_t) { return true; });
  const auto herdOf = [&](uint32_t sized) -> const skitter::Herd& {
    return scene.herds[kinds.herds[sized].herd];
  };
  for (size_t k = 0; k < kinds.firstHerds.size(); ++k) {
    const skitter::Herd& herd = herdOf(kinds.firstHerds[k]);
    const auto hasItsRig = [&](uint32_t other) {
      return herdOf(other).rig == herd.rig && proposes(herdOf(other)) == proposes(herd);
    };
    const auto earlier =
        static_cast<size_t>(std::ranges::find_if(kinds.firstHerds, hasItsRig) - kinds.firstHerds.begin());
    kinds.rigs.push_back(earlier < k ? kinds.rigs[earlier] : rigOf(herd));
  }
  return kinds;
}

Kinds kindsOf(const Scene& scene, const std::vector<Rig>& rigs) {
  if (rigs.size() != scene.herds.size())
    throw inputError(fmt::format("{}: {} rigs were given, expected one for each of {} herds", scene.name,
                                 rigs.size(), scene.herds.size()));
  Kinds kinds = grouped(scene, [&](uint32_t a, uint32_t b) { return rigs[a] == rigs[b]; });
  for (const uint32_t first : kinds.firstHerds) kinds.rigs.push_back(rigs[kinds.herds[first].herd]);
  return kinds;
}

}  // namespace skitter::crowd
