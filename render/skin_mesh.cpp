#include "skitter/skin_mesh.h"

#include "crowd/controller.h"
#include "crowd/herd.h"
#include "crowd/host_space.h"
#include "crowd/radius.h"
#include "render/mesh.h"
#include "skitter/palettes.h"

namespace skitter {
namespace {

void append(SkinMesh& mesh, const render::Surface& surface, float pixels) {
  const auto firstVertex = static_cast<uint32_t>(mesh.vertices.size());
  mesh.levels.push_back({.firstIndex = static_cast<uint32_t>(mesh.indices.size()),
                         .indexCount = static_cast<uint32_t>(surface.indices.size()),
                         .pixels = pixels});
  mesh.vertices.insert(mesh.vertices.end(), surface.vertices.begin(), surface.vertices.end());
  for (const uint32_t index : surface.indices) mesh.indices.push_back(firstVertex + index);
}

void move(SkinMesh& mesh, const HostSpace& space) {
  const glm::dmat3 turned = space.turned();
  for (SkinVertex& vertex : mesh.vertices) {
    vertex.position = space.from(vertex.position);
    vertex.normal = turned * glm::dvec3(vertex.normal);
  }
  mesh.radius /= space.metresPerUnit;
}

}  // namespace

SkinMesh skinMeshOf(const Crowd& crowd, uint32_t herd, const HostSpace& space) {
  crowd::checkSpace(space);
  const crowd::Kind& kind = implOf(crowd).kindOf(herd);
  const bool clips = crowd::traitsOf(kind.controller).playsClips;
  const std::vector<render::Surface> surfaces =
      clips ? render::surfacesOf(kind.clipSet.vertices, kind.clipSet.indices)
            : render::surfacesOf(kind.rig.vertices, kind.rig.indices);
  SkinMesh mesh;
  mesh.entries = Palettes::entriesOf(crowd, herd);
  mesh.radius = crowd::radiusOf(implOf(crowd), implOf(crowd).herdAt(herd));
  for (size_t level = 0; level < surfaces.size(); ++level)
    append(mesh, surfaces[level], level < render::kSurfacePixels.size() ? render::kSurfacePixels[level] : 0);
  move(mesh, space);
  return mesh;
}

}  // namespace skitter
