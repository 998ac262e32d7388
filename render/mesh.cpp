#include "render/mesh.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <queue>
#include <tuple>

#include "crowd/radius.h"
#include "gpu/transfer.h"
#include "render/ribbons.h"

namespace skitter::render {
namespace {

// Share of the triangles that no ribbon replaces at each level after the finest. Triangle setup is what
// drawing costs on software devices.
constexpr std::array<float, shared::CAMERA_LODS - 1> kShare{0.35f, 0.12f, 0.04f, 0.015f};
// The same of surfaces without ribbons.
constexpr std::array<float, kSurfacePixels.size()> kSurfaceShare{0.35f, 0.12f, 0.05f};
constexpr float kLargestError = 0.05f;  // of the mesh's extent
constexpr float kLastError = 0.1f;      // the same at the last level
// At the first level after the finest the simplifier sees white surfaces so much further out than black ones,
// so that it keeps bands and spots as it does bumps; of the mesh's extent. Later levels have too few vertices
// for both colours and outline.
constexpr float kBump = 0.05f;
constexpr float kLeastHalfWidth = 1e-6f;  // metres, so that a point has two sides
// That the radius of a bone has, at most, where the bone is a ribbon; of an agent as near as the level
// allows.
constexpr float kRibbonPixels = 3.5f;
constexpr float kBendPixels = 1;  // that joints within a ribbon may be off it at rest, likewise

// The last level whose ribbons have waists.
constexpr size_t kLastWaists = 2;

// A skin, and where each entry of its palette starts: vertices are stored relative to it.
struct Skin {
  const std::vector<SkinVertex>& vertices;
  const std::vector<uint32_t>& indices;
  std::vector<glm::vec3> starts;
  const Look& look;
  const Limbs& limbs;
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
// simplifier from collapsing edges along them. Where textures are cut, seams stay, for each side has texture
// coordinates of its own; the simplifier then moves both sides alike. Their normals are one.
struct Welded {
  std::vector<SkinVertex> vertices;
  std::vector<uint32_t> remap;  // of the skin's vertices; those of no triangle lead nowhere
  std::vector<MaterialVertex> worn;
};

// The number of vertices that differ in position and in all that textures need.
size_t remapVertices(std::vector<uint32_t>& remap, const std::vector<uint32_t>& indices,
                     const std::vector<glm::vec3>& positions, const std::vector<MaterialVertex>& worn) {
  std::vector<meshopt_Stream> streams{{positions.data(), sizeof(glm::vec3), sizeof(glm::vec3)}};
  if (!worn.empty()) {
    const MaterialVertex& first = worn.front();
    streams.push_back({first.uv, sizeof first.uv, sizeof first});
    streams.push_back({&first.tangent.w, sizeof first.tangent.w, sizeof first});
    streams.push_back({&first.material, sizeof first.material, sizeof first});
  }
  return meshopt_generateVertexRemapMulti(remap.data(), indices.data(), indices.size(), positions.size(),
                                          streams.data(), streams.size());
}

// Gives vertices of one position the sum of their normals.
void joinNormals(std::vector<SkinVertex>& vertices) {
  std::map<std::array<float, 3>, glm::vec3> sums;
  const auto key = [](const SkinVertex& v) { return std::array{v.position.x, v.position.y, v.position.z}; };
  for (const SkinVertex& vertex : vertices)
    sums.try_emplace(key(vertex), 0.0f).first->second += vertex.normal;
  for (SkinVertex& vertex : vertices) vertex.normal = sums.at(key(vertex));
}

Welded weld(const std::vector<SkinVertex>& vertices, const std::vector<uint32_t>& indices,
            const std::vector<MaterialVertex>& worn) {
  std::vector<glm::vec3> positions;
  for (const SkinVertex& vertex : vertices) positions.push_back(vertex.position);
  Welded welded{{}, std::vector<uint32_t>(positions.size()), {}};
  const size_t count = remapVertices(welded.remap, indices, positions, worn);
  welded.vertices.resize(count);
  welded.worn.resize(worn.empty() ? 0 : count);
  std::vector<float> shared(count, 0.0f);
  for (size_t i = 0; i < welded.remap.size(); ++i) {
    const uint32_t place = welded.remap[i];
    if (place >= count) continue;
    SkinVertex& vertex = welded.vertices[place];
    const float before = shared[place]++;
    if (before == 0) {
      vertex = vertices[i];
      if (!worn.empty()) welded.worn[place] = worn[i];
      continue;
    }
    vertex.normal += vertices[i].normal;
    vertex.colour = (vertex.colour * before + vertices[i].colour) / (before + 1);
    if (worn.empty()) continue;
    MaterialVertex& to = welded.worn[place];
    to.tangent += glm::vec4(glm::vec3(worn[i].tangent), 0);
    to.opacity = (to.opacity * before + worn[i].opacity) / (before + 1);
  }
  if (!worn.empty()) joinNormals(welded.vertices);
  for (SkinVertex& vertex : welded.vertices) vertex.normal /= std::max(glm::length(vertex.normal), 1e-6f);
  for (MaterialVertex& vertex : welded.worn) {
    const glm::vec3 tangent(vertex.tangent);
    vertex.tangent = glm::vec4(tangent / std::max(glm::length(tangent), 1e-6f), vertex.tangent.w);
  }
  return welded;
}

// Triangles of one material come in a row.
void sortByMaterial(std::vector<uint32_t>& indices, const std::vector<MaterialVertex>& worn) {
  using Triangle = std::array<uint32_t, 3>;
  std::vector<Triangle> triangles;
  for (size_t i = 0; i < indices.size(); i += 3)
    triangles.push_back({indices[i], indices[i + 1], indices[i + 2]});
  std::stable_sort(triangles.begin(), triangles.end(), [&](const Triangle& a, const Triangle& b) {
    return worn[a[0]].material < worn[b[0]].material;
  });
  indices.clear();
  for (const Triangle& triangle : triangles) indices.insert(indices.end(), triangle.begin(), triangle.end());
}

// As a device fetches them best, without vertices of no triangle.
Surface optimised(const std::vector<SkinVertex>& vertices, const std::vector<MaterialVertex>& worn,
                  std::vector<uint32_t> indices) {
  meshopt_optimizeVertexCache(indices.data(), indices.data(), indices.size(), vertices.size());
  Surface surface{std::vector<SkinVertex>(vertices.size()), std::move(indices)};
  if (!worn.empty()) {
    sortByMaterial(surface.indices, worn);
    std::vector<uint32_t> remap(vertices.size());
    const size_t count = meshopt_optimizeVertexFetchRemap(remap.data(), surface.indices.data(),
                                                          surface.indices.size(), vertices.size());
    surface.worn.resize(count);
    for (size_t i = 0; i < remap.size(); ++i)
      if (remap[i] < count) surface.worn[remap[i]] = worn[i];
  }
  surface.vertices.resize(meshopt_optimizeVertexFetch(surface.vertices.data(), surface.indices.data(),
                                                      surface.indices.size(), vertices.data(),
                                                      vertices.size(), sizeof(SkinVertex)));
  return surface;
}

// The surface as the simplifier sees it: with bumps where it is light. Both sides of a seam must stay
// together, which may differ in colour.
std::vector<glm::vec3> seenAs(const Welded& welded, float bump) {
  const glm::vec3 luminance(0.2126f, 0.7152f, 0.0722f);
  const std::vector<SkinVertex>& vertices = welded.vertices;
  const float extent = meshopt_simplifyScale(&vertices[0].position.x, vertices.size(), sizeof(SkinVertex));
  std::vector<glm::vec3> seen;
  for (const SkinVertex& vertex : vertices) {
    const float lightness = std::sqrt(std::max(0.0f, glm::dot(vertex.colour, luminance)));
    seen.push_back(vertex.position +
                   (welded.worn.empty() ? bump * extent * lightness * vertex.normal : glm::vec3(0)));
  }
  return seen;
}

// Gives each vertex that is left the mean colour of the surface that it stands for: of what lies nearer to
// it, along edges, than to any other. Else a band would go with the vertices that had its colour.
std::vector<SkinVertex> recoloured(std::vector<SkinVertex> vertices, const std::vector<uint32_t>& triangles,
                                   const std::vector<uint32_t>& left) {
  std::vector<float> areas(vertices.size(), 0.0f);
  std::vector<std::vector<uint32_t>> neighbours(vertices.size());
  for (size_t i = 0; i < triangles.size(); i += 3) {
    const auto at = [&](size_t corner) { return vertices[triangles[i + corner]].position; };
    const float area = glm::length(glm::cross(at(1) - at(0), at(2) - at(0)));
    for (size_t corner = 0; corner < 3; ++corner) {
      areas[triangles[i + corner]] += area;
      for (const size_t other : {1, 2})
        neighbours[triangles[i + corner]].push_back(triangles[i + (corner + other) % 3]);
    }
  }
  // The shortest ways from all that are left at once (Dijkstra 1959).
  using Reached = std::tuple<float, uint32_t, uint32_t>;  // way, vertex, where it begins
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> next;
  std::vector<float> ways(vertices.size(), std::numeric_limits<float>::max());
  const auto reach = [&](uint32_t vertex, float way, uint32_t start) {
    if (way >= ways[vertex]) return;
    ways[vertex] = way;
    next.emplace(way, vertex, start);
  };
  for (const uint32_t vertex : left) reach(vertex, 0, vertex);
  std::vector<glm::vec4> sums(vertices.size(), glm::vec4(0));  // colour and area
  while (!next.empty()) {
    const auto [way, vertex, start] = next.top();
    next.pop();
    if (way > ways[vertex]) continue;
    sums[start] += areas[vertex] * glm::vec4(vertices[vertex].colour, 1);
    for (const uint32_t other : neighbours[vertex])
      reach(other, way + glm::distance(vertices[vertex].position, vertices[other].position), start);
  }
  for (size_t v = 0; v < vertices.size(); ++v)
    if (sums[v].w > 0) vertices[v].colour = glm::vec3(sums[v]) / sums[v].w;
  return vertices;
}

// Simplifies triangles of the skin. `level` counts from 0, the finest.
Surface simplified(const Welded& welded, std::vector<uint32_t> triangles, size_t level, float share,
                   float error) {
  if (triangles.empty()) return {};
  for (uint32_t& index : triangles) index = welded.remap[index];
  const std::vector<glm::vec3> seen = seenAs(welded, level == 1 ? kBump : 0);
  const size_t wanted = size_t(float(triangles.size() / 3) * share) * 3;
  std::vector<uint32_t> indices(triangles.size());
  indices.resize(meshopt_simplify(indices.data(), triangles.data(), triangles.size(), &seen[0].x, seen.size(),
                                  sizeof(glm::vec3), wanted, error, 0, nullptr));
  const std::vector<SkinVertex> vertices = recoloured(welded.vertices, triangles, indices);
  return optimised(vertices, welded.worn, std::move(indices));
}

void append(MeshData& data, MeshLod& lod, const Skin& skin, const Surface& surface) {
  lod = {.firstIndex = uint32_t(data.indices.size()),
         .indexCount = uint32_t(surface.indices.size()),
         .firstVertex = int32_t(data.vertices.size())};
  for (const SkinVertex& vertex : surface.vertices)
    data.vertices.push_back(meshVertex(skin, vertex, data.influences));
  data.worn.insert(data.worn.end(), surface.worn.begin(), surface.worn.end());
  data.indices.insert(data.indices.end(), surface.indices.begin(), surface.indices.end());
}

constexpr uint32_t indexCountOf(const Ribbon& ribbon) { return ribbon.waist ? 12 : 6; }

// A quad, or two that meet at the waist, whose corners the vertex shader moves apart.
void append(MeshData& data, MeshLod& lod, const Limbs& limbs, const Ribbon& ribbon) {
  const auto first = uint32_t(data.vertices.size()) - uint32_t(lod.firstVertex);
  data.influences = std::max(data.influences, 2);
  std::vector<Ribbon::End> sections{ribbon.from, ribbon.to};
  if (ribbon.waist) sections.insert(sections.begin() + 1, *ribbon.waist);
  // Each section looks away from its neighbour: the first one back, all others forward.
  for (size_t i = 0; i < sections.size(); ++i)
    for (const int side : {1, -1}) {
      const Ribbon::End &here = sections[i], &neighbour = sections[i == 0 ? 1 : i - 1];
      MeshVertex vertex{};
      vertex.bones[0] = limbs.carriers[here.bone].entry;
      vertex.influences[0] = glm::vec4(limbs.placeOf(here), 1);
      vertex.bones[1] = limbs.carriers[neighbour.bone].entry;
      vertex.influences[1] = glm::vec4(limbs.placeOf(neighbour), 0);
      vertex.colour = here.colour;
      vertex.halfWidth = float(side) * std::max(here.radius, kLeastHalfWidth);
      data.vertices.push_back(vertex);
      if (!data.worn.empty()) data.worn.emplace_back();
    }
  // Counter-clockwise, as seen from the eye that they are spread for.
  for (const uint32_t corner : {0u, 1u, 2u, 0u, 2u, 3u}) data.indices.push_back(first + corner);
  if (ribbon.waist)
    for (const uint32_t corner : {3u, 2u, 4u, 3u, 4u, 5u}) data.indices.push_back(first + corner);
  lod.indexCount += indexCountOf(ribbon);
}

MeshPart& partOf(MeshData& data, int material) {
  for (MeshPart& part : data.parts)
    if (part.material == material) return part;
  return data.parts.emplace_back(MeshPart{material, {}});
}

// The runs of a level whose last `ribbons` indices are ribbons'.
void splitByMaterial(MeshData& data, size_t level, uint32_t ribbons) {
  const MeshLod& lod = data.lods[level];
  for (uint32_t i = 0; i < lod.indexCount; i += 3) {
    const uint32_t vertex = uint32_t(lod.firstVertex) + data.indices[lod.firstIndex + i];
    const int material = i < lod.indexCount - ribbons ? data.worn[vertex].material : -1;
    MeshLod& run = partOf(data, material).lods[level];
    if (run.indexCount == 0) run = {lod.firstIndex + i, 0, lod.firstVertex};
    run.indexCount += 3;
  }
}

void appendLods(MeshData& data, const Skin& skin) {
  if (skin.indices.empty()) return;
  const std::vector<MaterialVertex>& worn = skin.look.vertices;
  append(data, data.lods[0], skin, optimised(skin.vertices, worn, skin.indices));
  if (skin.look) splitByMaterial(data, 0, 0);
  const Welded welded = weld(skin.vertices, skin.indices, worn);
  for (size_t i = 1; i < data.lods.size(); ++i) {
    const float pixel = data.radius / kLodPixels[i - 1];
    const float error = i + 1 < data.lods.size() ? kLargestError : kLastError;
    const Ribbons thin =
        ribbonsOf(skin.limbs.rig, kRibbonPixels * pixel, kBendPixels * pixel, i <= kLastWaists);
    append(data, data.lods[i], skin, simplified(welded, thin.others, i, kShare[i - 1], error));
    for (const Ribbon& ribbon : thin.ribbons) append(data, data.lods[i], skin.limbs, ribbon);
    uint32_t ribbons = 0;
    for (const Ribbon& ribbon : thin.ribbons) ribbons += indexCountOf(ribbon);
    if (skin.look) splitByMaterial(data, i, ribbons);
  }
}

}  // namespace

std::vector<Surface> surfacesOf(const std::vector<SkinVertex>& vertices,
                                const std::vector<uint32_t>& indices) {
  std::vector<Surface> surfaces;
  if (indices.empty()) return surfaces;
  surfaces.push_back(optimised(vertices, {}, indices));
  const Welded welded = weld(vertices, indices, {});
  for (size_t i = 0; i < kSurfaceShare.size(); ++i)
    surfaces.push_back(simplified(welded, indices, i + 1, kSurfaceShare[i], kLargestError));
  return surfaces;
}

MeshData makeMesh(const Rig& rig, const Limbs& limbs) {
  MeshData data;
  data.radius = crowd::radiusOf(rig);
  appendLods(data, {rig.vertices, rig.indices, rig.restStarts(), rig.look, limbs});
  return data;
}

MeshData makeMesh(const ClipSet& set, const Limbs& limbs) {
  MeshData data;
  data.radius = crowd::radiusOf(set);
  const std::vector<glm::vec3> starts(set.joints.size());  // the origin
  appendLods(data, {set.vertices, set.indices, starts, set.look, limbs});
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
  if (!data.worn.empty()) {
    mesh.worn = gpu::Buffer(context, data.worn.size() * sizeof(MaterialVertex), name + " materials' vertices",
                            gpu::BufferUse::vertex);
    gpu::upload(context, mesh.worn, data.worn);
  }
  mesh.lods = data.lods;
  mesh.parts = data.parts;
  mesh.influences = data.influences;
  mesh.radius = data.radius;
  return mesh;
}

}  // namespace skitter::render
