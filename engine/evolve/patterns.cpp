#include "evolve/patterns.h"

#include "crowd/gait_map.h"
#include "crowd/symmetry.h"

namespace skitter::evolve {

std::vector<uint32_t> patternsOf(const Rig& rig) {
  const std::vector<size_t> mirror = crowd::mirroredLegs(rig);
  std::vector<uint32_t> patterns = crowd::walkingPatterns(rig);
  std::erase_if(patterns,
                [&](uint32_t idle) { return !mirror.empty() && crowd::mirrored(idle, mirror) < idle; });
  return patterns;
}

}  // namespace skitter::evolve
