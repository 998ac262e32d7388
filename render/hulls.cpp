#include "render/hulls.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace skitter::render {
namespace {

constexpr size_t kMostBoxes = 256;

using Bones = std::vector<uint16_t>;  // ascending

struct Box {
  glm::vec3 least{1e30f}, most{-1e30f};  // from where the bone starts at rest, metres
  float halfWidth = 0;                   // the largest of its ribbons
};

std::map<uint16_t, Box> boxesOf(const MeshData& mesh) {
  std::map<uint16_t, Box> boxes;
  for (const MeshVertex& vertex : mesh.vertices)
    for (size_t i = 0; i < 4; ++i) {
      if (vertex.influences[i].w == 0) continue;
      Box& box = boxes[vertex.bones[i]];
      box.least = glm::min(box.least, glm::vec3(vertex.influences[i]));
      box.most = glm::max(box.most, glm::vec3(vertex.influences[i]));
      box.halfWidth = std::max(box.halfWidth, std::abs(vertex.halfWidth));
    }
  return boxes;
}

// The bones that carry each triangle, without sets that others hold.
std::vector<Bones> bonesOfTriangles(const MeshData& mesh) {
  std::set<Bones> found;
  for (const MeshLod& lod : mesh.lods)
    for (uint32_t i = 0; i < lod.indexCount; i += 3) {
      std::set<uint16_t> bones;
      for (uint32_t corner = 0; corner < 3; ++corner) {
        const uint32_t index = mesh.indices[lod.firstIndex + i + corner];
        const MeshVertex& vertex = mesh.vertices[size_t(lod.firstVertex) + index];
        for (size_t k = 0; k < 4; ++k)
          if (vertex.influences[k].w != 0) bones.insert(vertex.bones[k]);
      }
      found.emplace(bones.begin(), bones.end());
    }
  std::vector<Bones> sets;
  for (const Bones& bones : found)
    if (std::ranges::none_of(
            found, [&](const Bones& other) { return other != bones && std::ranges::includes(other, bones); }))
      sets.push_back(bones);
  return sets;
}

}  // namespace

std::vector<shared::HullBox> hullsOf(const MeshData& mesh) {
  const std::map<uint16_t, Box> boxes = boxesOf(mesh);
  std::vector<Bones> hulls = bonesOfTriangles(mesh);
  size_t count = 0;
  for (const Bones& bones : hulls) count += bones.size();
  if (count > kMostBoxes) {
    hulls.assign(1, {});
    for (const auto& [bone, box] : boxes) hulls[0].push_back(bone);
  }
  std::vector<shared::HullBox> list;
  for (const Bones& bones : hulls)
    for (const uint16_t bone : bones) {
      const Box& box = boxes.at(bone);
      const float code = float(2 * bone + (bone == bones.back() ? 1 : 0));
      list.push_back({glm::vec4(0.5f * (box.least + box.most), code),
                      glm::vec4(0.5f * (box.most - box.least), box.halfWidth)});
    }
  return list;
}

}  // namespace skitter::render
