#include "hand_clips.h"

namespace skitter::test {

reference::ClipTable threeGaits() {
  reference::ClipTable table;
  table.clips = {{0, 2, 2, 0}, {2, 5, 1, 1}, {7, 2, 0.5, 2}};
  for (const double time : {0.0, 2.0, 0.0, 0.25, 0.5, 0.5, 1.0, 0.0, 0.5}) table.frames.push_back({time, 0});
  table.matrices.assign(table.frames.size(), reference::Affine(1));
  table.bones = {{-1, 0}};
  return table;
}

reference::ClipTable restClip(const reference::Creature& creature) {
  reference::ClipTable table;
  table.clips = {{0, 1, 0, 0}};
  table.frames = {{0, ~0u}};
  for (size_t l = 0; l < creature.limbs.size(); ++l) {
    const reference::Limb& limb = creature.limbs[l];
    auto& leg = table.legs.emplace_back();
    glm::dvec3 joint = limb.root;
    for (size_t i = 0; i <= limb.bones.size(); ++i) {
      leg.push_back({joint, table.bones.size()});
      const size_t bone = std::min(i, limb.bones.size() - 1);
      table.bones.push_back({static_cast<int>(l), static_cast<int>(bone)});
      joint += limb.reach * limb.bones[bone].length * limb.bones[bone].direction();
    }
  }
  table.matrices.assign(table.bones.size(), reference::Affine(1));
  return table;
}

}  // namespace skitter::test
