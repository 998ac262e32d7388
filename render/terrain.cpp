#include "render/terrain.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include "embedded/terrain_frag.h"
#include "embedded/terrain_vert.h"
#include "gpu/transfer.h"
#include "render/bindings.h"
#include "render/ground_map.h"

namespace skitter::render {
namespace {

constexpr int kCells = shared::PATCH_CELLS;
constexpr float kFinestSpacing = 0.12f;  // metres between vertices below which a finer patch gains nothing
constexpr uint32_t kMostPatches = 4096;  // 64 KiB, the most that an update takes

// By how much a mesh may differ from the ground, root mean square, before a finer one takes its place.
constexpr float kErrorPixels = 1.0f / 2;
// A level serves at least so many sides of a patch, or neighbours could be two levels apart, and at most as
// far as its cells have so many pixels across: smaller triangles cost more than they show.
constexpr float kLeastRange = 4, kCellPixels = 8;
constexpr float kMorphBegins = 0.87f;  // of the range, in shaders/render/terrain.vert

// Metres between vertices up to which those of a patch show noise of 9.7 m: interpolated, it is off by some
// 0.03 at most, of -1 to 1.
constexpr float kDenseSpacing = 1;

// Metres across a pixel from which clods, of 0.31 m, are not seen, and from which grains, of 0.062 m, are
// not, nor pebbles, which have at most 0.048 m (shaders/render/terrain.frag), with a little for rounding.
constexpr float kNoClods = 0.4f * 0.31f * 1.01f, kNoGrains = 0.4f * 0.062f * 1.01f;
constexpr float kLeastFacing = 0.02f;  // cosine that the shader takes a surface to have at least
// The ground map has slopes as half floats.
constexpr float kHalfRounding = 1 + 0x1p-11f;
// Samples across a patch that are looked at, at most: coarser patches are too far away for detail.
constexpr float kLookedAt = 4 * kCells;
// Of the depth to which shadows reach, where they have faded (shaders/render/shadow.glsl), likewise.
constexpr float kNoShadow = 0.98f * 1.01f;

constexpr double kJudgedCells = 1 << 14;  // of the ground, for each level

float strideOf(int level) { return std::exp2(float(level)); }

// Root mean square of what `each` returns of cells (x, z) of a grid, at most about kJudgedCells of them. They
// are an odd number apart, so that they lie everywhere in the cells of coarse meshes.
template <class Each>
float meanOf(uint32_t columns, uint32_t rows, const Each& each) {
  const double cells = double(columns) * double(rows);
  const uint32_t step = uint32_t(std::ceil(std::sqrt(cells / kJudgedCells))) | 1;
  double sum = 0, count = 0;
  for (uint32_t z = 0; z < rows; z += step)
    for (uint32_t x = 0; x < columns; x += step) {
      const double off = each(x, z);
      sum += off * off;
      ++count;
    }
  return count > 0 ? float(std::sqrt(sum / count)) : 0;
}

// Between the ground in cell (x, z) and the triangles of a mesh with a vertex every `stride` samples: root
// mean square.
double deviationIn(const Heightfield& field, uint32_t x, uint32_t z, uint32_t stride) {
  const auto at = [&](uint32_t column, uint32_t row) {
    return double(field.heights[size_t(row) * field.columns + column]);
  };
  const uint32_t x0 = x / stride * stride, x1 = x0 + stride, z0 = z / stride * stride, z1 = z0 + stride;
  double sum = 0;
  // Two points of Gauss each way: the square of a bilinear function is integrated exactly.
  for (const double a : {0.5 - std::sqrt(1.0 / 12), 0.5 + std::sqrt(1.0 / 12)})
    for (const double b : {0.5 - std::sqrt(1.0 / 12), 0.5 + std::sqrt(1.0 / 12)}) {
      const double ground =
          std::lerp(std::lerp(at(x, z), at(x + 1, z), a), std::lerp(at(x, z + 1), at(x + 1, z + 1), a), b);
      const double u = (double(x - x0) + a) / stride, v = (double(z - z0) + b) / stride;
      // As patchIndices() divides a cell.
      const double drawn =
          u + v < 1 ? at(x0, z0) + u * (at(x1, z0) - at(x0, z0)) + v * (at(x0, z1) - at(x0, z0))
                    : at(x1, z1) + (1 - u) * (at(x0, z1) - at(x1, z1)) + (1 - v) * (at(x1, z0) - at(x1, z1));
      sum += 0.25 * (drawn - ground) * (drawn - ground);
    }
  return std::sqrt(sum);
}

// The lowest and the highest height of the samples from `first` to `last`.
std::pair<float, float> lowestAndHighest(const Heightfield& field, const glm::uvec2& first,
                                         const glm::uvec2& last) {
  float lowest = std::numeric_limits<float>::max(), highest = -lowest;
  for (uint32_t z = first.y; z <= last.y; ++z)
    for (uint32_t x = first.x; x <= last.x; ++x) {
      const float height = field.heights[size_t(z) * field.columns + x];
      lowest = std::min(lowest, height);
      highest = std::max(highest, height);
    }
  return {lowest, highest};
}

// Fills in the relief's slopes.
void addSlopes(Relief& relief, const Heightfield& field) {
  constexpr uint32_t side = kReliefBlock;
  const auto blocks = [](uint32_t samples) { return std::max(1u, (samples - 1 + side - 1) / side); };
  relief.blocksAcross = blocks(field.columns);
  const uint32_t down = blocks(field.rows);
  relief.slopes.assign(size_t(relief.blocksAcross) * down, 0.0f);
  for (uint32_t z = 0; z < field.rows; ++z)
    for (uint32_t x = 0; x < field.columns; ++x) {
      const float slope = glm::length(gradientAt(field, int(x), int(z)));
      relief.steepest = std::max(relief.steepest, slope);
      // A sample where blocks meet is of each of them.
      for (uint32_t row = (z - std::min(z, 1u)) / side; row <= std::min(z / side, down - 1); ++row)
        for (uint32_t column = (x - std::min(x, 1u)) / side;
             column <= std::min(x / side, relief.blocksAcross - 1); ++column) {
          float& most = relief.slopes[size_t(row) * relief.blocksAcross + column];
          most = std::max(most, slope);
        }
    }
}

class Chooser {
 public:
  Chooser(const Composition& composition, const Heightfield& field, const Relief& relief)
      : c_(composition), relief_(relief) {
    origin_ = {c_.block.ground.x, c_.block.ground.y};
    spacing_ = {field.spacingX, field.spacingZ};
    const float coarse = std::max(field.spacingX, field.spacingZ);
    while (coarse * strideOf(finest_) > kFinestSpacing * 1.4f) --finest_;
  }

  std::vector<Patch> choose() {
    // Rough ground that is seen from all around at once may need more patches than there is room for.
    float coarser = 1;
    do {
      setRanges(coarser);
      visitAll();
      coarser *= 2;
    } while (found_.size() > kMostPatches && coarser < 1e3f);
    // What is hidden by ground before it is then not shaded.
    std::ranges::stable_sort(found_, {}, &Found::away);
    found_.resize(std::min(found_.size(), size_t(kMostPatches)));
    std::vector<Patch> patches;
    for (const Found& found : found_) patches.push_back(found.patch);
    return patches;
  }

 private:
  struct Found {
    float away;  // metres, its nearest point
    Patch patch;
  };
  float range(int level) const { return ranges_[size_t(level - finest_)]; }

  // Each level serves as far as the next one would be seen to differ from the ground, and so far that it has
  // become the next one wherever both meet, before that becomes the one after.
  void setRanges(float coarser) {
    ranges_.clear();
    float before = 0;
    for (int level = finest_; before < c_.viewDistance; ++level) {
      const float cells = kCells * strideOf(level), cell = strideOf(level) * std::max(spacing_.x, spacing_.y);
      const float wanted = distanceOf(relief_.deviationOf(level + 1), coarser * kErrorPixels);
      const float most = cell / (coarser * kCellPixels * c_.block.eye.w);
      before = std::max({std::min(wanted, most), kLeastRange * kCells * cell,
                         (before + cells * glm::length(spacing_)) / kMorphBegins});
      ranges_.push_back(before);
    }
  }

  // From where on `metres` are at most so many pixels. What fog takes of a pixel's light, it takes of an
  // error.
  float distanceOf(float metres, float pixels) const {
    float near = 0, far = c_.viewDistance;
    for (int step = 0; step < 24; ++step) {
      const float middle = 0.5f * (near + far), depth = middle * c_.block.tile.w;
      const bool differs = metres * std::exp(-depth * depth) > pixels * c_.block.eye.w * middle;
      (differs ? near : far) = middle;
    }
    return far;
  }

  void visitAll() {
    found_.clear();
    const int level = finest_ + int(ranges_.size()) - 1;
    const float side = strideOf(level) * kCells;
    const glm::vec2 eye{c_.block.eye.x, c_.block.eye.z};
    const glm::vec2 reach = glm::vec2(c_.viewDistance) / (spacing_ * side);
    const glm::vec2 middle = (eye - origin_) / (spacing_ * side);
    for (float z = std::floor(middle.y - reach.y); z <= middle.y + reach.y; ++z)
      for (float x = std::floor(middle.x - reach.x); x <= middle.x + reach.x; ++x)
        visit(glm::vec2(x, z) * side, level);
  }

  void visit(const glm::vec2& at, int level) {
    const float side = strideOf(level) * kCells;
    const glm::vec3 low{origin_.x + at.x * spacing_.x, relief_.lowest, origin_.y + at.y * spacing_.y};
    const glm::vec3 high{low.x + side * spacing_.x, relief_.highest, low.z + side * spacing_.y};
    const float away = distanceTo(low, high);
    if (away > c_.viewDistance || !seen(low, high)) return;
    if (level > finest_ && away < range(level - 1)) {
      for (const glm::vec2 quarter : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(0, 1), glm::vec2(1, 1)})
        visit(at + quarter * (side / 2), level - 1);
      return;
    }
    found_.push_back({away, {at.x, at.y, strideOf(level), range(level)}});
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
  const Relief& relief_;
  glm::vec2 origin_, spacing_;
  int finest_ = 0;
  std::vector<float> ranges_;  // of the levels from finest_ on, metres
  std::vector<Found> found_;
};

// Bounds of the ground that a patch shows.
struct Bounds {
  glm::vec3 low, high;  // a box, in picture space
  float steepest;       // slope
};

Bounds boundsOf(const Composition& c, const Relief& relief, const Patch& patch) {
  const glm::vec2 spacing(c.block.ground.z, c.block.ground.w);
  const glm::vec2 from = glm::vec2(c.block.ground) + glm::vec2(patch) * spacing;
  const glm::vec2 to = from + float(kCells) * patch.z * spacing;
  return {{from.x, relief.lowest, from.y}, {to.x, relief.highest, to.y}, relief.steepest};
}

// Makes `bounds` of all ground those of the ground below the patch. Patches of the mirror image keep them.
void tighten(Bounds& bounds, const Heightfield& field, const Relief& relief, const Patch& patch) {
  const float side = float(kCells) * patch.z;
  const glm::vec2 last(float(field.columns - 1), float(field.rows - 1));
  if (side > kLookedAt || patch.x < 0 || patch.y < 0 || patch.x + side > last.x || patch.y + side > last.y)
    return;
  const glm::uvec2 first(glm::floor(glm::vec2(patch))), end(glm::ceil(glm::vec2(patch) + side));
  const auto [lowest, highest] = lowestAndHighest(field, first, end);
  bounds.low.y = lowest;
  bounds.high.y = highest;
  bounds.steepest = 0;
  for (uint32_t z = first.y / kReliefBlock; z * kReliefBlock < end.y; ++z)
    for (uint32_t x = first.x / kReliefBlock; x * kReliefBlock < end.x; ++x)
      bounds.steepest = std::max(bounds.steepest, relief.slopes[z * relief.blocksAcross + x]);
}

// The least metres across a pixel on it, as shaders/render/terrain.frag takes them.
float leastFootprint(const shared::Picture& b, const Bounds& bounds) {
  const glm::vec3 eye(b.eye), off = eye - glm::clamp(eye, bounds.low, bounds.high);
  // The way to the eye leans off the vertical by at least so much, and the normal by at most so much.
  const float eyes = std::atan2(glm::length(glm::vec2(off.x, off.z)), eye.y - bounds.low.y);
  const float facing = std::cos(std::max(0.0f, eyes - std::atan(bounds.steepest * kHalfRounding)));
  return glm::length(off) * b.eye.w / std::sqrt(std::max(facing, kLeastFacing));
}

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

float Relief::deviationOf(int level) const {
  // Between the triangles of a cell and its bilinear surface lies the twist times x y, with x + y below 1 in
  // each triangle: its square's mean is 1/90. A cell of half the size has a quarter of the twist.
  if (level <= 0) return twist * std::sqrt(1.0f / 90) * std::exp2(2 * float(level));
  if (deviations.empty()) return highest - lowest;
  return deviations[std::min(size_t(level), deviations.size()) - 1];
}

Relief reliefOf(const Heightfield& field) {
  const auto at = [&](uint32_t x, uint32_t z) {
    return double(field.heights[size_t(z) * field.columns + x]);
  };
  const auto [lowest, highest] = std::ranges::minmax(field.heights);
  Relief relief{.lowest = lowest, .highest = highest, .twist = 0, .deviations = {}, .slopes = {}};
  addSlopes(relief, field);
  relief.twist = meanOf(field.columns - 1, field.rows - 1, [&](uint32_t x, uint32_t z) {
    return at(x, z) + at(x + 1, z + 1) - at(x + 1, z) - at(x, z + 1);
  });
  for (uint32_t stride = 2; stride < std::min(field.columns, field.rows); stride *= 2)
    relief.deviations.push_back(
        meanOf((field.columns - 1) / stride * stride, (field.rows - 1) / stride * stride,
               [&](uint32_t x, uint32_t z) { return deviationIn(field, x, z, stride); }));
  return relief;
}

std::vector<Patch> choosePatches(const Composition& composition, const Heightfield& field,
                                 const Relief& relief) {
  return Chooser(composition, field, relief).choose();
}

GroundForm formOf(const Composition& composition, const Heightfield& field, const Relief& relief,
                  const Patch& patch, bool casts) {
  const shared::Picture& b = composition.block;
  Bounds bounds = boundsOf(composition, relief, patch);
  float footprint = leastFootprint(b, bounds);
  if (footprint < kNoClods) {
    tighten(bounds, field, relief, patch);
    footprint = leastFootprint(b, bounds);
  }
  const glm::vec3 eye(b.eye), forward(b.forward);
  const glm::vec3 first = glm::mix(bounds.high, bounds.low, glm::greaterThan(forward, glm::vec3(0)));
  return {.detail = footprint < kNoGrains  ? 2
                    : footprint < kNoClods ? 1
                                           : 0,
          .shaded = casts && glm::dot(first - eye, forward) < kNoShadow * b.forward.w,
          .dense = patch.z <= 1 && patch.z * std::max(b.ground.z, b.ground.w) <= kDenseSpacing};
}

Terrain::Terrain(const Setting& s) : field_(s.terrain), relief_(reliefOf(s.terrain)) {
  using gpu::BindingKind;
  const std::vector<gpu::Binding> list{{shared::DRAW_PICTURE, &s.picture},
                                       {shared::DRAW_HEIGHTS, &s.heights},
                                       {shared::DRAW_GROUND, &s.ground, s.groundSampler},
                                       {shared::DRAW_SHADOW, &s.shadow.image(), s.shadow.sampler()}};
  for (int detail = 0; detail <= GroundForm::kFullDetail; ++detail)
    for (const auto& [shaded, dense] :
         {std::pair{true, true}, {true, false}, {false, true}, {false, false}}) {
      Form& form = forms_[size_t(GroundForm{detail, shaded, dense}.index())];
      std::vector<gpu::SpecConstant> constants = s.lit();
      constants.emplace_back(shared::CONSTANT_DETAIL, detail);
      constants.emplace_back(shared::CONSTANT_SHADED, shaded);
      constants.emplace_back(shared::CONSTANT_DENSE, dense);
      form.pipeline = gpu::GraphicsPipeline(
          s.context, {.name = "ground",
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
                      .constants = constants});
      form.bindings = form.pipeline.bind(s.context, list);
    }

  const std::vector<uint16_t> indices = patchIndices();
  indexCount_ = uint32_t(indices.size());
  indices_ =
      gpu::Buffer(s.context, indices.size() * sizeof(uint16_t), "terrain indices", gpu::BufferUse::index);
  gpu::upload(s.context, indices_, indices);
  patches_ = gpu::Buffer(s.context, kMostPatches * sizeof(Patch), "terrain patches", gpu::BufferUse::vertex);
}

void Terrain::prepare(vk::CommandBuffer cmd, const Composition& composition, bool casts) {
  std::array<std::vector<Patch>, kGroundForms> byForm;
  for (const Patch& patch : choosePatches(composition, field_, relief_))
    byForm[size_t(formOf(composition, field_, relief_, patch, casts).index())].push_back(patch);
  std::vector<Patch> patches;
  for (size_t f = 0; f < byForm.size(); ++f) {
    forms_[f].patches = uint32_t(byForm[f].size());
    patches.insert(patches.end(), byForm[f].begin(), byForm[f].end());
  }
  assert(patches.size() <= kMostPatches);
  if (!patches.empty())
    cmd.updateBuffer(patches_.handle(), 0, patches.size() * sizeof(Patch), patches.data());
}

uint64_t Terrain::triangles() const {
  uint64_t patches = 0;
  for (const Form& form : forms_) patches += form.patches;
  return patches * indexCount_ / 3;
}

void Terrain::draw(vk::CommandBuffer cmd) const {
  vk::DeviceSize first = 0;
  for (const Form& form : forms_) {
    if (form.patches == 0) continue;
    form.pipeline.use(cmd, form.bindings, {});
    cmd.bindVertexBuffers(0, patches_.handle(), first);
    cmd.bindIndexBuffer(indices_.handle(), 0, vk::IndexType::eUint16);
    cmd.drawIndexed(indexCount_, form.patches, 0, 0, 0);
    first += form.patches * sizeof(Patch);
  }
}

}  // namespace skitter::render
