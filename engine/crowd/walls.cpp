#include "crowd/walls.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <variant>

#include "crowd/grid.h"
#include "crowd/radius.h"
#include "crowd/ways/shapes.h"
#include "gpu/context.h"
#include "gpu/transfer.h"
#include "shared/walls.h"
#include "skitter/error.h"

namespace skitter::crowd {
namespace {

constexpr uint32_t mostWallCells = 128;        // a side
constexpr uint64_t mostWallRecords = 1 << 20;  // vec4, where bindings reach so many

// An agent's middle may be nearer by this than float32 says, within 4 km. Metres.
constexpr float placeMargin = 0.01f;

struct Edge {
  glm::vec2 from, to;
};

// All within `radius` of the hull of its edges.
struct Wall {
  std::vector<Edge> edges;
  float radius = 0;
  bool solid = false;  // a polygon, whose edges go round as +x turns to +z
};

Wall wallOf(const Disc& disc) { return {{{disc.centre, disc.centre}}, disc.radius}; }
Wall wallOf(const Capsule& capsule) { return {{{capsule.from, capsule.to}}, capsule.radius}; }
Wall wallOf(const ConvexPolygon& polygon) {
  const std::vector<glm::vec2> corners = cornersOf(polygon);
  Wall wall{.edges = {}, .radius = 0, .solid = true};
  for (size_t i = 0; i < corners.size(); ++i)
    wall.edges.push_back({corners[i], corners[(i + 1) % corners.size()]});
  return wall;
}

// Square cells over the terrain, and which obstacles each one has.
struct WallGrid {
  uint32_t columns, rows;
  double cell;  // metres
  glm::dvec2 origin;
  std::vector<std::vector<uint32_t>> walls;
  uint64_t records = 0;  // vec4

  WallGrid(const Heightfield& terrain, std::span<const Obstacle> obstacles, std::span<const Wall> all,
           double reach, double side)
      : columns(count(terrain.extentX(), side)),
        rows(count(terrain.extentZ(), side)),
        cell(side),
        origin(terrain.originX(), terrain.originZ()),
        walls(size_t{columns} * rows) {
    records = shared::WALL_HEADS + walls.size();
    for (uint32_t i = 0; i < all.size(); ++i)
      add(i, obstacles[i], all[i].edges.size(), reach + cell * std::sqrt(0.5));
  }

 private:
  static uint32_t count(float side, double cell) {
    return static_cast<uint32_t>(std::max(1.0, std::ceil(double{side} / cell)));
  }
  static uint32_t along(double place, double cell, uint32_t count) {
    return static_cast<uint32_t>(std::clamp(std::floor(place / cell), 0.0, static_cast<double>(count - 1)));
  }

  // To the cells whose middles are within `reach` of it.
  void add(uint32_t i, const Obstacle& obstacle, size_t edges, double reach) {
    const ShapeBounds bounds = boundsOf(obstacle);
    const glm::dvec2 least = bounds.least - reach - origin, most = bounds.most + reach - origin;
    for (uint32_t row = along(least.y, cell, rows); row <= along(most.y, cell, rows); ++row)
      for (uint32_t column = along(least.x, cell, columns); column <= along(most.x, cell, columns);
           ++column) {
        if (distanceTo(obstacle, origin + cell * (glm::dvec2(column, row) + 0.5)) > reach) continue;
        walls[size_t{row} * columns + column].push_back(i);
        records += shared::WALL_EDGE_STRIDE * edges;
      }
  }
};

std::vector<float> flattened(const WallGrid& grid, std::span<const Wall> all, const Heightfield& terrain) {
  std::vector<float> records;
  const auto add = [&](float x, float y, float z, float w) { records.insert(records.end(), {x, y, z, w}); };
  add(static_cast<float>(grid.columns), static_cast<float>(grid.rows), static_cast<float>(1 / grid.cell), 0);
  add(terrain.originX(), terrain.originZ(), 0, 0);
  size_t first = shared::WALL_HEADS + grid.walls.size();
  for (const std::vector<uint32_t>& walls : grid.walls) {
    size_t edges = 0;
    for (const uint32_t i : walls) edges += all[i].edges.size();
    add(static_cast<float>(first), static_cast<float>(edges), 0, 0);
    first += shared::WALL_EDGE_STRIDE * edges;
  }
  for (const std::vector<uint32_t>& walls : grid.walls)
    for (const uint32_t i : walls)
      for (size_t k = 0; k < all[i].edges.size(); ++k) {
        const auto& [from, to] = all[i].edges[k];
        add(from.x, from.y, to.x, to.y);
        add(all[i].radius, k + 1 == all[i].edges.size() ? 1.0f : 0.0f, all[i].solid ? 1.0f : 0.0f, 0);
      }
  return records;
}

}  // namespace

std::optional<std::vector<float>> wallRecords(const Heightfield& terrain, std::span<const Obstacle> obstacles,
                                              float reach, uint64_t most) {
  std::vector<Wall> all;
  for (const Obstacle& obstacle : obstacles)
    all.push_back(std::visit([](const auto& shape) { return wallOf(shape); }, obstacle.shape));
  const double longest = std::max(double{terrain.extentX()}, double{terrain.extentZ()});
  for (double cell = std::max(double{reach}, longest / mostWallCells);; cell *= 2) {
    const WallGrid grid(terrain, obstacles, all, double{reach + placeMargin}, cell);
    if (grid.records <= most) return flattened(grid, all, terrain);
    if (grid.walls.size() == 1) return {};
  }
}

gpu::Buffer makeWalls(const Crowd::Impl& crowd, const Kind& kind) {
  // As far as agents look, at quanta of any size.
  const float reach = footprintRadius(kind.rig) + lookLegLengths * kind.rig.legLength + 2 * placeMargin;
  const uint64_t reached = bytesABinding(*crowd.context) / 16;
  const auto records =
      wallRecords(crowd.terrain, crowd.scene.obstacles, reach, std::min(reached, mostWallRecords));
  if (!records)
    throw deviceError(fmt::format("{}: a binding reaches {} vec4, {} obstacles need more",
                                  crowd.context->report().name, reached, crowd.scene.obstacles.size()));
  gpu::Buffer buffer(*crowd.context, records->size() * sizeof(float), "walls");
  gpu::upload(*crowd.context, buffer, *records);
  return buffer;
}

}  // namespace skitter::crowd
