#pragma once

#include "gpu/graphics.h"

struct ImDrawData;
struct ImFontAtlas;

namespace skitter::app {

// Draws what Dear ImGui made. One frame at a time: the last one has been drawn when draw() is called again.
class GuiDrawing {
 public:
  GuiDrawing(const gpu::Context& context, ImFontAtlas& fonts, vk::Format colour);
  // Within dynamic rendering into one colour attachment.
  void draw(vk::CommandBuffer cmd, const ImDrawData& data);

 private:
  void upload(const ImDrawData& data);

  const gpu::Context& context_;
  gpu::Image font_;
  vk::raii::Sampler sampler_ = nullptr;
  gpu::GraphicsPipeline pipeline_;
  gpu::Bindings bindings_;
  gpu::HostBuffer vertices_, indices_;
};

}  // namespace skitter::app
