// A textured animal in a picture, held against a renderer in doubles that is written from
// docs/stages/pictures.md alone: its skin is posed, and each pixel's ray meets its triangles.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "gpu/submit.h"
#include "render/shading_reference.h"
#include "skitter/records.h"
#include "skitter/renderer.h"
#include "support/gpu_fixture.h"

namespace skitter::test {
namespace {

constexpr int kWidth = 640, kHeight = 400;
constexpr double kOffSurface =
    0.008;                          // metres: three texels of the near cascade, 5.4 m wide with 2048 texels
constexpr double kPenumbra = 0.02;  // metres within which the map's texels and squares may blur a shadow
const glm::dvec3 kSun = glm::normalize(glm::dvec3(0.62, 0.62, 0.40));

glm::dvec3 turnedBy(const glm::dvec4& q, const glm::dvec3& v) {
  const glm::dvec3 twice = 2.0 * glm::cross(glm::dvec3(q), v);
  return v + q.w * twice + glm::cross(glm::dvec3(q), twice);
}

struct Corner {
  glm::dvec3 position{0}, normal{0}, tangent{0}, colour{0};
  double open = 0, opacity = 0;
  glm::dvec2 uv{0};
};
Corner mixed(const std::array<Corner, 3>& corners, const glm::dvec3& shares) {
  Corner sum;
  for (size_t k = 0; k < 3; ++k) {
    const double share = shares[int(k)];
    sum.position += share * corners[k].position;
    sum.normal += share * corners[k].normal;
    sum.tangent += share * corners[k].tangent;
    sum.colour += share * corners[k].colour;
    sum.open += share * corners[k].open;
    sum.opacity += share * corners[k].opacity;
    sum.uv += share * corners[k].uv;
  }
  return sum;
}

struct Triangle {
  std::array<Corner, 3> corners;
  double side;  // of its tangents
  const Material* material;

  glm::dvec3 facing() const {
    return glm::cross(corners[1].position - corners[0].position, corners[2].position - corners[0].position);
  }
};

struct Hit {
  double distance = std::numeric_limits<double>::infinity();
  const Triangle* triangle = nullptr;
  glm::dvec3 shares{0};
  glm::dvec2 lit{1};  // the least and the most sunlight there
};

// Where a ray meets a triangle (Moeller and Trumbore, 1997).
std::optional<Hit> meet(const glm::dvec3& from, const glm::dvec3& along, const Triangle& triangle) {
  const glm::dvec3 a = triangle.corners[1].position - triangle.corners[0].position,
                   b = triangle.corners[2].position - triangle.corners[0].position, p = glm::cross(along, b);
  const double determinant = glm::dot(a, p);
  if (std::abs(determinant) < 1e-14) return {};
  const glm::dvec3 to = from - triangle.corners[0].position, q = glm::cross(to, a);
  const double u = glm::dot(to, p) / determinant, v = glm::dot(along, q) / determinant,
               distance = glm::dot(b, q) / determinant;
  if (u < 0 || v < 0 || u + v > 1 || distance <= 1e-6) return {};
  return Hit{.distance = distance, .triangle = &triangle, .shares = {1 - u - v, u, v}};
}

// The first agent of a herd as it stands, seen through textures that have no levels and are not filtered.
class Animal {
 public:
  Animal(const Rig& rig, const HerdState& state) : materials_(*rig.look.materials) {
    for (const ImageFile& file : materials_.images) images_.push_back(decodeImage(file));
    const glm::dvec3 body(shared::tileX(state.body[3]) * double(shared::TILE_SIZE) + double(state.body[0]),
                          state.body[1],
                          shared::tileZ(state.body[3]) * double(shared::TILE_SIZE) + double(state.body[2]));
    const std::vector<glm::vec3> starts = rig.restStarts();
    std::vector<Corner> skin;
    for (size_t v = 0; v < rig.vertices.size(); ++v)
      skin.push_back(posed(rig.vertices[v], rig.look.vertices[v], starts, state.pose, body));
    for (size_t i = 0; i + 2 < rig.indices.size(); i += 3) {
      const MaterialVertex& first = rig.look.vertices[rig.indices[i]];
      triangles_.push_back({{skin[rig.indices[i]], skin[rig.indices[i + 1]], skin[rig.indices[i + 2]]},
                            double(first.tangent.w),
                            &materials_.list[first.material]});
    }
    sortUnderSun();
  }

  // What a ray from the eye sees: fronts, what is seen from both sides, and no holes.
  void see(const glm::dvec3& eye, const glm::dvec3& along, const Triangle& triangle, Hit& nearest) const {
    if (!triangle.material->doubleSided && glm::dot(triangle.facing(), along) > 0) return;
    const std::optional<Hit> hit = meet(eye, along, triangle);
    if (hit && hit->distance < nearest.distance && isSolid(*hit)) nearest = *hit;
  }

  // sRGB codes of a hit, the least and the most of what penumbras may make of it. `without` leaves a texture
  // out, as if the material had none.
  std::array<glm::dvec3, 2> codesAt(const Hit& hit, const glm::dvec3& eye,
                                    std::optional<TextureRole> without) const {
    const Corner at = mixed(hit.triangle->corners, hit.shares);
    const Material& m = *hit.triangle->material;
    const auto texel = [&](TextureRole role) {
      return role == without ? std::optional<glm::dvec4>() : looked(m.texture(role), at.uv);
    };
    const auto light = [](const glm::dvec4& t) {
      return glm::dvec3(decodedSrgb(t.r), decodedSrgb(t.g), decodedSrgb(t.b));
    };
    const glm::dvec4 white(255), surface = texel(TextureRole::metallicRoughness).value_or(white) / 255.0;
    const double red = texel(TextureRole::occlusion).value_or(white).r / 255;
    ShadedPoint point;
    point.toEye = glm::normalize(eye - at.position);
    point.toSun = kSun;
    // A tint of 0 is the mean of what agents have by number.
    point.colour = 1.05 * at.colour * light(texel(TextureRole::baseColour).value_or(white));
    point.metallic = double(m.metallic) * surface.b;
    point.roughness = double(m.roughness) * surface.g;
    point.open = at.open * (1 + double(m.occlusionStrength) * (red - 1));
    point.glow = glm::dvec3(m.emissive) * light(texel(TextureRole::emissive).value_or(white));
    const glm::dvec3 outward = glm::normalize(at.normal);
    const double side = glm::dot(hit.triangle->facing(), point.toEye) > 0 ? 1 : -1;
    const std::optional<glm::dvec4> bump = texel(TextureRole::normal);
    point.normal = side * (bump ? bentBy(glm::dvec3(*bump), outward, at.tangent, hit.triangle->side,
                                         double(m.normalScale))
                                : outward);
    const auto codes = [&](double lit) {
      point.lit = lit;
      const glm::dvec3 shown = developedLight(lightOf(point));
      return glm::dvec3(encodedSrgb(shown.r), encodedSrgb(shown.g), encodedSrgb(shown.b));
    };
    return {codes(hit.lit.x), codes(hit.lit.y)};
  }

  // The least and the most sunlight of points about a hit.
  glm::dvec2 litAt(const Hit& hit, const glm::dvec3& eye) const {
    const Corner at = mixed(hit.triangle->corners, hit.shares);
    const double side = glm::dot(hit.triangle->facing(), eye - at.position) > 0 ? 1 : -1;
    const glm::dvec3 point = at.position + kOffSurface * side * glm::normalize(at.normal);
    glm::dvec2 range(isLit(point) ? 1 : 0);
    for (const double radius : {0.4 * kPenumbra, kPenumbra})
      for (int k = 0; k < 8; ++k) {
        const double angle = k * 0.7853981634;
        const glm::dvec3 beside =
            radius * (std::cos(angle) * across_ + std::sin(angle) * glm::cross(kSun, across_));
        const double lit = isLit(point + beside) ? 1 : 0;
        range = {std::min(range.x, lit), std::max(range.y, lit)};
      }
    return range;
  }

  const std::vector<Triangle>& triangles() const { return triangles_; }

 private:
  Corner posed(const SkinVertex& skin, const MaterialVertex& worn, const std::vector<glm::vec3>& starts,
               const std::vector<float>& pose, const glm::dvec3& body) const {
    Corner corner;
    for (size_t k = 0; k < 4; ++k) {
      const double weight = double(skin.weights[k]);
      if (weight <= 0) continue;
      const float* entry = &pose[size_t(skin.bones[k]) * 8];
      const glm::dvec4 turn(entry[0], entry[1], entry[2], entry[3]);
      const glm::dvec3 start(entry[4], entry[5], entry[6]);
      corner.position +=
          weight * (start + turnedBy(turn, glm::dvec3(skin.position) - glm::dvec3(starts[skin.bones[k]])));
      corner.normal += weight * turnedBy(turn, glm::dvec3(skin.normal));
      corner.tangent += weight * turnedBy(turn, glm::dvec3(worn.tangent));
    }
    // Level ground sees all of the sky; what is lower than the body sees less of it.
    corner.open = std::clamp(0.45 + 1.1 * corner.position.y, 0.3, 1.0);
    corner.position += body;
    corner.colour = glm::dvec3(skin.colour);
    corner.opacity = double(worn.opacity);
    corner.uv = glm::dvec2(worn.uv[0]);
    return corner;
  }

  // The texel, 0 to 255. Images repeat in u and end in v, as the file's sampler says.
  std::optional<glm::dvec4> looked(const Texture& texture, const glm::dvec2& uv) const {
    if (texture.image == -1) return {};
    const Texels& image = images_[size_t(texture.image)];
    const auto x = size_t(std::min((uv.x - std::floor(uv.x)) * image.width, image.width - 1.0));
    const auto y = size_t(std::clamp(std::floor(uv.y * image.height), 0.0, image.height - 1.0));
    const uint8_t* t = &image.rgba[4 * (y * image.width + x)];
    return glm::dvec4(t[0], t[1], t[2], t[3]);
  }

  bool isSolid(const Hit& hit) const {
    const Material& material = *hit.triangle->material;
    if (material.alphaCutoff == 0) return true;
    const Corner at = mixed(hit.triangle->corners, hit.shares);
    const glm::dvec4 base =
        looked(material.texture(TextureRole::baseColour), at.uv).value_or(glm::dvec4(255));
    return at.opacity * base.a / 255 >= double(material.alphaCutoff);
  }

  // Triangles by the cells of a plane across the sunlight.
  static constexpr int kCells = 64;
  glm::dvec2 underSun(const glm::dvec3& p) const {
    return (glm::dvec2(glm::dot(p, across_), glm::dot(p, glm::cross(kSun, across_))) - least_) / cell_;
  }
  void sortUnderSun() {
    glm::dvec2 most(-1e30);
    least_ = glm::dvec2(1e30);
    const glm::dvec3 up = glm::cross(kSun, across_);
    for (const Triangle& triangle : triangles_)
      for (const Corner& corner : triangle.corners) {
        const glm::dvec2 at(glm::dot(corner.position, across_), glm::dot(corner.position, up));
        least_ = glm::min(least_, at);
        most = glm::max(most, at);
      }
    cell_ = (most - least_) * 1.0001 / double(kCells);
    cells_.resize(size_t(kCells) * kCells);
    for (const Triangle& triangle : triangles_) {
      const glm::dvec2 a = underSun(triangle.corners[0].position), b = underSun(triangle.corners[1].position),
                       c = underSun(triangle.corners[2].position);
      const glm::ivec2 from(glm::min(a, glm::min(b, c))), to(glm::max(a, glm::max(b, c)));
      for (int y = from.y; y <= to.y; ++y)
        for (int x = from.x; x <= to.x; ++x) cells_[size_t(y * kCells + x)].push_back(&triangle);
    }
  }
  bool isLit(const glm::dvec3& point) const {
    const glm::ivec2 cell(glm::floor(underSun(point)));
    if (cell.x < 0 || cell.y < 0 || cell.x >= kCells || cell.y >= kCells) return true;
    for (const Triangle* triangle : cells_[size_t(cell.y * kCells + cell.x)]) {
      const std::optional<Hit> hit = meet(point, kSun, *triangle);
      if (hit && isSolid(*hit)) return false;
    }
    return true;
  }

  const Materials& materials_;
  std::vector<Texels> images_;
  std::vector<Triangle> triangles_;
  const glm::dvec3 across_ = glm::normalize(glm::cross(glm::dvec3(0, 0, 1), kSun));
  glm::dvec2 least_{0}, cell_{1};
  std::vector<std::vector<const Triangle*>> cells_;
};

// A camera in doubles.
struct Lens {
  glm::dvec3 eye, forward, right, up;
  double tanX, tanY;

  explicit Lens(const View& view)
      : eye(view.eye),
        forward(glm::normalize(glm::dvec3(view.target) - eye)),
        right(glm::normalize(glm::cross(forward, glm::dvec3(0, 1, 0)))),
        up(glm::cross(right, forward)),
        tanX(std::tan(double(view.fieldOfView) / 2) * kWidth / kHeight),
        tanY(std::tan(double(view.fieldOfView) / 2)) {}

  glm::dvec3 along(int x, int y) const {
    return glm::normalize(forward + right * (tanX * (2 * (x + 0.5) / kWidth - 1)) +
                          up * (tanY * (1 - 2 * (y + 0.5) / kHeight)));
  }
  glm::dvec2 pixelOf(const glm::dvec3& point) const {
    const glm::dvec3 to = (point - eye) / glm::dot(point - eye, forward);
    return {kWidth * 0.5 * (1 + glm::dot(to, right) / tanX), kHeight * 0.5 * (1 - glm::dot(to, up) / tanY)};
  }
};

std::vector<Hit> seenBy(const Lens& lens, const Animal& animal) {
  std::vector<Hit> hits(size_t(kWidth) * kHeight);
  for (const Triangle& triangle : animal.triangles()) {
    glm::dvec2 least(1e9), most(-1e9);
    for (const Corner& corner : triangle.corners) {
      least = glm::min(least, lens.pixelOf(corner.position));
      most = glm::max(most, lens.pixelOf(corner.position));
    }
    const glm::ivec2 from(glm::max(glm::floor(least), glm::dvec2(0))),
        to(glm::min(glm::ceil(most), glm::dvec2(kWidth - 1, kHeight - 1)));
    for (int y = from.y; y <= to.y; ++y)
      for (int x = from.x; x <= to.x; ++x)
        animal.see(lens.eye, lens.along(x, y), triangle, hits[size_t(y * kWidth + x)]);
  }
  for (Hit& hit : hits)
    if (hit.triangle != nullptr) hit.lit = animal.litAt(hit, lens.eye);
  return hits;
}

struct Tally {
  int compared = 0, sharp = 0, off = 0;
};

// Devices smooth edges, by samples or by a filter, so a pixel lies between those about it. Where these are
// alike, it is held sharply. A picture of roots in bytes is off by a code, and its sRGB by half of one; haze
// at 2.2 m takes (2.2 / 95)^2, which is a code at most; positions and textures are float32.
Tally tallyOf(const Animal& animal, const Lens& lens, const std::vector<Hit>& hits,
              const std::vector<uint8_t>& picture, std::optional<TextureRole> without) {
  constexpr double tolerance = 3;  // codes
  constexpr int step = 3;          // pixels: each is of one comparison
  Tally tally;
  for (int y = 1; y + 1 < kHeight; y += step)
    for (int x = 1; x + 1 < kWidth; x += step) {
      glm::dvec3 least(1e9), most(-1e9);
      bool whole = true;
      for (int k = 0; k < 9 && whole; ++k) {
        const Hit& hit = hits[size_t((y + k / 3 - 1) * kWidth + x + k % 3 - 1)];
        whole = hit.triangle != nullptr;
        if (!whole) break;
        for (const glm::dvec3& codes : animal.codesAt(hit, lens.eye, without)) {
          least = glm::min(least, codes);
          most = glm::max(most, codes);
        }
      }
      if (!whole) continue;
      ++tally.compared;
      tally.sharp += glm::all(glm::lessThan(most - least, glm::dvec3(16)));
      const uint8_t* found = &picture[size_t(y * kWidth + x) * 4];
      bool fits = true;
      for (int k = 0; k < 3; ++k)
        fits = fits && found[k] >= least[k] - tolerance && found[k] <= most[k] + tolerance;
      tally.off += !fits;
    }
  return tally;
}

class TexturedModelTest : public GpuTest {};

TEST_F(TexturedModelTest, IsAsTheReferenceDrawsIt) {
  Rig rig = loadRig(SKITTER_ASSETS "/piebald.glb");
  Materials materials = *rig.look.materials;
  for (Material& material : materials.list)
    for (Texture& texture : material.textures) {
      texture.sampler.magNearest = texture.sampler.minNearest = true;
      texture.sampler.mips = TextureSampler::Mips::none;
    }
  rig.look.materials = std::make_shared<const Materials>(materials);

  Scene scene = builtinScene();
  scene.herds.resize(1);
  scene.herds[0].agents = 1;
  scene.herds[0].tint = 0.0f;
  scene.herds[0].spawn = {.kind = Spawn::Kind::grid, .spacing = 2, .heading = 0.3f};
  scene.herds[0].goal = {.kind = Goal::Kind::none};
  const Heightfield ground = generateHeightfield({.columns = 65, .rows = 65, .amplitude = 0});
  Crowd crowd(device(), ground, scene, {.rigs = {rig}});
  for (int tick = 0; tick < 20; ++tick)
    gpu::submitAndWait(context(), [&](vk::CommandBuffer cmd) { crowd.record(cmd, 1.0f / 60); });
  const HerdState state = crowd.download(0);
  ASSERT_EQ(state.pose.size(), size_t(rig.paletteSize()) * 8);
  const Animal animal(rig, state);

  View view;
  view.target = {shared::tileX(state.body[3]) * shared::TILE_SIZE + state.body[0], state.body[1],
                 shared::tileZ(state.body[3]) * shared::TILE_SIZE + state.body[2]};
  view.eye = view.target + glm::vec3(1.7f, 0.75f, 1.2f);
  view.fieldOfView = 0.5f;
  Renderer renderer(device(), crowd, kWidth, kHeight);
  gpu::submitAndWait(context(), [&](vk::CommandBuffer cmd) { renderer.record(cmd, view); });
  const std::vector<uint8_t> picture = renderer.download();

  const Lens lens(view);
  const std::vector<Hit> hits = seenBy(lens, animal);
  const Tally tally = tallyOf(animal, lens, hits, picture, {});
  EXPECT_GT(tally.compared, 2000);
  EXPECT_GT(tally.sharp, tally.compared / 16);
  // A shadow's map may be coarser than the penumbra allows for in a few places.
  EXPECT_LE(tally.off, tally.compared / 200) << "of " << tally.compared << ", sharp " << tally.sharp;
  // A texture that was not drawn would be seen.
  for (const TextureRole role :
       {TextureRole::baseColour, TextureRole::metallicRoughness, TextureRole::normal, TextureRole::occlusion})
    EXPECT_GT(tallyOf(animal, lens, hits, picture, role).off, tally.compared / 50) << nameOf(role);
}

}  // namespace
}  // namespace skitter::test
