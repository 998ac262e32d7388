#pragma once

#include <vulkan/vulkan.h>

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "skitter/crowd.h"
#include "skitter/device.h"
#include "skitter/export.h"
#include "skitter/host_space.h"

namespace skitter {

enum class TransformFormat {
  matrix,      // 12 floats: the rows of a 3x4 matrix, the translation in the fourth column
  quaternion,  // 8 floats: rotation x, y, z, w; translation x, y, z; scale, 1 but in a herd of several sizes
};
constexpr uint32_t bytesOf(TransformFormat format) { return format == TransformFormat::matrix ? 48 : 32; }

// Where transforms are written: a range of a buffer of the caller's, with usage STORAGE_BUFFER. Transforms
// follow each other agent by agent and, of palettes, entry by entry.
struct TransformRange {
  VkBuffer buffer = VK_NULL_HANDLE;  // none: these transforms are not written
  VkDeviceSize offset = 0;           // bytes, a multiple of 16
  VkDeviceSize bytes = 0;            // that may be written; what is over stays as it is
  TransformFormat format = TransformFormat::matrix;
  // Bytes from one transform to the next, a multiple of 16; 0: no gap. What lies between is not written, so
  // that a transform can be part of a larger record of the caller's.
  VkDeviceSize stride = 0;
  // An array for each vec4 of the transforms, one after the other: the first vec4 of all transforms, then the
  // second of all, and so on. With `stride` 0.
  bool planar = false;
};

// The transforms that one frame of the caller's reads.
struct PaletteTarget {
  // A transform per agent: from the model space of the mesh at rest, with its origin on the ground below the
  // body, to the host's space. In a herd of several sizes it scales the mesh to the agent's size.
  TransformRange instances = {};
  // entries() transforms per agent, for the bones that SkinMesh::vertices name.
  TransformRange palettes = {};
};

struct PaletteOptions {
  HostSpace space;
  // Palettes lead from the mesh at rest to its model space, so that the agent's instance transform comes
  // after them, as most engines have it. Else they lead to the host's space at once, and scale as instance
  // transforms do.
  bool relative = false;
};

// Writes a herd's transforms into the caller's buffers, on the device, after a tick. A vertex of the herd's
// mesh (skitter/skin_mesh.h) is then at
//   sum of weight[i] * palette[bone[i]] * vertex, of the agent, relative to the origin
// with the instance's transform before it where PaletteOptions::relative is set. An agent that is not there
// has transforms of zeros, so that it vanishes.
//
// Used by one thread at a time. The crowd outlives it; so do the buffers.
class SKITTER_API Palettes {
 public:
  // A target for each frame that may be in flight. Throws Error(input) for a herd that is not there, a unit
  // that cannot be, a range that is too small or not aligned, palettes of a crowd without poses
  // (CrowdOptions::pose), and quaternions for palettes of controllers whose matrices stretch (clip, planted);
  // Error(device) where a range is more than one binding of the device reaches.
  Palettes(Device& device, const Crowd& crowd, uint32_t herd, const std::vector<PaletteTarget>& targets,
           const PaletteOptions& options = {});
  ~Palettes();
  Palettes(Palettes&&) noexcept;
  Palettes& operator=(Palettes&&) noexcept;

  // How much room a target needs.
  static uint32_t agentsOf(const Crowd& crowd, uint32_t herd);
  static uint32_t entriesOf(const Crowd& crowd, uint32_t herd);  // of an agent's palette

  // Records the writes of one target, after Crowd::record() in the same or an earlier submission, outside a
  // render pass. It begins with a barrier that waits for vertex, fragment, compute and transfer work recorded
  // before it, and ends with one that makes the transforms visible to such work recorded after it. `origin`
  // is the point of the world, in metres, that the host's space has its own origin in. Throws Error(input)
  // where the herd was removed or there is no such target; then nothing is recorded.
  void record(VkCommandBuffer commandBuffer, const glm::dvec3& origin = glm::dvec3(0),
              uint32_t target = 0) const;

 private:
  struct SKITTER_LOCAL Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace skitter
