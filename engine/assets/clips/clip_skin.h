#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "assets/rigs/placement.h"
#include "assets/rigs/rig_source.h"
#include "skitter/clip.h"

namespace skitter {

// What a clip moves: the palette of a ClipSet as baking needs it (docs/clip.md, Skin).
struct ClipSkin {
  struct Entry {
    int node = 0;
    glm::dmat4 nodeFromBound{1};  // C P^-1: from where the vertices of the set lie
    bool hasBox = false;
    glm::dvec3 least{0}, most{0};  // of what the entry moves

    void hold(const glm::dvec3& point);
  };

  glm::dmat4 creatureFromModel{1};
  std::vector<Entry> entries;       // as ClipSet::joints
  std::vector<int> nodes;           // those of the entries and all above them, parents first
  std::vector<bool> inLeg;          // of each node of the document: a joint of a leg, or below one
  std::vector<double> weightBelow;  // of each node of the document: the skin's weight on it and below, 0 to 1
};

// Fills all of `set` but its clips. Throws Error(input) that begins with the source's name.
ClipSkin bindSkin(const RigSource& source, const Placement& placement, ClipSet& set);

}  // namespace skitter
