#include "evolve/patterns.h"

#include <bit>

#include "crowd/symmetry.h"

namespace skitter::evolve {
namespace {

constexpr int fewestCarriers = 3;   // on fewer a creature lies down
constexpr size_t mostSearched = 8;  // legs of a rig all of whose patterns are searched
constexpr int idleOfMany = 2;       // legs that are idle at most in one with more

}  // namespace

std::vector<uint32_t> patternsOf(const Rig& rig) {
  const std::vector<size_t> mirror = crowd::mirroredLegs(rig);
  const size_t legs = rig.legs.size();
  std::vector<uint32_t> patterns;
  for (uint32_t idle = 1; idle >> legs == 0; ++idle) {
    const int count = std::popcount(idle);
    if (rig.legCount() - count < fewestCarriers) continue;
    if (legs > mostSearched && count > idleOfMany) continue;
    if (!mirror.empty() && crowd::mirrored(idle, mirror) < idle) continue;
    patterns.push_back(idle);
  }
  return patterns;
}

}  // namespace skitter::evolve
