#include <algorithm>
#include <cmath>
#include <functional>

#include "bindings/c/handles.h"
#include "skitter/palettes.h"
#include "skitter/skin_mesh.h"

using namespace skitter;
using c::crowdOf;
using c::given;
using c::guarded;

namespace {

static_assert(SKITTER_AXES_RIGHT_Y_UP == static_cast<int>(Axes::rightYUp) &&
              SKITTER_AXES_LEFT_Y_UP == static_cast<int>(Axes::leftYUp) &&
              SKITTER_AXES_RIGHT_Z_UP == static_cast<int>(Axes::rightZUp) &&
              SKITTER_AXES_LEFT_Z_UP == static_cast<int>(Axes::leftZUp));
static_assert(SKITTER_TRANSFORM_MATRIX == static_cast<int>(TransformFormat::matrix) &&
              SKITTER_TRANSFORM_QUATERNION == static_cast<int>(TransformFormat::quaternion));

HostSpace spaceOf(const skitter_space& space) {
  const int axes = static_cast<int>(space.axes);
  if (axes < SKITTER_AXES_RIGHT_Y_UP || axes > SKITTER_AXES_LEFT_Z_UP)
    throw inputError(fmt::format("space.axes is {}, expected a skitter_axes", axes));
  const float metres = space.metres_per_unit != 0 ? space.metres_per_unit : 1;
  if (!(metres > 0) || !std::isfinite(metres))
    throw inputError(fmt::format("space.metres_per_unit is {:g}, expected a length above 0", metres));
  return {.axes = static_cast<Axes>(axes), .metresPerUnit = metres};
}

TransformRange rangeOf(const skitter_transform_range& range, const char* name) {
  const int format = static_cast<int>(range.format);
  if (format != SKITTER_TRANSFORM_MATRIX && format != SKITTER_TRANSFORM_QUATERNION)
    throw inputError(fmt::format("{}.format is {}, expected a skitter_transform_format", name, format));
  return {.buffer = range.buffer,
          .offset = range.offset,
          .bytes = range.bytes,
          .format = static_cast<TransformFormat>(format),
          .stride = range.stride,
          .planar = range.planar != 0};
}

PaletteOptions optionsOf(const skitter_palette_options& asked) {
  return {.space = spaceOf(asked.space), .relative = asked.relative != 0};
}

skitter_skin_vertex vertexFrom(const SkinVertex& vertex) {
  skitter_skin_vertex to;
  c::copyVector(vertex.position, to.position);
  c::copyVector(vertex.normal, to.normal);
  c::copyVector(vertex.colour, to.colour);
  std::ranges::copy(vertex.bones, to.bones);
  std::ranges::copy(vertex.weights, to.weights);
  return to;
}

skitter_skin_level levelFrom(const SkinMesh::Level& level) {
  return {.first_index = level.firstIndex, .index_count = level.indexCount, .pixels = level.pixels};
}

const SkinMesh& meshOf(const skitter_skin_mesh* mesh) { return given(mesh, "mesh").mesh; }

}  // namespace

skitter_result skitter_crowd_palette_entries(const skitter_crowd* crowd, uint32_t herd, uint32_t* entries) {
  return c::tell(crowd, entries, "entries",
                 [&](const Crowd& asked) { return Palettes::entriesOf(asked, herd); });
}

skitter_result skitter_palettes_create(skitter_crowd* crowd, uint32_t herd,
                                       const skitter_palette_target* targets, uint32_t target_count,
                                       const skitter_palette_options* options, skitter_palettes** palettes) {
  return guarded([&] {
    const std::shared_ptr<c::LiveCrowd>& live = given(crowd, "crowd").live;
    given(palettes, "palettes");
    std::vector<PaletteTarget> list;
    for (const skitter_palette_target& target : c::listOf(targets, target_count, "targets"))
      list.push_back({.instances = rangeOf(target.instances, "instances"),
                      .palettes = rangeOf(target.palettes, "palettes")});
    const PaletteOptions made = options != nullptr ? optionsOf(*options) : PaletteOptions{};
    *palettes =
        new skitter_palettes{live, Palettes(*live->device, live->crowd, herd, list, made), list.size()};
  });
}

skitter_result skitter_palettes_record(const skitter_palettes* palettes, VkCommandBuffer commands,
                                       const double* origin, uint32_t target) {
  return guarded([&] {
    const skitter_palettes& from = given(palettes, "palettes");
    given(commands, "commands");
    const glm::dvec3 place = c::originOf(origin);
    if (target >= from.targets)
      throw inputError(
          fmt::format("target is {}, the palettes have {}, counted from 0", target, from.targets));
    from.palettes.record(commands, place, target);
  });
}

skitter_result skitter_palettes_destroy(skitter_palettes* palettes) {
  return guarded([&] { delete palettes; });
}

skitter_result skitter_skin_mesh_create(const skitter_crowd* crowd, uint32_t herd, const skitter_space* space,
                                        skitter_skin_mesh** mesh) {
  return guarded([&] {
    const Crowd& asked = crowdOf(crowd);
    given(mesh, "mesh");
    *mesh = new skitter_skin_mesh{skinMeshOf(asked, herd, space != nullptr ? spaceOf(*space) : HostSpace{})};
  });
}

skitter_result skitter_skin_mesh_vertices(const skitter_skin_mesh* mesh, skitter_skin_vertex* vertices,
                                          size_t room, size_t* count) {
  return guarded([&] {
    const SkinMesh& from = meshOf(mesh);
    c::Told<skitter_skin_vertex>(vertices, room, "vertices", count).write(from.vertices, vertexFrom);
  });
}

skitter_result skitter_skin_mesh_indices(const skitter_skin_mesh* mesh, uint32_t* indices, size_t room,
                                         size_t* count) {
  return guarded([&] {
    const SkinMesh& from = meshOf(mesh);
    c::Told<uint32_t>(indices, room, "indices", count).write(from.indices, std::identity());
  });
}

skitter_result skitter_skin_mesh_levels(const skitter_skin_mesh* mesh, skitter_skin_level* levels,
                                        size_t room, size_t* count) {
  return guarded([&] {
    const SkinMesh& from = meshOf(mesh);
    c::Told<skitter_skin_level>(levels, room, "levels", count).write(from.levels, levelFrom);
  });
}

skitter_result skitter_skin_mesh_radius(const skitter_skin_mesh* mesh, float* radius) {
  return guarded([&] {
    const SkinMesh& from = meshOf(mesh);
    given(radius, "radius");
    *radius = from.radius;
  });
}

skitter_result skitter_skin_mesh_destroy(skitter_skin_mesh* mesh) {
  return guarded([&] { delete mesh; });
}
