// Agents that are a few pixels large: their shapes against the skin, and what is drawn against the poses,
// projected in doubles.
#include "render/splats.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/gtc/quaternion.hpp>
#include <numbers>
#include <tuple>

#include "crowd/radius.h"
#include "gpu/submit.h"
#include "gpu/transfer.h"
#include "render/composition.h"
#include "render/ground_map.h"
#include "render/mesh.h"
#include "render/sight.h"
#include "render/splat_parts.h"
#include "skitter/records.h"
#include "skitter/renderer.h"
#include "support/gpu_fixture.h"

namespace skitter::render {
namespace {

using test::Sight;

double distanceToSegment(const glm::dvec3& point, const glm::dvec3& from, const glm::dvec3& to,
                         double& share) {
  const glm::dvec3 along = to - from;
  share = std::clamp(glm::dot(point - from, along) / std::max(glm::dot(along, along), 1e-12), 0.0, 1.0);
  return glm::distance(point, from + share * along);
}

// By the first vec4 of a body record.
glm::dvec3 placeOf(const glm::vec4& body) {
  return glm::dvec3(body) +
         double(shared::TILE_SIZE) * glm::dvec3(shared::tileX(body.w), 0, shared::tileZ(body.w));
}

// A model, and where the entries of its palette start as its skin was bound.
struct Bound {
  std::string name;
  Limbs limbs;
  double radius;
  std::vector<glm::vec3> starts;
};

Bound boundOf(const std::string& name, const Rig& rig) {
  return {name, limbsOf(rig), double(crowd::radiusOf(rig)), rig.restStarts()};
}

std::vector<Bound> boundModels() {
  const ClipSet clips = spiderClips();
  return {boundOf("spider", spiderRig()),
          boundOf("quadruped", loadRig(SKITTER_ASSETS "/quadruped.glb")),
          {"spider with clips", limbsOf(clips), double(crowd::radiusOf(clips)),
           std::vector<glm::vec3>(clips.joints.size())}};
}

// At rest the skin lies about the shapes: on the whole within a fiftieth of the agent's radius.
TEST(SplatParts, FollowTheSkin) {
  for (const auto& [name, limbs, radius, starts] : boundModels()) {
    SCOPED_TRACE(name);
    const Rig& rig = limbs.rig;
    const std::vector<shared::SplatPart> parts = splatPartsOf(limbs, float(radius) / 25);
    ASSERT_GE(parts.size(), rig.legs.size() + 2);
    EXPECT_LE(parts.size(), rig.legs.size() * size_t(rig.maxBones()) + 12);
    double sum = 0, most = 0;
    for (const SkinVertex& vertex : rig.vertices) {
      double least = 1e9;
      for (const shared::SplatPart& part : parts) {
        ASSERT_LT(part.colourFrom.w, float(starts.size()));
        ASSERT_LT(part.colourTo.w, float(starts.size()));
        double share = 0;
        const double away =
            distanceToSegment(vertex.position, starts[size_t(part.colourFrom.w)] + glm::vec3(part.from),
                              starts[size_t(part.colourTo.w)] + glm::vec3(part.to), share);
        least = std::min(least, std::abs(away - std::lerp(double(part.from.w), double(part.to.w), share)));
      }
      sum += least;
      most = std::max(most, least);
    }
    EXPECT_LT(sum / double(rig.vertices.size()), radius / 50);
    EXPECT_LT(most, radius / 7);
  }
}

// A triangle is the body's where a vertex hangs on it most.
TEST(SplatParts, BallsHaveTheBodysArea) {
  for (const Bound& model : boundModels()) {
    SCOPED_TRACE(model.name);
    const Rig& rig = model.limbs.rig;
    const auto hangsOnBody = [](const SkinVertex& v) {
      return v.bones[std::max_element(v.weights, v.weights + 4) - v.weights] == 0;
    };
    double area = 0, balls = 0;
    for (size_t i = 0; i < rig.indices.size(); i += 3) {
      const SkinVertex &a = rig.vertices[rig.indices[i]], &b = rig.vertices[rig.indices[i + 1]],
                       &c = rig.vertices[rig.indices[i + 2]];
      if (hangsOnBody(a) || hangsOnBody(b) || hangsOnBody(c))
        area += 0.5 * double(glm::length(glm::cross(b.position - a.position, c.position - a.position)));
    }
    for (const shared::SplatPart& part : splatPartsOf(model.limbs, 0.05f))
      if (part.from == part.to) balls += 4 * std::numbers::pi * double(part.from.w * part.from.w);
    EXPECT_NEAR(balls, area, 1e-4 * area);
  }
}

// The built-in spider's clips move the joints of its rig, so its parts are the same, each carried by its
// joint.
TEST(SplatParts, OfClipsHangOnTheirJoints) {
  const Rig rig = spiderRig();
  const ClipSet set = spiderClips();
  const std::vector<glm::vec3> starts = rig.restStarts();
  const std::vector<shared::SplatPart> parts = splatPartsOf(limbsOf(rig), 0.05f),
                                       ofClips = splatPartsOf(limbsOf(set), 0.05f);
  ASSERT_EQ(ofClips.size(), parts.size());
  size_t onLegs = 0;
  for (size_t i = 0; i < parts.size(); ++i) {
    for (const auto& [end, entry, joint, ofClip] :
         {std::tuple(parts[i].from, parts[i].colourFrom.w, ofClips[i].colourFrom.w, ofClips[i].from),
          {parts[i].to, parts[i].colourTo.w, ofClips[i].colourTo.w, ofClips[i].to}}) {
      EXPECT_LT(glm::distance(glm::vec3(end) + starts[size_t(entry)], glm::vec3(ofClip)), 1e-4f) << i;
      EXPECT_NEAR(end.w, ofClip.w, 1e-4f) << i;
      const ClipJoint& carrier = set.joints[size_t(joint)];
      const int bone = int(entry) - 1;
      EXPECT_EQ(carrier.leg, entry == 0 ? -1 : bone / rig.maxBones()) << i;
      EXPECT_EQ(carrier.bone, entry == 0 ? -1 : bone % rig.maxBones()) << i;
      onLegs += entry != 0;
    }
  }
  EXPECT_GE(onLegs, 2 * rig.legs.size());
}

// A ball moves with the joint that most of its skin hangs on: here the end of a tail, which is no leg.
TEST(SplatParts, OfATailMoveWithIt) {
  ClipSet set = spiderClips();
  const auto tail = uint16_t(set.joints.size());
  set.joints.push_back({.name = "tail"});
  const auto first = uint32_t(set.vertices.size());
  for (const glm::vec3& at : {glm::vec3(0, 1, -3), {0.2f, 1, -3}, {0, 1.2f, -3}}) {
    SkinVertex& vertex = set.vertices.emplace_back();
    vertex.position = at;
    vertex.bones[0] = tail;
  }
  set.indices.insert(set.indices.end(), {first, first + 1, first + 2});
  size_t found = 0;
  for (const shared::SplatPart& part : splatPartsOf(limbsOf(set), 0.05f)) {
    EXPECT_EQ(part.from.z < -2.9f, part.colourFrom.w == float(tail));
    found += part.colourFrom.w == float(tail);
  }
  EXPECT_EQ(found, 1u);
}

TEST(SplatParts, AreNoneOfASkinless) {
  Rig rig = spiderRig();
  rig.vertices.clear();
  rig.indices.clear();
  EXPECT_TRUE(splatPartsOf(limbsOf(rig), 0.1f).empty());
}

constexpr uint32_t kWidth = 203, kHeight = 131;  // no whole squares
constexpr double kShadeLift = 2;                 // pixels towards the eye

struct Splat {
  double depth;  // metres ahead
  uint32_t low;
};

// What the shader's numbers mean (shaders/render/splat.glsl), told anew.
std::optional<Splat> unpacked(uint32_t splat) {
  if (splat == 0) return {};
  const uint32_t depth = splat >> 16, exponent = depth >> 12, mantissa = depth & 4095;
  return Splat{0.05 / (std::ldexp(1 + mantissa / 4096.0, int(exponent) - 16)), splat & 65535};
}

class SplatTest : public test::GpuLoadTest {
 protected:
  struct Drawn {
    std::vector<uint32_t> splats, shades, tiles;
    std::vector<glm::vec4> bodies, poses;
    glm::vec3 towardsSun;
    bool inHugePictures = true;  // there are splats in them
  };

  static Heightfield level() {
    return {.name = "level",
            .columns = 33,
            .rows = 33,
            .spacingX = 4,
            .spacingZ = 4,
            .heights = std::vector<float>(33 * 33, 0.0f)};
  }
  Scene scene(uint32_t agents) {
    Scene made;
    made.terrain = TerrainNoise{.columns = 33, .rows = 33, .spacing = 4, .amplitude = 0};
    made.herds.resize(1);
    made.herds[0].agents = agents;
    made.herds[0].spawn = {.kind = Spawn::Kind::grid, .spacing = 3};
    return made;
  }

  static uint32_t paletteOf(const crowd::Kind& kind) {
    return uint32_t(kind.clipSet.joints.empty() ? kind.rig.paletteSize() : int(kind.clipSet.joints.size()));
  }

  void walk(Crowd& crowd) {
    for (int i = 0; i < 20; ++i) device().run([&](VkCommandBuffer cmd) { crowd.record(cmd, 1.0f / 60); });
  }

  // One agent that stands.
  struct Standing {
    SplatTest& test;
    Crowd crowd;
    glm::dvec3 at;

    Standing(SplatTest& from, const Heightfield& ground, const Scene& made)
        : test(from), crowd(from.device(), ground, made) {
      test.walk(crowd);
      at = placeOf(gpu::download<glm::vec4>(test.context(), implOf(crowd).kinds[0].pages[0].body)[0]);
    }
    // Seen from the sun, so that its radius has so many pixels of a picture 200 pixels high.
    std::vector<uint8_t> picture(Renderer& by, double pixels) const {
      const double radius = double(crowd::radiusOf(implOf(crowd).kinds.front().rig));
      const double away = radius * 200 / (2 * std::tan(0.15)) / pixels;
      const glm::dvec3 eye = at + away * glm::normalize(glm::dvec3(0.6, 0.5, 0.7));
      test.device().run([&](VkCommandBuffer cmd) {
        by.record(cmd, {.eye = glm::vec3(eye), .target = glm::vec3(at), .fieldOfView = 0.3f});
      });
      return by.download();
    }
  };

  // `shade` is the depth of all that casts shadows: 1 is nothing, 0 is something between everybody and the
  // sun.
  Drawn draw(const Scene& made, const View& view, float shade = 1, float detail = 1) {
    const Heightfield ground = level();
    Crowd crowd(device(), ground, made);
    walk(crowd);
    const Crowd::Impl& impl = implOf(crowd);
    const LightModel light = lightModel(made.light);
    const gpu::Buffer picture(context(), sizeof(shared::Picture), "picture", gpu::BufferUse::uniform);
    const gpu::Image map = makeGroundMap(context(), ground, glm::vec3(light.towards));
    const vk::raii::Sampler sampler = gpu::makeSampler(context(), {.name = "ground map"});
    const ShadowMap shadow(context(), kHeight, 1);
    const Setting setting{.context = context(),
                          .terrain = ground,
                          .heights = impl.heights,
                          .picture = picture,
                          .ground = map,
                          .groundSampler = *sampler,
                          .shadow = shadow,
                          .colour = vk::Format::eR8G8B8A8Unorm,
                          .depth = vk::Format::eD32Sfloat,
                          .samples = vk::SampleCountFlagBits::e1,
                          .extent = {kWidth, kHeight},
                          .light = lightConstants(light),
                          .detail = detail};
    const Composition composition = compose(view, light, ground, 0, 0, kWidth, kHeight, shadow.texels());
    gpu::upload(context(), picture, std::span(&composition.block, 1));
    const crowd::Kind& kind = impl.kinds.front();
    const crowd::Page& page = kind.pages.front();
    const float radius = crowd::radiusOf(kind);
    const Cull cull(context(), detail);
    const CulledPage culled = cull.makePage(context(), picture, page.body, page.agents);
    const Splats splats(setting);
    const Splats::Kind look = splats.makeKind(setting, kind, limbsOf(kind), radius);
    const gpu::Bindings bindings =
        splats.bind(setting, look, page.body, page.pose, kind.tinted ? page.tint : page.body, culled);
    std::vector<ListDispatch> commands(shared::INSTANCE_LISTS);
    gpu::upload(context(), culled.commands, commands);
    gpu::submitAndWait(context(), [&](vk::CommandBuffer cmd) {
      gpu::transition(cmd, shadow.image(), gpu::ImageState::discard, gpu::ImageState::depth);
      {
        const gpu::Rendering clear(cmd, {.depth = &shadow.image(), .depthClear = shade, .keepDepth = true},
                                   false);
      }
      gpu::transition(cmd, shadow.image(), gpu::ImageState::depth, gpu::ImageState::sampled);
      splats.prepare(cmd);
      gpu::transferToCompute(cmd);
      cull.record(cmd, culled, radius, true);
      gpu::computeToIndirectAndCompute(cmd);
      splats.record(cmd, look, bindings, culled,
                    {.view = 0, .palette = paletteOf(kind), .firstAgent = 0, .kind = 0});
      gpu::allToAll(cmd);
    });
    Drawn drawn;
    Setting huge = setting;
    huge.extent = vk::Extent2D{65536, 16384};  // 8 GiB of numbers, beyond any binding
    const Splats none(huge);
    drawn.inHugePictures = bool(none) || bool(none.makeKind(huge, kind, limbsOf(kind), radius));
    drawn.splats = gpu::download<uint32_t>(context(), splats.splats());
    drawn.shades.assign(drawn.splats.begin() + kWidth * kHeight, drawn.splats.end());
    drawn.splats.resize(kWidth * kHeight);
    drawn.tiles = gpu::download<uint32_t>(context(), splats.tiles());
    drawn.bodies = gpu::download<glm::vec4>(context(), page.body);
    drawn.poses = gpu::download<glm::vec4>(context(), page.pose);
    drawn.towardsSun = light.towards;
    return drawn;
  }
};
INSTANTIATE_TEST_SUITE_P(Loads, SplatTest, test::bothLoadPaths(), test::loadPathName);

// A capsule in the picture: pixels from the upper left corner, metres ahead, radii in pixels.
struct Stroke {
  glm::dvec3 from, to;
  double radiusFrom, radiusTo;
};

// The strokes that agents of these poses are, and those of their shadows on level ground at height 0.
struct Strokes {
  std::vector<Stroke> agents, shades;
};

// Where a part's end is, relative to its agent, whose poses begin there.
using EndOf = std::function<glm::dvec3(const glm::vec4* poses, const glm::vec4& end, float entry)>;

glm::dvec3 turnedByRotation(const glm::vec4* poses, const glm::vec4& end, float entry) {
  const glm::vec4* record = poses + size_t(entry) * size_t(shared::POSE_STRIDE);
  const glm::dvec4 q = record[0];
  return glm::dvec3(record[1]) + glm::dquat(q.w, q.x, q.y, q.z) * glm::dvec3(end);
}

glm::dvec3 movedByMatrix(const glm::vec4* poses, const glm::vec4& end, float entry) {
  const glm::vec4* rows = poses + size_t(entry) * size_t(shared::MATRIX_STRIDE);
  const glm::dvec4 at(glm::dvec3(end), 1);
  return {glm::dot(glm::dvec4(rows[0]), at), glm::dot(glm::dvec4(rows[1]), at),
          glm::dot(glm::dvec4(rows[2]), at)};
}

Strokes strokesOf(const std::vector<shared::SplatPart>& parts, const EndOf& endOf, const View& view,
                  const std::vector<glm::vec4>& bodies, const std::vector<glm::vec4>& poses, uint32_t agents,
                  const glm::dvec3& sun) {
  const Sight sight(view, kWidth, kHeight);
  const double pixel = 2 * sight.tanY / kHeight;
  const auto seen = [&](const glm::dvec3& p) {
    const glm::dvec3 to = p - sight.eye;
    const double ahead = glm::dot(to, sight.forward);
    return glm::dvec3((0.5 + 0.5 * glm::dot(to, sight.right) / (ahead * sight.tanX)) * kWidth,
                      (0.5 - 0.5 * glm::dot(to, sight.up) / (ahead * sight.tanY)) * kHeight, ahead);
  };
  Strokes made;
  for (uint32_t agent = 0; agent < agents; ++agent) {
    const glm::dvec3 at = placeOf(bodies[agent * shared::BODY_STRIDE]);
    const double away = glm::distance(at, sight.eye);
    const glm::dvec3 lift = (sight.eye - at) / away * (0.012 + kShadeLift * pixel * away);
    const auto posed = [&](const glm::vec4& end, float entry) {
      return at + endOf(&poses[agent * poses.size() / agents], end, entry);
    };
    for (const shared::SplatPart& part : parts) {
      const glm::dvec3 from = posed(part.from, part.colourFrom.w), to = posed(part.to, part.colourTo.w);
      const double a = double(part.from.w) / (pixel * away), b = double(part.to.w) / (pixel * away);
      made.agents.push_back({seen(from), seen(to), a, b});
      const auto shade = [&](const glm::dvec3& p) { return seen(p - p.y / sun.y * sun + lift); };
      made.shades.push_back({shade(from), shade(to), a, b});
    }
  }
  return made;
}

// Each pixel lies on a stroke with its depth, and each stroke's middle line has pixels, of itself or of what
// is nearer.
void expectDrawn(const std::vector<uint32_t>& pixels, const std::vector<Stroke>& strokes) {
  size_t drawn = 0, missing = 0;
  for (uint32_t y = 0; y < kHeight; ++y)
    for (uint32_t x = 0; x < kWidth; ++x) {
      const auto splat = unpacked(pixels[y * kWidth + x]);
      if (!splat) continue;
      ++drawn;
      const bool on = std::ranges::any_of(strokes, [&](const Stroke& s) {
        double share = 0;
        const double off =
            distanceToSegment({x + 0.5, y + 0.5, 0}, {s.from.x, s.from.y, 0}, {s.to.x, s.to.y, 0}, share);
        // A pixel that a thin stroke passes is up to 0.71 pixels from it; depth is that of a step as long as
        // half the radius, to a 4096th.
        const double depth = std::lerp(s.from.z, s.to.z, share);
        const double steep = std::abs(s.to.z - s.from.z);
        return off <= std::max(0.72, std::max(s.radiusFrom, s.radiusTo)) + 0.01 &&
               std::abs(splat->depth - depth) < depth / 2000 + steep;
      });
      EXPECT_TRUE(on) << "pixel " << x << ", " << y;
    }
  for (const Stroke& s : strokes)
    for (const double t : {0.1, 0.5, 0.9}) {
      const glm::dvec3 p = glm::mix(s.from, s.to, t);
      if (p.x < 1 || p.y < 1 || p.x >= kWidth - 1 || p.y >= kHeight - 1) continue;
      bool found = false;
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
          const auto splat = unpacked(pixels[size_t(int(p.y) + dy) * kWidth + size_t(int(p.x) + dx)]);
          found = found || (splat && splat->depth < p.z * (1 + 1.0 / 2000) + std::abs(s.to.z - s.from.z));
        }
      missing += !found;
    }
  EXPECT_GT(drawn, 100u);
  EXPECT_EQ(missing, 0u);
}

void expectMarked(const std::vector<uint32_t>& tiles, const std::vector<uint32_t>& pixels) {
  const uint32_t across = (kWidth + 31) / 32;
  for (uint32_t y = 0; y < kHeight; ++y)
    for (uint32_t x = 0; x < kWidth; ++x)
      if (pixels[y * kWidth + x] != 0) {
        ASSERT_NE(tiles[y / 32 * across + x / 32], 0u) << "pixel " << x << ", " << y;
      }
}

// Spiders of some 9 pixels' radius, some beyond the picture's edges.
const View kFar{.eye = {-9, 14, -12}, .target = {0, 0, 1}, .fieldOfView = 0.9f};

TEST_P(SplatTest, AreWhereThePosesAre) {
  constexpr uint32_t agents = 150;  // more than a work group
  for (const Controller controller : {Controller::adaptive, Controller::clip}) {
    SCOPED_TRACE(nameOf(controller));
    const bool clips = controller == Controller::clip;
    Scene made = scene(agents);
    made.herds[0].controller = controller;
    const Drawn drawn = draw(made, kFar);
    const Limbs limbs = clips ? limbsOf(spiderClips()) : limbsOf(spiderRig());
    const float radius = clips ? crowd::radiusOf(spiderClips()) : crowd::radiusOf(spiderRig());
    const Strokes strokes =
        strokesOf(splatPartsOf(limbs, radius / kSplatPixels), clips ? movedByMatrix : turnedByRotation, kFar,
                  drawn.bodies, drawn.poses, agents, drawn.towardsSun);
    {
      SCOPED_TRACE("agents");
      expectDrawn(drawn.splats, strokes.agents);
      expectMarked(drawn.tiles, drawn.splats);
    }
    SCOPED_TRACE("shadows");
    expectDrawn(drawn.shades, strokes.shades);
    expectMarked(drawn.tiles, drawn.shades);
  }
}

// And where a device cannot hold them there are none.
TEST_P(SplatTest, TheSamePictureHasTheSameBits) {
  const Scene made = scene(150);
  const Drawn once = draw(made, kFar), again = draw(made, kFar);
  EXPECT_FALSE(once.inHugePictures);
  EXPECT_EQ(once.splats, again.splats);
  EXPECT_EQ(once.shades, again.shades);
}

// Half way over, every second pixel is there, in the order of Bayer's matrix; of the shadow, half its
// strength.
TEST_P(SplatTest, ComePixelByPixel) {
  constexpr uint32_t kOrder[4][4] = {{0, 8, 2, 10}, {12, 4, 14, 6}, {3, 11, 1, 9}, {15, 7, 13, 5}};
  Scene made = scene(1);
  made.herds[0].goal.kind = Goal::Kind::none;
  const glm::dvec3 at = placeOf(draw(made, kFar).bodies[0]);
  const double radius = double(crowd::radiusOf(spiderRig()));
  for (const double limit : {double(kSplatPixels), double(kShadePixels)}) {
    const double pixels = limit * (1 - 0.1 * 8.5 / 16);
    const double away = radius * kHeight / (2 * std::tan(0.45) * pixels);
    const View view{.eye = glm::vec3(at + away * glm::normalize(glm::dvec3(0.6, 0.5, 0.7))),
                    .target = glm::vec3(at),
                    .fieldOfView = 0.9f};
    const Drawn whole = draw(made, view, 1, 0.8f), half = draw(made, view);
    uint32_t drawn = 0, shaded = 0;
    for (uint32_t y = 0; y < kHeight; ++y)
      for (uint32_t x = 0; x < kWidth; ++x) {
        const size_t i = y * kWidth + x;
        const bool there = limit == double(kShadePixels) || kOrder[y % 4][x % 4] < 8;
        ASSERT_EQ(half.splats[i], there ? whole.splats[i] : 0) << x << ", " << y;
        drawn += half.splats[i] != 0;
        if (limit != double(kShadePixels) || whole.shades[i] == 0) continue;
        ASSERT_NEAR(unpacked(half.shades[i]).value().low, unpacked(whole.shades[i]).value().low / 2, 1);
        ++shaded;
      }
    EXPECT_GT(drawn, 20u);
    if (limit == double(kShadePixels)) {
      EXPECT_GT(shaded, 10u);
    }
  }
}

// Where something keeps the sun off they are dark, and cast no shadows of their own.
TEST_P(SplatTest, LieInTheShadowsOfOthers) {
  const Scene made = scene(30);
  const Drawn open = draw(made, kFar), shaded = draw(made, kFar, 0);
  double before = 0, after = 0;
  const auto lightness = [](uint32_t low) {
    return (low >> 11) / 31.0 + (low >> 5 & 63) / 63.0 + (low & 31) / 31.0;
  };
  for (size_t i = 0; i < open.splats.size(); ++i) {
    ASSERT_EQ(open.splats[i] == 0, shaded.splats[i] == 0) << i;
    ASSERT_EQ(shaded.shades[i], 0u) << i;
    before += lightness(open.splats[i] & 65535);
    after += lightness(shaded.splats[i] & 65535);
  }
  EXPECT_GT(std::ranges::count_if(open.shades, [](uint32_t shade) { return shade != 0; }), 30);
  EXPECT_LT(after, 0.9 * before);
}

// Nothing pops where an agent is splats from now on, and half way to it. Seen from the sun, its rectangle, of
// which it covers a tenth, keeps its mean colour to 1 of 255: with twice the sunlight it would change by 2.4.
TEST_P(SplatTest, LookAsTheTrianglesDid) {
  Scene made = scene(1);
  made.herds[0].goal.kind = Goal::Kind::none;
  const Heightfield ground = level();
  const Standing one(*this, ground, made);
  Renderer renderer(device(), one.crowd, 320, 200), finer(device(), one.crowd, 320, 200, {.detail = 1.2f});
  for (const double share : {0.998, 0.95, 0.898}) {
    std::vector<std::vector<uint8_t>> pictures;
    for (Renderer* by : {&finer, &renderer}) {
      pictures.push_back(one.picture(*by, double(kSplatPixels) * share));
      EXPECT_EQ(by->counts().splats, by == &finer ? 0u : 1u);
    }
    double mean[3] = {}, apart = 0;
    int pixels = 0;
    for (int y = 75; y < 125; ++y)
      for (int x = 135; x < 185; ++x, ++pixels)
        for (int c = 0; c < 3; ++c) {
          const size_t i = size_t(y * 320 + x) * 4 + size_t(c);
          mean[c] += double(pictures[1][i]) - pictures[0][i];
          apart += std::abs(double(pictures[1][i]) - pictures[0][i]) / 3;
        }
    for (const double channel : mean) EXPECT_LT(std::abs(channel) / pixels, 1) << share;
    EXPECT_LT(apart / pixels, 3) << share;
  }
}

// An agent in textures does not pop either: at the first step it is the mesh that it was, pixel by pixel,
// then less and less of it. Its shadow likewise.
TEST_P(SplatTest, GoOverByAndByInTextures) {
  Scene made = scene(1);
  made.herds[0].rig = SKITTER_ASSETS "/piebald.glb";
  made.herds[0].goal.kind = Goal::Kind::none;
  const Heightfield ground = level();
  const Standing one(*this, ground, made);
  // The first draws a mesh at all sizes below, the last one splats.
  Renderer finer(device(), one.crowd, 320, 200, {.detail = 1.15f}), between(device(), one.crowd, 320, 200),
      coarser(device(), one.crowd, 320, 200, {.detail = 0.85f});
  for (const double limit : {double(kSplatPixels), double(kShadePixels)})
    for (const double share : {0.998, 0.95, 0.904, 0.898}) {
      SCOPED_TRACE(std::to_string(share) + " of " + std::to_string(limit) + " pixels");
      std::vector<std::vector<uint8_t>> pictures;
      for (Renderer* by : {&finer, &between, &coarser}) pictures.push_back(one.picture(*by, limit * share));
      const auto apart = [&](size_t a, size_t b) {
        int sum = 0;
        for (size_t i = 0; i < pictures[a].size(); ++i)
          sum += std::abs(int(pictures[a][i]) - int(pictures[b][i]));
        return sum;
      };
      const int all = apart(0, 2);
      EXPECT_GT(all, 300);
      if (share > 0.99) {
        EXPECT_EQ(apart(0, 1), 0);
      } else if (share < 0.9) {
        EXPECT_EQ(apart(1, 2), 0);
      } else if (share < 0.91) {
        EXPECT_LT(apart(1, 2), all / 3);  // one pixel of sixteen is left
      } else {
        EXPECT_GT(apart(0, 1), all / 4);
        EXPECT_GT(apart(1, 2), all / 4);
      }
    }
}

}  // namespace
}  // namespace skitter::render
