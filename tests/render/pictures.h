// Scenes on small ground and pictures of them, for the tests of what is drawn.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "gpu/submit.h"
#include "skitter/records.h"
#include "skitter/renderer.h"
#include "support/gpu_fixture.h"

namespace skitter::test {

// One herd on small ground.
inline Scene smallScene(uint32_t agents) {
  Scene scene = builtinScene();
  TerrainNoise noise;
  noise.columns = noise.rows = 129;
  scene.terrain = noise;
  scene.herds.resize(1);
  scene.herds[0].agents = agents;
  scene.camera = Camera{};
  return scene;
}

struct Picture {
  uint32_t width, height;
  std::vector<uint8_t> rgba;

  glm::ivec3 at(int x, int y) const {
    const uint8_t* p = &rgba[(size_t(y) * width + size_t(x)) * 4];
    return {p[0], p[1], p[2]};
  }
  glm::dvec3 mean(int firstRow, int lastRow) const {
    glm::dvec3 sum(0);
    for (int y = firstRow; y <= lastRow; ++y)
      for (int x = 0; x < int(width); ++x) sum += glm::dvec3(at(x, y));
    return sum / double((lastRow - firstRow + 1) * int(width));
  }
};

// A scene that lives on a device, and pictures of it.
struct Stage {
  Scene scene;
  Heightfield terrain;
  Crowd crowd;
  Renderer renderer;
  gpu::Context& context;

  Stage(Device& device, const Scene& s, uint32_t width, uint32_t height, const RendererOptions& options = {})
      : Stage(device, s, s.loadTerrain(), width, height, options) {}
  Stage(Device& device, const Scene& s, const Heightfield& ground, uint32_t width, uint32_t height,
        const RendererOptions& options = {}, const CrowdOptions& crowdOptions = {})
      : scene(s),
        terrain(ground),
        crowd(device, terrain, scene, crowdOptions),
        renderer(device, crowd, width, height, options),
        context(device.context()) {}

  void tick(int count) {
    for (int i = 0; i < count; ++i)
      gpu::submitAndWait(context, [&](vk::CommandBuffer cmd) { crowd.record(cmd, 1.0f / 60); });
  }
  Picture draw(const View& view) {
    gpu::submitAndWait(context, [&](vk::CommandBuffer cmd) { renderer.record(cmd, view); });
    return {renderer.width(), renderer.height(), renderer.download()};
  }
};

inline size_t differing(const Picture& a, const Picture& b) {
  size_t count = 0;
  for (size_t i = 0; i < a.rgba.size(); i += 4)
    count += !std::equal(a.rgba.begin() + long(i), a.rgba.begin() + long(i) + 3, b.rgba.begin() + long(i));
  return count;
}

// Independent of the renderer's own matrices.
inline glm::vec2 pixelOf(const View& view, glm::vec3 point, uint32_t width, uint32_t height) {
  const glm::vec3 forward = glm::normalize(view.target - view.eye);
  const glm::vec3 right = glm::normalize(glm::cross(forward, glm::vec3(0, 1, 0)));
  const glm::vec3 up = glm::cross(right, forward), to = point - view.eye;
  const float focal = 0.5f * float(height) / std::tan(view.fieldOfView / 2) / glm::dot(to, forward);
  return {0.5f * float(width) + focal * glm::dot(to, right), 0.5f * float(height) - focal * glm::dot(to, up)};
}

inline glm::vec3 bodyOf(const HerdState& state) {
  const std::vector<float>& b = state.body;
  return {shared::tileX(b[3]) * shared::TILE_SIZE + b[0], b[1],
          shared::tileZ(b[3]) * shared::TILE_SIZE + b[2]};
}

// Ground of half a metre a sample, its first sample where noise of as many columns and rows has it.
inline Heightfield groundOf(uint32_t columns, uint32_t rows,
                            const std::function<float(float, float)>& heightOf) {
  Heightfield field{
      .name = "made", .columns = columns, .rows = rows, .spacingX = 0.5f, .spacingZ = 0.5f, .heights = {}};
  for (uint32_t z = 0; z < rows; ++z)
    for (uint32_t x = 0; x < columns; ++x) field.heights.push_back(heightOf(float(x), float(z)));
  return field;
}

// The suite has its tests in several files.
class RendererTest : public GpuLoadTest {};

}  // namespace skitter::test
