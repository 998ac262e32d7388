#include "render/terrain.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "embedded/terrain_frag.h"
#include "embedded/terrain_vert.h"
#include "gpu/transfer.h"
#include "render/bindings.h"

namespace skitter::render {
namespace {

constexpr int kCells = 32;               // along a patch
constexpr float kRangeOfSize = 4;        // a patch serves up to this many times its size away
constexpr float kFinestSpacing = 0.12f;  // metres between vertices below which a finer patch gains nothing
constexpr uint32_t kMostPatches = 4096;  // 64 KiB, the most that an update takes

class Chooser {
 public:
  Chooser(const Composition& composition, const Heightfield& field, float lowest, float highest)
      : c_(composition), lowest_(lowest), highest_(highest) {
    origin_ = {c_.block.ground.x, c_.block.ground.y};
    spacing_ = {field.spacingX, field.spacingZ};
    const float coarse = std::max(field.spacingX, field.spacingZ);
    while (coarse * stride(finest_) > kFinestSpacing * 1.4f) --finest_;
  }

  std::vector<Patch> choose() {
    int level = finest_;
    while (range(level) < c_.viewDistance) ++level;
    const float side = stride(level) * kCells;
    const glm::vec2 eye{c_.block.eye.x, c_.block.eye.z};
    const glm::vec2 reach = glm::vec2(c_.viewDistance) / (spacing_ * side);
    const glm::vec2 middle = (eye - origin_) / (spacing_ * side);
    for (float z = std::floor(middle.y - reach.y); z <= middle.y + reach.y; ++z)
      for (float x = std::floor(middle.x - reach.x); x <= middle.x + reach.x; ++x)
        visit(glm::vec2(x, z) * side, level);
    // What is hidden by ground before it is then not shaded.
    std::ranges::stable_sort(found_, {}, &Found::away);
    std::vector<Patch> patches;
    for (const Found& found : found_) patches.push_back(found.patch);
    return patches;
  }

 private:
  struct Found {
    float away;  // metres, its nearest point
    Patch patch;
  };
  static float stride(int level) { return std::exp2(float(level)); }
  float range(int level) const {
    return kRangeOfSize * kCells * stride(level) * std::max(spacing_.x, spacing_.y);
  }

  void visit(const glm::vec2& at, int level) {
    const float side = stride(level) * kCells;
    const glm::vec3 low{origin_.x + at.x * spacing_.x, lowest_, origin_.y + at.y * spacing_.y};
    const glm::vec3 high{low.x + side * spacing_.x, highest_, low.z + side * spacing_.y};
    const float away = distanceTo(low, high);
    if (away > c_.viewDistance || !seen(low, high)) return;
    if (level > finest_ && away < range(level - 1)) {
      for (const glm::vec2 quarter : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(0, 1), glm::vec2(1, 1)})
        visit(at + quarter * (side / 2), level - 1);
      return;
    }
    found_.push_back({away, {at.x, at.y, stride(level), range(level)}});
  }

  // As the vertex shader measures it, by which neighbours agree on how far they have morphed.
  float distanceTo(const glm::vec3& low, const glm::vec3& high) const {
    const glm::vec3 eye(c_.block.eye);
    const glm::vec3 nearest = glm::clamp(eye, low, high);
    return glm::length(glm::vec3(nearest.x - eye.x, nearest.z - eye.z, c_.block.shadow.z));
  }

  bool seen(const glm::vec3& low, const glm::vec3& high) const {
    for (const glm::vec4& plane : c_.block.planes) {
      const glm::vec3 n(plane);
      const glm::vec3 furthest = glm::mix(low, high, glm::greaterThan(n, glm::vec3(0)));
      if (glm::dot(n, furthest) + plane.w < 0) return false;
    }
    return true;
  }

  const Composition& c_;
  float lowest_, highest_;
  glm::vec2 origin_, spacing_;
  int finest_ = 0;
  std::vector<Found> found_;
};

std::vector<uint16_t> patchIndices() {
  std::vector<uint16_t> indices;
  // Strips of eight cells, so that a row's vertices are still cached when the next row needs them.
  for (int strip = 0; strip < kCells; strip += 8)
    for (int z = 0; z < kCells; ++z)
      for (int x = strip; x < strip + 8; ++x) {
        const int a = z * (kCells + 1) + x, b = a + 1, c = a + kCells + 1, d = c + 1;
        for (const int i : {a, c, b, b, c, d}) indices.push_back(uint16_t(i));
      }
  return indices;
}

}  // namespace

std::vector<Patch> choosePatches(const Composition& composition, const Heightfield& field, float lowest,
                                 float highest) {
  return Chooser(composition, field, lowest, highest).choose();
}

Terrain::Terrain(const Setting& s) : field_(s.terrain) {
  const auto [lowest, highest] = std::minmax_element(field_.heights.begin(), field_.heights.end());
  lowest_ = *lowest;
  highest_ = *highest;

  using gpu::BindingKind;
  pipeline_ = gpu::GraphicsPipeline(s.context,
                                    {.name = "terrain",
                                     .vertex = embedded::terrain_vert(),
                                     .fragment = embedded::terrain_frag(),
                                     .bindings = {{shared::DRAW_PICTURE, BindingKind::uniform},
                                                  {shared::DRAW_HEIGHTS, BindingKind::heights},
                                                  {shared::DRAW_GROUND, BindingKind::texture},
                                                  {shared::DRAW_SHADOW, BindingKind::texture}},
                                     .streams = {{.stride = sizeof(Patch),
                                                  .rate = vk::VertexInputRate::eInstance,
                                                  .attributes = {{0, vk::Format::eR32G32B32A32Sfloat, 0}}}},
                                     .colour = s.colour,
                                     .depth = s.depth,
                                     .samples = s.samples,
                                     .constants = {{shared::CONSTANT_ROOTS, s.filtered()}}});
  const std::vector<gpu::Binding> list{{shared::DRAW_PICTURE, &s.picture},
                                       {shared::DRAW_HEIGHTS, &s.heights},
                                       {shared::DRAW_GROUND, &s.ground, s.groundSampler},
                                       {shared::DRAW_SHADOW, &s.shadow.image(), s.shadow.sampler()}};
  bindings_ = pipeline_.bind(s.context, list);

  const std::vector<uint16_t> indices = patchIndices();
  indexCount_ = uint32_t(indices.size());
  indices_ =
      gpu::Buffer(s.context, indices.size() * sizeof(uint16_t), "terrain indices", gpu::BufferUse::index);
  gpu::upload(s.context, indices_, indices);
  patches_ = gpu::Buffer(s.context, kMostPatches * sizeof(Patch), "terrain patches", gpu::BufferUse::vertex);
}

void Terrain::prepare(vk::CommandBuffer cmd, const Composition& composition) {
  const std::vector<Patch> patches = choosePatches(composition, field_, lowest_, highest_);
  assert(patches.size() <= kMostPatches);
  patchCount_ = uint32_t(patches.size());
  if (patchCount_ > 0) cmd.updateBuffer(patches_.handle(), 0, patchCount_ * sizeof(Patch), patches.data());
}

void Terrain::draw(vk::CommandBuffer cmd) const {
  if (patchCount_ == 0) return;
  pipeline_.use(cmd, bindings_, {});
  cmd.bindVertexBuffers(0, patches_.handle(), vk::DeviceSize(0));
  cmd.bindIndexBuffer(indices_.handle(), 0, vk::IndexType::eUint16);
  cmd.drawIndexed(indexCount_, patchCount_, 0, 0, 0);
}

}  // namespace skitter::render
