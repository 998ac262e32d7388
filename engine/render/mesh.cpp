#include "render/mesh.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <tuple>

#include "crowd/radius.h"
#include "gpu/transfer.h"
#include "render/ribbons.h"

namespace skitter::render {
namespace {

// Share of the triangles at each level. Triangle setup is what drawing costs on software devices.
constexpr std::array<float, shared::CAMERA_LODS> kShare{1.0f, 0.35f, 0.12f, 0.05f};
constexpr float kLargestError = 0.05f;    // of the mesh's extent
constexpr float kLeastHalfWidth = 1e-6f;  // metres, so that a point has two sides
// That the radius of a bone has, at most, where the bone is a ribbon; of an agent as near as the level
// allows.
constexpr float kRibbonPixels = 2;

// A skin, and where each entry of its palette starts: vertices are stored relative to it.
struct Skin {
  const std::vector<SkinVertex>& vertices;
  const std::vector<uint32_t>& indices;
  std::vector<glm::vec3> starts;
  const Rig* rig = nullptr;  // where legs are known
};

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
  std::vector<uint32_t> remap;  // of the skin's vertices; those of no triangle lead nowhere
};
Welded weld(const std::vector<SkinVertex>& vertices, const std::vector<uint32_t>& indices) {
  std::vector<glm::vec3> positions;
  for (const SkinVertex& vertex : vertices) positions.push_back(vertex.position);
  Welded welded{{}, std::vector<uint32_t>(positions.size())};
  const size_t count = meshopt_generateVertexRemap(welded.remap.data(), indices.data(), indices.size(),
                                                   positions.data(), positions.size(), sizeof(glm::vec3));
  welded.vertices.resize(count);
  std::vector<float> shared(count, 0.0f);
  for (size_t i = 0; i < welded.remap.size(); ++i) {
    const uint32_t place = welded.remap[i];
    if (place >= count) continue;
    SkinVertex& vertex = welded.vertices[place];
    const float before = shared[place]++;
    if (before == 0) {
      vertex = vertices[i];
    } else {
      vertex.normal += vertices[i].normal;
      vertex.colour = (vertex.colour * before + vertices[i].colour) / (before + 1);
    }
  }
  for (SkinVertex& vertex : welded.vertices) vertex.normal /= std::max(glm::length(vertex.normal), 1e-6f);
  return welded;
}

// Simplifies triangles of the skin.
std::vector<uint32_t> simplified(const Welded& welded, std::vector<uint32_t> triangles, float share) {
  if (triangles.empty()) return {};
  for (uint32_t& index : triangles) index = welded.remap[index];
  const size_t wanted = size_t(float(triangles.size() / 3) * share) * 3;
  std::vector<uint32_t> indices(triangles.size());
  indices.resize(meshopt_simplify(indices.data(), triangles.data(), triangles.size(),
                                  &welded.vertices[0].position.x, welded.vertices.size(), sizeof(SkinVertex),
                                  wanted, kLargestError, 0, nullptr));
  return indices;
}

// As a device fetches them best, without vertices of no triangle.
Surface optimised(const std::vector<SkinVertex>& vertices, std::vector<uint32_t> indices) {
  meshopt_optimizeVertexCache(indices.data(), indices.data(), indices.size(), vertices.size());
  Surface surface{std::vector<SkinVertex>(vertices.size()), std::move(indices)};
  surface.vertices.resize(meshopt_optimizeVertexFetch(surface.vertices.data(), surface.indices.data(),
                                                      surface.indices.size(), vertices.data(),
                                                      vertices.size(), sizeof(SkinVertex)));
  return surface;
}

void append(MeshData& data, MeshLod& lod, const Skin& skin, const Surface& surface) {
  lod = {.firstIndex = uint32_t(data.indices.size()),
         .indexCount = uint32_t(surface.indices.size()),
         .firstVertex = int32_t(data.vertices.size())};
  for (const SkinVertex& vertex : surface.vertices)
    data.vertices.push_back(meshVertex(skin, vertex, data.influences));
  data.indices.insert(data.indices.end(), surface.indices.begin(), surface.indices.end());
}

// A quad, whose corners the vertex shader moves apart.
void append(MeshData& data, MeshLod& lod, const Ribbon& ribbon) {
  const auto first = uint32_t(data.vertices.size()) - uint32_t(lod.firstVertex);
  // Counter-clockwise, as seen from the eye that they are spread for.
  for (const auto& [end, out, side] :
       {std::tuple(ribbon.from, -1, 1), {ribbon.from, -1, -1}, {ribbon.to, 1, 1}, {ribbon.to, 1, -1}}) {
    MeshVertex vertex{};
    vertex.bones[0] = ribbon.bone;
    vertex.influences[0] = glm::vec4(end.along * ribbon.direction, 1);
    vertex.normal = float(out) * ribbon.direction;
    vertex.colour = end.colour;
    vertex.halfWidth = float(side) * std::max(end.radius, kLeastHalfWidth);
    data.vertices.push_back(vertex);
  }
  for (const uint32_t corner : {0u, 1u, 2u, 0u, 2u, 3u}) data.indices.push_back(first + corner);
  lod.indexCount += 6;
}

void appendLods(MeshData& data, const Skin& skin) {
  if (skin.indices.empty()) return;
  append(data, data.lods[0], skin, optimised(skin.vertices, skin.indices));
  const Welded welded = weld(skin.vertices, skin.indices);
  for (size_t i = 1; i < data.lods.size(); ++i) {
    const float radius = kRibbonPixels * data.radius / kLodPixels[i - 1];
    const Ribbons thin = skin.rig ? ribbonsOf(*skin.rig, radius) : Ribbons{{}, skin.indices};
    append(data, data.lods[i], skin, optimised(welded.vertices, simplified(welded, thin.others, kShare[i])));
    for (const Ribbon& ribbon : thin.ribbons) append(data, data.lods[i], ribbon);
  }
}

}  // namespace

std::vector<Surface> surfacesOf(const std::vector<SkinVertex>& vertices,
                                const std::vector<uint32_t>& indices) {
  std::vector<Surface> surfaces;
  if (indices.empty()) return surfaces;
  surfaces.push_back(optimised(vertices, indices));
  const Welded welded = weld(vertices, indices);
  for (size_t i = 1; i < kShare.size(); ++i)
    surfaces.push_back(optimised(welded.vertices, simplified(welded, indices, kShare[i])));
  return surfaces;
}

MeshData makeMesh(const Rig& rig) {
  MeshData data;
  data.radius = crowd::radiusOf(rig);
  appendLods(data, {rig.vertices, rig.indices, rig.restStarts(), &rig});
  return data;
}

MeshData makeMesh(const ClipSet& set) {
  MeshData data;
  data.radius = crowd::radiusOf(set);
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
