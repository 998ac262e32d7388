#include "gpu/barrier.h"

#include <cassert>

namespace skitter::gpu {
namespace {

using Access = vk::AccessFlagBits2;
using Stage = vk::PipelineStageFlagBits2;

struct Scope {
  vk::PipelineStageFlags2 stages;
  vk::AccessFlags2 access;
};

constexpr vk::AccessFlags2 kShaderRead =
    Access::eShaderSampledRead | Access::eShaderStorageRead | Access::eUniformRead;

// As a source only writes need naming: what was read is kept by the order of execution alone.
constexpr Scope kComputeDone{Stage::eComputeShader, Access::eShaderStorageWrite};
constexpr Scope kCompute{Stage::eComputeShader, kShaderRead | Access::eShaderStorageWrite};
constexpr Scope kIndirect{Stage::eDrawIndirect, Access::eIndirectCommandRead};
constexpr Scope kGraphics{
    Stage::eDrawIndirect | Stage::eVertexInput | Stage::eVertexShader | Stage::eFragmentShader,
    kShaderRead | Access::eIndirectCommandRead | Access::eIndexRead | Access::eVertexAttributeRead};
constexpr Scope kGraphicsDone{kGraphics.stages, {}};
constexpr Scope kTransferDone{Stage::eAllTransfer, Access::eTransferWrite};
constexpr Scope kTransfer{Stage::eAllTransfer, Access::eTransferRead | Access::eTransferWrite};
constexpr Scope kHost{Stage::eHost, Access::eHostRead};
constexpr Scope kAllDone{Stage::eAllCommands, Access::eMemoryWrite};
constexpr Scope kAll{Stage::eAllCommands, Access::eMemoryRead | Access::eMemoryWrite};

void barrier(vk::CommandBuffer cmd, const Scope& from, const Scope& to) {
  const vk::MemoryBarrier2 memory{.srcStageMask = from.stages,
                                  .srcAccessMask = from.access,
                                  .dstStageMask = to.stages,
                                  .dstAccessMask = to.access};
  cmd.pipelineBarrier2({.memoryBarrierCount = 1, .pMemoryBarriers = &memory});
}

Scope scopeOf(ImageState state) {
  switch (state) {
    case ImageState::discard:
      return kAllDone;
    case ImageState::transferSrc:
      return {Stage::eAllTransfer, Access::eTransferRead};
    case ImageState::transferDst:
      return {Stage::eAllTransfer, Access::eTransferWrite};
    case ImageState::sampled:
      return {Stage::eComputeShader | Stage::eVertexShader | Stage::eFragmentShader,
              Access::eShaderSampledRead};
    case ImageState::sampledByCompute:
      return {Stage::eComputeShader, Access::eShaderSampledRead};
    case ImageState::colour:
      return {Stage::eColorAttachmentOutput, Access::eColorAttachmentRead | Access::eColorAttachmentWrite};
    case ImageState::depth:
      return {Stage::eEarlyFragmentTests | Stage::eLateFragmentTests,
              Access::eDepthStencilAttachmentRead | Access::eDepthStencilAttachmentWrite};
    case ImageState::present:
      break;  // the present waits for a semaphore
  }
  return {};
}

}  // namespace

void computeToCompute(vk::CommandBuffer cmd) { barrier(cmd, kComputeDone, kCompute); }

void computeToIndirectAndCompute(vk::CommandBuffer cmd) {
  barrier(cmd, kComputeDone, {kCompute.stages | kIndirect.stages, kCompute.access | kIndirect.access});
}

void computeToGraphics(vk::CommandBuffer cmd) { barrier(cmd, kComputeDone, kGraphics); }
void graphicsToCompute(vk::CommandBuffer cmd) { barrier(cmd, kGraphicsDone, kCompute); }

void anyToCompute(const Context& context, vk::CommandBuffer cmd) {
  Scope before{kComputeDone.stages | kTransferDone.stages, kComputeDone.access | kTransferDone.access};
  if (context.draws()) before.stages |= kGraphicsDone.stages;
  barrier(cmd, before, kCompute);
}

void computeToAny(const Context& context, vk::CommandBuffer cmd) {
  Scope after{kCompute.stages | kTransfer.stages, kCompute.access | kTransfer.access};
  if (context.draws()) after.stages |= kGraphics.stages, after.access |= kGraphics.access;
  barrier(cmd, kComputeDone, after);
}

void computeToTransfer(vk::CommandBuffer cmd) { barrier(cmd, kComputeDone, kTransfer); }

// Fills set indirect arguments too.
void transferToCompute(vk::CommandBuffer cmd) {
  barrier(cmd, kTransferDone, {kCompute.stages | kIndirect.stages, kCompute.access | kIndirect.access});
}

void transferToGraphics(vk::CommandBuffer cmd) { barrier(cmd, kTransferDone, kGraphics); }
void transferToTransfer(vk::CommandBuffer cmd) { barrier(cmd, kTransferDone, kTransfer); }
void transferToHost(vk::CommandBuffer cmd) { barrier(cmd, kTransferDone, kHost); }
void computeToHost(vk::CommandBuffer cmd) { barrier(cmd, kComputeDone, kHost); }
void allToAll(vk::CommandBuffer cmd) { barrier(cmd, kAllDone, kAll); }

vk::ImageLayout layoutOf(ImageState state) {
  switch (state) {
    case ImageState::discard:
      return vk::ImageLayout::eUndefined;
    case ImageState::transferSrc:
      return vk::ImageLayout::eTransferSrcOptimal;
    case ImageState::transferDst:
      return vk::ImageLayout::eTransferDstOptimal;
    case ImageState::sampled:
    case ImageState::sampledByCompute:
      return vk::ImageLayout::eShaderReadOnlyOptimal;
    case ImageState::colour:
    case ImageState::depth:
      return vk::ImageLayout::eAttachmentOptimal;
    case ImageState::present:
      return vk::ImageLayout::ePresentSrcKHR;
  }
  return vk::ImageLayout::eUndefined;
}

void transition(vk::CommandBuffer cmd, vk::Image image, vk::ImageAspectFlags aspect, ImageState from,
                ImageState to) {
  assert(to != ImageState::discard);
  const Scope before = scopeOf(from);
  const Scope after = scopeOf(to);
  const vk::ImageMemoryBarrier2 one{
      .srcStageMask = before.stages,
      .srcAccessMask = before.access,
      .dstStageMask = after.stages,
      .dstAccessMask = after.access,
      .oldLayout = layoutOf(from),
      .newLayout = layoutOf(to),
      .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
      .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
      .image = image,
      .subresourceRange = {aspect, 0, VK_REMAINING_MIP_LEVELS, 0, VK_REMAINING_ARRAY_LAYERS}};
  cmd.pipelineBarrier2({.imageMemoryBarrierCount = 1, .pImageMemoryBarriers = &one});
}

}  // namespace skitter::gpu
