#include "render/ground_map.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/packing.hpp>

#include "gpu/transfer.h"

namespace skitter::render {
namespace {

struct Grid {
  const Heightfield& field;
  int columns, rows;

  float at(int x, int z) const {
    x = std::clamp(x, 0, columns - 1);
    z = std::clamp(z, 0, rows - 1);
    return field.heights[size_t(z) * size_t(columns) + size_t(x)];
  }
};

// Hollows see less sky: the height compared with the mean of rings of samples about it.
float opennessAt(const Grid& g, int x, int z) {
  float open = 1;
  for (const int ring : {1, 3, 8}) {
    const int d = std::max(1, int(float(ring) * 0.7f));
    const float mean = (g.at(x + ring, z) + g.at(x - ring, z) + g.at(x, z + ring) + g.at(x, z - ring) +
                        g.at(x + d, z + d) + g.at(x - d, z - d) + g.at(x + d, z - d) + g.at(x - d, z + d)) /
                       8;
    const float rise = (mean - g.at(x, z)) / (float(ring) * 0.5f * (g.field.spacingX + g.field.spacingZ));
    open -= 0.55f * std::clamp(rise, -0.2f, 0.6f);
  }
  return std::clamp(open, 0.35f, 1.12f);
}

// The height of the hills' shadow above each sample, by one sweep with the light: a row's shadow is the
// higher of the ground and the shadow one row nearer to the sun, less what a ray falls on the way.
std::vector<float> shadowHeights(const Grid& g, const glm::vec3& sun) {
  std::vector<float> shadow(size_t(g.columns) * size_t(g.rows), -1e30f);
  const bool alongX = std::abs(sun.x) / g.field.spacingX > std::abs(sun.z) / g.field.spacingZ;
  const float major = alongX ? sun.x / g.field.spacingX : sun.z / g.field.spacingZ;
  const float minor = alongX ? sun.z / g.field.spacingZ : sun.x / g.field.spacingX;
  if (std::abs(major) < 1e-6f) return shadow;
  const int step = major > 0 ? 1 : -1, lines = alongX ? g.columns : g.rows,
            length = alongX ? g.rows : g.columns;
  const float drift = minor / std::abs(major), fall = sun.y / std::abs(major);
  const auto index = [&](int line, int i) {
    return alongX ? size_t(i) * size_t(g.columns) + size_t(line)
                  : size_t(line) * size_t(g.columns) + size_t(i);
  };
  for (int n = 1; n < lines; ++n) {
    const int line = step > 0 ? lines - 1 - n : n, before = line + step;
    for (int i = 0; i < length; ++i) {
      const float from = float(i) + drift, whole = std::floor(from), part = from - whole;
      const int a = int(whole);
      if (a < 0 || a + 1 >= length) continue;
      const auto top = [&](int j) {
        return std::max(g.field.heights[index(before, j)], shadow[index(before, j)]);
      };
      shadow[index(line, i)] = top(a) + part * (top(a + 1) - top(a)) - fall;
    }
  }
  return shadow;
}

Grid gridOf(const Heightfield& field) { return {field, int(field.columns), int(field.rows)}; }

}  // namespace

glm::vec2 gradientAt(const Heightfield& field, int x, int z) {
  const Grid g = gridOf(field);
  return {(g.at(x + 1, z) - g.at(x - 1, z)) / (2 * field.spacingX),
          (g.at(x, z + 1) - g.at(x, z - 1)) / (2 * field.spacingZ)};
}

gpu::Image makeGroundMap(const gpu::Context& context, const Heightfield& field, const glm::vec3& towardsSun) {
  constexpr float kPenumbra = 0.35f;  // metres of height over which a hill's shadow softens
  const Grid grid = gridOf(field);
  const std::vector<float> shadow = shadowHeights(grid, towardsSun);
  std::vector<uint64_t> texels(field.heights.size());
  for (int z = 0; z < grid.rows; ++z)
    for (int x = 0; x < grid.columns; ++x) {
      const size_t i = size_t(z) * size_t(grid.columns) + size_t(x);
      const glm::vec2 gradient = gradientAt(field, x, z);
      const float sun = 1 - std::clamp((shadow[i] - field.heights[i]) / kPenumbra, 0.0f, 1.0f);
      texels[i] = glm::packHalf4x16(glm::vec4(gradient, opennessAt(grid, x, z), sun));
    }
  gpu::Image image(context,
                   {.format = vk::Format::eR16G16B16A16Sfloat,
                    .extent = {field.columns, field.rows},
                    .usage = vk::ImageUsageFlagBits::eSampled},
                   "ground map");
  gpu::uploadImage(context, image, texels);
  return image;
}

}  // namespace skitter::render
