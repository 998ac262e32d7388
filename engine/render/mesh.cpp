#include "render/mesh.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "gpu/transfer.h"

namespace skitter::render {
namespace {

// Share of the triangles at each level. Triangle setup is what drawing costs on software devices.
constexpr std::array<float, shared::CAMERA_LODS> kShare{1.0f, 0.35f, 0.12f, 0.05f};
constexpr float kLargestError = 0.05f;  // of the mesh's extent

// A skin, and where each entry of its palette starts: vertices are stored relative to it.
struct Skin {
  const std::vector<SkinVertex>& vertices;
  const std::vector<uint32_t>& indices;
  std::vector<glm::vec3> starts;
};

std::vector<glm::vec3> restStarts(const Rig& rig) {
  std::vector<glm::vec3> starts = {glm::vec3(0)};
  for (const Leg& leg : rig.legs)
    for (int i = 0; i < rig.maxBones(); ++i)
      starts.push_back(leg.bones[std::min(size_t(i), leg.bones.size() - 1)].start);
  return starts;
}

MeshVertex meshVertex(const Skin& from, const SkinVertex& skin, int& influences) {
  // Heaviest first, so that a rig whose vertices hang on few bones needs few loads.
  std::array<int, 4> order{0, 1, 2, 3};
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return skin.weights[a] > skin.weights[b]; });
  MeshVertex vertex{};
  for (size_t i = 0; i < 4; ++i) {
    const float weight = skin.weights[order[i]];
    if (weight <= 0) continue;
    influences = std::max(influences, int(i) + 1);
    vertex.bones[i] = skin.bones[order[i]];
    vertex.influences[i] = glm::vec4(skin.position - from.starts.at(vertex.bones[i]), weight);
  }
  vertex.normal = skin.normal;
  vertex.colour = skin.colour;
  return vertex;
}

// Vertices that share a position are one, with the mean of their normals and colours: seams would keep the
// simplifier from collapsing edges along them.
struct Welded {
  std::vector<SkinVertex> vertices;
  std::vector<uint32_t> indices;
};
Welded weld(const Skin& skin) {
  std::vector<glm::vec3> positions;
  for (const SkinVertex& vertex : skin.vertices) positions.push_back(vertex.position);
  std::vector<uint32_t> remap(positions.size());
  const size_t count = meshopt_generateVertexRemap(remap.data(), skin.indices.data(), skin.indices.size(),
                                                   positions.data(), positions.size(), sizeof(glm::vec3));
  Welded welded;
  welded.vertices.resize(count);
  std::vector<float> shared(count, 0.0f);
  for (size_t i = 0; i < remap.size(); ++i) {
    if (remap[i] >= count) continue;  // a vertex of no triangle
    SkinVertex& vertex = welded.vertices[remap[i]];
    const float before = shared[remap[i]]++;
    if (before == 0) {
      vertex = skin.vertices[i];
    } else {
      vertex.normal += skin.vertices[i].normal;
      vertex.colour = (vertex.colour * before + skin.vertices[i].colour) / (before + 1);
    }
  }
  for (SkinVertex& vertex : welded.vertices) vertex.normal /= std::max(glm::length(vertex.normal), 1e-6f);
  for (const uint32_t index : skin.indices) welded.indices.push_back(remap[index]);
  return welded;
}

std::vector<uint32_t> simplified(const Welded& mesh, float share) {
  const size_t wanted = size_t(float(mesh.indices.size() / 3) * share) * 3;
  std::vector<uint32_t> indices(mesh.indices.size());
  indices.resize(meshopt_simplify(indices.data(), mesh.indices.data(), mesh.indices.size(),
                                  &mesh.vertices[0].position.x, mesh.vertices.size(), sizeof(SkinVertex),
                                  wanted, kLargestError, 0, nullptr));
  return indices;
}

void append(MeshData& data, MeshLod& lod, const Skin& skin, std::vector<SkinVertex> vertices,
            std::vector<uint32_t> indices) {
  meshopt_optimizeVertexCache(indices.data(), indices.data(), indices.size(), vertices.size());
  std::vector<SkinVertex> used(vertices.size());
  used.resize(meshopt_optimizeVertexFetch(used.data(), indices.data(), indices.size(), vertices.data(),
                                          vertices.size(), sizeof(SkinVertex)));
  lod = {.firstIndex = uint32_t(data.indices.size()),
         .indexCount = uint32_t(indices.size()),
         .firstVertex = int32_t(data.vertices.size())};
  for (const SkinVertex& vertex : used) data.vertices.push_back(meshVertex(skin, vertex, data.influences));
  data.indices.insert(data.indices.end(), indices.begin(), indices.end());
}

void appendLods(MeshData& data, const Skin& skin) {
  if (skin.indices.empty()) return;
  append(data, data.lods[0], skin, skin.vertices, skin.indices);
  const Welded welded = weld(skin);
  for (size_t i = 1; i < data.lods.size(); ++i)
    append(data, data.lods[i], skin, welded.vertices, simplified(welded, kShare[i]));
}

}  // namespace

MeshData makeMesh(const Rig& rig) {
  MeshData data;
  for (const SkinVertex& vertex : rig.vertices)
    data.radius = std::max(data.radius, glm::length(vertex.position));
  for (const Leg& leg : rig.legs) data.radius = std::max(data.radius, glm::length(leg.root()) + leg.reach);
  appendLods(data, {rig.vertices, rig.indices, restStarts(rig)});
  return data;
}

MeshData makeMesh(const ClipSet& set) {
  MeshData data;
  for (const Clip& clip : set.clips)
    data.radius = std::max(data.radius, glm::length(glm::max(glm::abs(clip.least), glm::abs(clip.most))));
  appendLods(data, {set.vertices, set.indices, std::vector<glm::vec3>(set.joints.size())});
  return data;
}

Mesh uploadMesh(const gpu::Context& context, const MeshData& data, const std::string& name) {
  Mesh mesh;
  mesh.vertices = gpu::Buffer(context, data.vertices.size() * sizeof(MeshVertex), name + " vertices",
                              gpu::BufferUse::vertex);
  mesh.indices =
      gpu::Buffer(context, data.indices.size() * sizeof(uint32_t), name + " indices", gpu::BufferUse::index);
  gpu::upload(context, mesh.vertices, data.vertices);
  gpu::upload(context, mesh.indices, data.indices);
  mesh.lods = data.lods;
  mesh.influences = data.influences;
  mesh.radius = data.radius;
  return mesh;
}

}  // namespace skitter::render
