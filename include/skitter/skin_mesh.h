#pragma once

#include <cstdint>
#include <vector>

#include "skitter/crowd.h"
#include "skitter/export.h"
#include "skitter/host_space.h"
#include "skitter/rig.h"

namespace skitter {

// A herd's model for hosts that draw by themselves: the mesh at rest, in model space, at the first of
// the herd's sizes, which the transforms of skitter/palettes.h move and bring to each agent's size. `bones`
// of a vertex are entries of an agent's palette. Colours are the model's vertex colours times its materials'
// base colours; textures are left out.
struct SkinMesh {
  struct Level {
    uint32_t firstIndex = 0, indexCount = 0;
    // The level serves where the mesh's radius covers at least so many pixels; 0 of the last one.
    float pixels = 0;
  };

  std::vector<SkinVertex> vertices;  // of all levels
  std::vector<uint32_t> indices;     // into `vertices`: triangles, counter-clockwise as seen from outside
  std::vector<Level> levels;         // finest first; none of a model without triangles
  uint32_t entries = 0;              // of an agent's palette
  float radius = 0;  // of a sphere about an agent's position that holds every pose, at the largest size
};

// In the host's axes and unit, to go with palettes of the same HostSpace. Takes a while: levels are
// simplified here. Throws Error(input) for a herd that is not there, and for a unit
// that is not a finite length above 0.
SKITTER_API SkinMesh skinMeshOf(const Crowd& crowd, uint32_t herd, const HostSpace& space = {});

}  // namespace skitter
