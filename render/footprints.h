#pragma once

#include <vector>

#include "crowd/herd.h"
#include "gpu/kernel.h"
#include "render/setting.h"

namespace skitter::render {

// Prints that feet leave where they stood (docs/stages/pictures.md, Footprints).
class Footprints {
 public:
  Footprints() = default;
  explicit Footprints(const Setting&);
  explicit operator bool() const { return bool(leave_); }

  // Whose feet leave prints: at first, and as herds have come or gone. Those that are there stay.
  void follow(const Setting&, const Crowd::Impl&);
  // Before a transferToCompute() and a transferToGraphics().
  void prepare(vk::CommandBuffer) const;
  // Leaves prints, `tick` ticks of `dt` seconds after the crowd began, and looks which are seen; before a
  // computeToGraphics().
  void record(vk::CommandBuffer, uint64_t tick, float dt);
  // After the ground.
  void draw(vk::CommandBuffer) const;

 private:
  struct Page {
    shared::FootprintConstants constants;
    gpu::Buffer steps;
    gpu::Bindings leave;
  };

  gpu::Kernel leave_, see_;
  gpu::GraphicsPipeline pipeline_;
  gpu::Buffer prints_, counts_, list_, corners_, indices_;
  gpu::Bindings seeing_, drawing_;
  std::vector<Page> pages_;
  shared::FootprintConstants now_{};  // of the last picture
};

}  // namespace skitter::render
