#include "crowd/kinds.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <tuple>
#include <utility>

#include "crowd/controller.h"
#include "skitter/error.h"

namespace skitter::crowd {
namespace {

// What makes a kind. Names every member, so that a new one cannot be forgotten.
auto membersOf(const skitter::Herd& herd) {
  const auto& [rig, controller, clips, cuts, keys, solver, stepping, tuning, agents, reserve, spawn, goal,
               phase, colour, tint] = herd;
  return std::tuple_cat(std::tie(rig, controller, clips, cuts, keys, solver, stepping, tuning),
                        std::tuple(reserve > 0));
}

void check(const skitter::Herd& herd, const std::string& what) {
  checkTuning(herd.tuning, what + ".tuning");
  if (herd.phase && !(*herd.phase >= 0 && *herd.phase <= 1))
    throw inputError(fmt::format("{}.phase is {}, expected 0 to 1", what, *herd.phase));
  if (herd.tint && !(*herd.tint >= 0 && *herd.tint <= 1))
    throw inputError(fmt::format("{}.tint is {}, expected 0 to 1", what, *herd.tint));
  for (int i = 0; herd.colour && i < 3; ++i)
    if (!((*herd.colour)[i] >= 0 && (*herd.colour)[i] <= 1))
      throw inputError(fmt::format("{}.colour[{}] is {}, expected 0 to 1", what, i, (*herd.colour)[i]));
}

// `areEqual` compares what the rigs of two herds, by number, are.
template <class Equal>
Kinds grouped(const Scene& scene, const Equal& areEqual) {
  for (size_t h = 0; h < scene.herds.size(); ++h)
    check(scene.herds[h], fmt::format("{}: herds[{}]", scene.name, h));
  Kinds kinds;
  for (uint32_t h = 0; h < scene.herds.size(); ++h) {
    const auto isOfIt = [&](uint32_t first) {
      return membersOf(scene.herds[first]) == membersOf(scene.herds[h]) && areEqual(first, h);
    };
    const auto found = std::ranges::find_if(kinds.firstHerds, isOfIt);
    kinds.ofHerds.push_back(static_cast<uint32_t>(found - kinds.firstHerds.begin()));
    if (found == kinds.firstHerds.end()) kinds.firstHerds.push_back(h);
  }
  if (kinds.firstHerds.size() > mostKinds)
    throw inputError(
        scene.name + ": " + std::to_string(kinds.firstHerds.size()) +
        " herds differ in rig, controller, clips, cuts, keys, solver, stepping or tuning, expected at most " +
        std::to_string(mostKinds) +
        ": each of them has pipelines of its own; equal herds share them, whatever their agents, "
        "spawn and goal");
  return kinds;
}

// Whether legs are proposed where the model has none.
bool proposes(const skitter::Herd& herd) { return traitsOf(herd.controller).needsClips; }

Rig rigOf(const skitter::Herd& herd) {
  if (herd.rig == "spider") return spiderRig();
  return proposes(herd) ? proposedRig(herd.rig) : loadRig(herd.rig);
}

}  // namespace

Kinds kindsOf(const Scene& scene) {
  Kinds kinds = grouped(scene, [](uint32_t, uint32_t) { return true; });
  for (size_t k = 0; k < kinds.firstHerds.size(); ++k) {
    const skitter::Herd& herd = scene.herds[kinds.firstHerds[k]];
    const auto hasItsRig = [&](uint32_t other) {
      return scene.herds[other].rig == herd.rig && proposes(scene.herds[other]) == proposes(herd);
    };
    const auto earlier =
        static_cast<size_t>(std::ranges::find_if(kinds.firstHerds, hasItsRig) - kinds.firstHerds.begin());
    kinds.rigs.push_back(earlier < k ? kinds.rigs[earlier] : rigOf(herd));
  }
  return kinds;
}

Kinds kindsOf(const Scene& scene, std::vector<Rig> rigs) {
  if (rigs.size() != scene.herds.size())
    throw inputError(fmt::format("{}: {} rigs were given, expected one for each of {} herds", scene.name,
                                 rigs.size(), scene.herds.size()));
  Kinds kinds = grouped(scene, [&](uint32_t a, uint32_t b) { return rigs[a] == rigs[b]; });
  for (const uint32_t h : kinds.firstHerds) kinds.rigs.push_back(std::move(rigs[h]));
  return kinds;
}

}  // namespace skitter::crowd
