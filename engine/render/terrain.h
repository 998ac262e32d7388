#pragma once

#include <vector>

#include "render/composition.h"
#include "render/setting.h"

namespace skitter::render {

// Samples of patch corner x and z, samples a cell, and the distance at which its range ends
// (shaders/render/terrain.vert).
using Patch = glm::vec4;

// How the ground's triangles differ from it. A mesh of level n has a vertex every 2^n samples.
struct Relief {
  float lowest = 0, highest = 0;  // metres, as are the others
  float twist = 0;  // root mean square over cells: of the sum of two opposite corners less the others'
  std::vector<float> deviations;  // of the meshes of level 1, 2, ...: root mean square

  float deviationOf(int level) const;
};
// Of ground as it is now: later edits of a few places change it little.
Relief reliefOf(const Heightfield&);

// The patches that cover all ground in sight, finer towards the eye, nearest first. Beyond its edge the
// terrain goes on as its mirror image (Heightfield::seenAt).
std::vector<Patch> choosePatches(const Composition&, const Heightfield&, const Relief&);

// The ground, drawn from the very height image that the crowd walks on.
class Terrain {
 public:
  Terrain(const Setting&);

  float lowest() const { return relief_.lowest; }
  float highest() const { return relief_.highest; }

  // Outside rendering, before a transferToGraphics().
  void prepare(vk::CommandBuffer, const Composition&);
  void draw(vk::CommandBuffer) const;

 private:
  const Heightfield& field_;
  Relief relief_;
  gpu::GraphicsPipeline pipeline_;
  gpu::Bindings bindings_;
  gpu::Buffer indices_, patches_;
  uint32_t indexCount_ = 0, patchCount_ = 0;
};

}  // namespace skitter::render
