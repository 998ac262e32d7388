#pragma once

#include <array>

#include "gpu/buffer.h"
#include "gpu/graphics.h"
#include "render/limbs.h"
#include "render/picture.h"
#include "skitter/clip.h"
#include "skitter/rig.h"

namespace skitter::render {

struct MeshVertex {
  uint16_t bones[4];
  // The vertex relative to the bone's rest start, and a weight. A ribbon's first one is of this end, and its
  // second one, without weight, of the other end.
  glm::vec4 influences[4];
  glm::vec3 normal;  // ribbons have none
  glm::vec3 colour;
  float halfWidth;  // of a ribbon, metres, below 0 on one side and above on the other; 0 on surfaces
};

// Pixels that an agent's radius covers, down to which each level of detail but the last serves.
inline constexpr std::array<float, shared::CAMERA_LODS - 1> kLodPixels{150, 75, 25, 10};
// The same of agents that are drawn as triangles, where there are splats for those that are smaller.
inline constexpr float kSplatPixels = 25;
// The same of agents whose shadow is triangles.
inline constexpr float kShadePixels = 12;
// The same for contacts.
inline constexpr float kContactPixels = 40;
// The same for surfaces without ribbons (surfacesOf).
inline constexpr std::array<float, 3> kSurfacePixels{75, 40, 14};

// Indices of one level of detail; its vertices are a range of their own.
struct MeshLod {
  uint32_t firstIndex = 0, indexCount = 0;
  int32_t firstVertex = 0;
};

// The triangles of each level that are drawn alike; runs of the levels' own.
struct MeshPart {
  int material = -1;  // into the look's materials; -1: ribbons, which have colours alone
  std::array<MeshLod, shared::CAMERA_LODS> lods;
};

// A rig's skin at its levels of detail, on the host.
struct MeshData {
  std::vector<MeshVertex> vertices;
  std::vector<uint32_t> indices;
  std::array<MeshLod, shared::CAMERA_LODS> lods;
  std::vector<MaterialVertex> worn;  // of each vertex; empty without materials, as are
  std::vector<MeshPart> parts;       // whose runs make up each level
  int influences = 1;                // most bones that carry one vertex, 1 to 4
  float radius = 0;                  // of a sphere about the body's position that holds every pose, metres
};
// Triangles of a skin.
struct Surface {
  std::vector<SkinVertex> vertices;
  std::vector<uint32_t> indices;
  std::vector<MaterialVertex> worn = {};  // of each vertex; empty without materials
};
// A skin at its levels of detail as surfaces alone, finest first; none of a skin without triangles.
std::vector<Surface> surfacesOf(const std::vector<SkinVertex>& vertices,
                                const std::vector<uint32_t>& indices);

// The limbs are the model's.
MeshData makeMesh(const Rig&, const Limbs&);
MeshData makeMesh(const ClipSet&, const Limbs&);  // its palette holds matrices

struct Mesh {
  gpu::Buffer vertices, indices;
  gpu::Buffer worn;  // none without materials
  std::array<MeshLod, shared::CAMERA_LODS> lods;
  std::vector<MeshPart> parts;
  int influences = 1;
  float radius = 0;
};
Mesh uploadMesh(const gpu::Context&, const MeshData&, const std::string& name);

}  // namespace skitter::render
