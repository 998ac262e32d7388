#pragma once

#include <array>
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

// What a patch needs of the ground's shader.
struct GroundForm {
  bool detailed = true;  // its finest detail may be seen
  bool shaded = true;    // shadows may fall on it
  int index() const { return (detailed ? 0 : 2) + (shaded ? 0 : 1); }
};
constexpr int kGroundForms = 4;
// `casts`: whether anything casts shadows.
GroundForm formOf(const Composition&, const Relief&, const Patch&, bool casts);

// The ground, drawn from the very height image that the crowd walks on.
class Terrain {
 public:
  Terrain(const Setting&);

  float lowest() const { return relief_.lowest; }
  float highest() const { return relief_.highest; }

  // Outside rendering, before a transferToGraphics(). `casts`: whether anything casts shadows.
  void prepare(vk::CommandBuffer, const Composition&, bool casts);
  void draw(vk::CommandBuffer) const;
  uint64_t triangles() const;  // of what prepare() chose

 private:
  const Heightfield& field_;
  Relief relief_;
  struct Form {
    gpu::GraphicsPipeline pipeline;
    gpu::Bindings bindings;
    uint32_t patches = 0;  // of this picture
  };
  std::array<Form, kGroundForms> forms_;  // by GroundForm::index; nearest ground first
  gpu::Buffer indices_, patches_;
  uint32_t indexCount_ = 0;
};

}  // namespace skitter::render
