#include "crowd/kinds.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <string>
#include <tuple>
#include <utility>

#include "crowd/controller.h"
#include "skitter/error.h"

namespace skitter::crowd {
namespace {

// Each has about ten pipelines. Mesa's software device keeps the machine code of 1024; with more it makes
// some anew in every tick, which then takes 20 times as long.
constexpr size_t kMostKinds = 100;

// What makes a kind. Names every member, so that a new one cannot be forgotten.
auto membersOf(const skitter::Herd& herd) {
  const auto& [rig, controller, clips, cuts, keys, solver, stepping, tuning, agents, spawn, goal, sizes,
               phase, colour, tint] = herd;
  return std::tie(rig, controller, clips, cuts, keys, solver, stepping, tuning);
}

void check(const skitter::Herd& herd, const std::string& what) {
  using skitter::Herd;
  checkTuning(herd.tuning, what + ".tuning");
  if (herd.sizes.size() > Herd::maxSizes)
    throw inputError(
        fmt::format("{}.sizes are {}, expected at most {}", what, herd.sizes.size(), Herd::maxSizes));
  for (size_t s = 0; s < herd.sizes.size(); ++s)
    if (!(herd.sizes[s] >= Herd::minSize && herd.sizes[s] <= Herd::maxSize))
      throw inputError(fmt::format("{}.sizes[{}] is {}, expected {} to {}", what, s, herd.sizes[s],
                                   Herd::minSize, Herd::maxSize));
  if (herd.phase && !(*herd.phase >= 0 && *herd.phase <= 1))
    throw inputError(fmt::format("{}.phase is {}, expected 0 to 1", what, *herd.phase));
  if (herd.tint && !(*herd.tint >= 0 && *herd.tint <= 1))
    throw inputError(fmt::format("{}.tint is {}, expected 0 to 1", what, *herd.tint));
  if (herd.colour)
    for (int i = 0; i < 3; ++i)
      if (!((*herd.colour)[i] >= 0 && (*herd.colour)[i] <= 1))
        throw inputError(fmt::format("{}.colour[{}] is {}, expected 0 to 1", what, i, (*herd.colour)[i]));
}

// All of them, their kinds yet to be found.
std::vector<SizedHerd> sizedHerds(const Scene& scene) {
  std::vector<SizedHerd> herds;
  for (uint32_t h = 0; h < scene.herds.size(); ++h) {
    check(scene.herds[h], fmt::format("{}: herds[{}]", scene.name, h));
    const std::vector<float>& sizes = scene.herds[h].sizes;
    if (sizes.empty()) herds.push_back({.herd = h});
    for (size_t s = 0; s < sizes.size(); ++s) herds.push_back({.herd = h, .place = s, .size = sizes[s]});
  }
  return herds;
}

// `areEqual` compares what the rigs of two herds, by number, are.
template <class Equal>
Kinds grouped(const Scene& scene, const Equal& areEqual) {
  Kinds kinds{.herds = sizedHerds(scene)};
  for (uint32_t r = 0; r < kinds.herds.size(); ++r) {
    SizedHerd& herd = kinds.herds[r];
    const auto isOfIt = [&](uint32_t other) {
      const SizedHerd& first = kinds.herds[other];
      return first.size == herd.size &&
             membersOf(scene.herds[first.herd]) == membersOf(scene.herds[herd.herd]) &&
             areEqual(first.herd, herd.herd);
    };
    const auto found = std::ranges::find_if(kinds.firstHerds, isOfIt);
    herd.kind = static_cast<uint32_t>(found - kinds.firstHerds.begin());
    if (found == kinds.firstHerds.end()) kinds.firstHerds.push_back(r);
  }
  if (kinds.firstHerds.size() > kMostKinds)
    throw inputError(
        fmt::format("{}: {} herds differ in rig, controller, clips, cuts, keys, solver, stepping, tuning or "
                    "size, expected at most {}: each of them, and each size of one, has pipelines of its "
                    "own; equal herds share them, whatever their agents, spawn, goal and phase",
                    scene.name, kinds.firstHerds.size(), kMostKinds));
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
  const auto herdOf = [&](uint32_t run) -> const skitter::Herd& {
    return scene.herds[kinds.herds[run].herd];
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

Kinds kindsOf(const Scene& scene, std::vector<Rig> rigs) {
  assert(rigs.size() == scene.herds.size());
  Kinds kinds = grouped(scene, [&](uint32_t a, uint32_t b) { return rigs[a] == rigs[b]; });
  for (const uint32_t run : kinds.firstHerds) kinds.rigs.push_back(rigs[kinds.herds[run].herd]);
  return kinds;
}

}  // namespace skitter::crowd
