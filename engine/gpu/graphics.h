#pragma once

#include "gpu/barrier.h"
#include "gpu/bindings.h"
#include "gpu/kernel.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace skitter::gpu {

struct VertexAttribute {
  uint32_t location;
  vk::Format format;
  uint32_t offset;
};

// One vertex buffer, numbered by its place in GraphicsInfo::streams.
struct VertexStream {
  uint32_t stride;
  vk::VertexInputRate rate;
  std::vector<VertexAttribute> attributes;
};

enum class DepthUse {
  reversed,    // nearer is greater, tested and written
  background,  // drawn where nothing nearer than infinity has been, not written
  none,        // drawn over whatever is there
  shadow,      // nearer is less, tested and written, with a slope-scaled bias
};

struct GraphicsInfo {
  std::string name;
  ShaderCode vertex;
  std::optional<ShaderCode> fragment;  // none: depth alone
  std::vector<BindingDecl> bindings;
  uint32_t pushBytes = 0;
  std::vector<VertexStream> streams = {};
  vk::Format colour = vk::Format::eUndefined;
  vk::Format depth = vk::Format::eUndefined;
  vk::SampleCountFlagBits samples = vk::SampleCountFlagBits::e1;
  DepthUse depthUse = DepthUse::reversed;
  vk::CullModeFlags cull = vk::CullModeFlagBits::eBack;  // front faces are counter-clockwise
  bool blended = false;                                  // over what is there, by alpha
  std::vector<SpecConstant> constants = {};
};

// A pipeline for triangle lists in dynamic rendering, with its layouts.
class GraphicsPipeline {
 public:
  GraphicsPipeline() = default;
  GraphicsPipeline(const Context&, const GraphicsInfo&);

  const std::string& name() const { return layout().name(); }
  const BindingLayout& layout() const { return made_->layout; }
  Bindings bind(const Context& context, std::span<const Binding> list) const {
    return {context, layout(), list};
  }
  explicit operator bool() const { return !!made_; }

  // `push` is exactly pushBytes long. What follows is plain vkCmdBind*Buffer and vkCmdDraw*.
  void use(vk::CommandBuffer, const Bindings&, std::span<const std::byte> push) const;

 private:
  std::shared_ptr<const Pipeline> made_;
};

struct RenderTargets {
  const Image* colour = nullptr;   // cleared to black unless drawnOver or covered; in state colour
  const Image* resolve = nullptr;  // where multisampled colour ends; in state colour
  const Image* depth = nullptr;    // in state depth
  float depthClear = 0;
  bool keepDepth = false;
  bool drawnOver = false;  // colour and depth are kept, not cleared
  bool covered = false;    // every pixel of colour is drawn, so that it need not be cleared
};

// Dynamic rendering from construction to destruction. `yUp` makes clip y point up in the picture, as the
// winding of GraphicsInfo assumes.
class Rendering {
 public:
  Rendering(vk::CommandBuffer, const RenderTargets&, bool yUp);
  ~Rendering();
  Rendering(const Rendering&) = delete;
  Rendering& operator=(const Rendering&) = delete;

  // Draws into a part of the targets from now on.
  void confine(vk::Rect2D) const;

 private:
  vk::CommandBuffer cmd_;
  bool yUp_;
};

struct SamplerInfo {
  std::string name;
  vk::Filter filter = vk::Filter::eLinear;
  std::optional<vk::CompareOp> compare = {};
  std::optional<vk::Filter> minFilter = {};  // where texels are smaller than pixels; else `filter`
  vk::SamplerAddressMode wrapU = vk::SamplerAddressMode::eClampToEdge,
                         wrapV = vk::SamplerAddressMode::eClampToEdge;
  vk::SamplerMipmapMode mips = vk::SamplerMipmapMode::eNearest;
  float maxLevel = 0;  // 0: one level
};
vk::raii::Sampler makeSampler(const Context&, const SamplerInfo&);

// The picture has been drawn from memory that a copy, fill or update overwrites next (write after read).
void graphicsToTransfer(vk::CommandBuffer);

}  // namespace skitter::gpu
