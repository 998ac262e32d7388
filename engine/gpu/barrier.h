#pragma once

#include "gpu/image.h"

// Every barrier of the engine, named by intent: what was done, then what comes. All are global memory
// barriers (they cost no more than buffer barriers on the devices we know, and none can be forgotten) or
// transitions of a whole image. A texel-buffer LOAD4 is a shader sampled read, a storage LOAD4 a storage
// read: both are covered.
namespace skitter::gpu {

// A stage's output becomes the next stage's input; also keeps a later writer from an earlier reader.
void computeToCompute(vk::CommandBuffer);
// As above, and counts written by compute become indirect arguments.
void computeToIndirectAndCompute(vk::CommandBuffer);
// Poses, visible lists and indirect draws become what the picture is drawn from.
void computeToGraphics(vk::CommandBuffer);
// The picture has been read from records that compute writes next (write after read).
void graphicsToCompute(vk::CommandBuffer);

// Compute between the caller's own work of any kind that the device's queue does, before and after it.
void anyToCompute(const Context&, vk::CommandBuffer);
void computeToAny(const Context&, vk::CommandBuffer);

void computeToTransfer(vk::CommandBuffer);
void transferToCompute(vk::CommandBuffer);
void transferToGraphics(vk::CommandBuffer);
// One copy or fill after another on the same memory.
void transferToTransfer(vk::CommandBuffer);
// A counter that compute wrote is cleared by a fill, and compute goes on: both sides of the fill in one frame
// are computeToTransfer, fill, transferToCompute.

// Results that the host reads from a HostBuffer once the submission is complete.
void transferToHost(vk::CommandBuffer);
void computeToHost(vk::CommandBuffer);

// Whatever came before, whatever comes after: for set-up and tools, never in the frame loop.
void allToAll(vk::CommandBuffer);

// What an image is being used for; each has one layout.
enum class ImageState {
  discard,           // as a source only: the contents are of no interest; waits for all earlier uses
  transferSrc,       // copied from
  transferDst,       // copied to
  sampled,           // read by compute or graphics shaders
  sampledByCompute,  // the same, on a queue that only computes
  colour,            // colour attachment (and target of a resolve)
  depth,             // depth attachment
  present,           // handed to the window system
};
vk::ImageLayout layoutOf(ImageState);
// One of both, by the device's queue.
inline ImageState sampledOn(const Context& context) {
  return context.draws() ? ImageState::sampled : ImageState::sampledByCompute;
}

void transition(vk::CommandBuffer, vk::Image, vk::ImageAspectFlags, ImageState from, ImageState to);
inline void transition(vk::CommandBuffer cmd, const Image& image, ImageState from, ImageState to) {
  transition(cmd, image.handle(), image.aspect(), from, to);
}

}  // namespace skitter::gpu
