#pragma once

#include "render/composition.h"
#include "render/setting.h"

namespace skitter::render {

// Samples of patch corner x and z, samples a cell, and the distance at which its range ends
// (shaders/render/terrain.vert).
using Patch = glm::vec4;

// The patches that cover all ground in sight, finer towards the eye, nearest first. Beyond its edge the
// terrain goes on as its mirror image (Heightfield::seenAt).
std::vector<Patch> choosePatches(const Composition&, const Heightfield&, float lowest, float highest);

// The ground, drawn from the very height image that the crowd walks on.
class Terrain {
 public:
  Terrain(const Setting&);

  float lowest() const { return lowest_; }
  float highest() const { return highest_; }

  // Outside rendering, before a transferToGraphics().
  void prepare(vk::CommandBuffer, const Composition&);
  void draw(vk::CommandBuffer) const;

 private:
  const Heightfield& field_;
  float lowest_ = 0, highest_ = 0;
  gpu::GraphicsPipeline pipeline_;
  gpu::Bindings bindings_;
  gpu::Buffer indices_, patches_;
  uint32_t indexCount_ = 0, patchCount_ = 0;
};

}  // namespace skitter::render
