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
               sizes, phase, colour, tint, hurt] = herd;
  return std::tuple_cat(std::tie(rig, controller, clips, cuts, keys, solver, stepping, tuning, hurt),
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
    throw inputError(
        fmt::format("{}: {} herds differ in rig, controller, clips, cuts, keys, solver, stepping, tuning or "
                    "size, expected at most {}: each of them, and each size of one, has pipelines of its "
                    "own; equal herds share them, whatever their agents, spawn and goal",
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

// The ranges of a scene file.
void checkSpawn(const Spawn& spawn, const std::string& what) {
  constexpr double most = Scene::maxCoordinate;
  const auto name = [&] { return what; };
  expectWithin(name, "spawn.spacing", double{spawn.spacing}, 0.01, most, "m");
  expectWithin(name, "spawn.centre x", double{spawn.centre.x}, -most, most, "m");
  expectWithin(name, "spawn.centre z", double{spawn.centre.y}, -most, most, "m");
  expectWithin(name, "spawn.heading", double{spawn.heading}, -1000, 1000, "radians");
}

}  // namespace

void checkHerd(const skitter::Herd& herd, const std::string& what) {
  using skitter::Herd;
  checkTuning(herd.tuning, what + ".tuning");
  if (herd.hurt) checkHurt(herd, what);
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
