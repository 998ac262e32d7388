#pragma once

#include <array>
#include <vector>

#include "render/composition.h"
#include "render/setting.h"

namespace skitter::render {

// Samples of patch corner x and z, samples a cell, and the distance at which its range ends
// (shaders/render/terrain.vert).
using Patch = glm::vec4;

constexpr int kReliefBlock = shared::PATCH_CELLS;  // cells along a block of Relief::slopes

// How the ground's triangles differ from it. A mesh of level n has a vertex every 2^n samples.
struct Relief {
  float lowest = 0, highest = 0;  // metres, as are the others
  float twist = 0;  // root mean square over cells: of the sum of two opposite corners less the others'
  std::vector<float> deviations;  // of the meshes of level 1, 2, ...: root mean square
  // The steepest slope that is shaded (gradientAt) in each block of kReliefBlock x kReliefBlock cells, row by
  // row, and of all.
  std::vector<float> slopes;
  uint32_t blocksAcross = 0;
  float steepest = 0;

  float deviationOf(int level) const;
};
// Of ground as it is now: later edits of a few places change it little.
Relief reliefOf(const Heightfield&);

// The patches that cover all ground in sight, finer towards the eye, nearest first. Beyond its edge the
// terrain goes on as its mirror image (Heightfield::seenAt).
std::vector<Patch> choosePatches(const Composition&, const Heightfield&, const Relief&);

// What a patch needs of the ground's shader.
struct GroundForm {
  int detail = kFullDetail;  // CONSTANT_DETAIL: what of its detail may be seen
  bool shaded = true;        // shadows may fall on it
  bool dense = false;        // CONSTANT_DENSE: its vertices tell enough of what varies slowly
  static constexpr int kFullDetail = 2;
  int index() const { return 4 * (kFullDetail - detail) + (shaded ? 0 : 2) + (dense ? 0 : 1); }
};
constexpr int kGroundForms = 4 * (GroundForm::kFullDetail + 1);
// `field` is the ground that `relief` was made of, as it is now. `casts`: whether anything casts shadows.
GroundForm formOf(const Composition&, const Heightfield& field, const Relief& relief, const Patch&,
                  bool casts);

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
