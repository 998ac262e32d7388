// What a host draws with, held against the poses that the host can download.
#include "skitter/palettes.h"

#include <gmock/gmock.h>

#include <glm/gtc/quaternion.hpp>
#include <numeric>

#include "gpu/submit.h"
#include "gpu/transfer.h"
#include "skitter/decode.h"
#include "skitter/error.h"
#include "skitter/skin_mesh.h"
#include "support/gpu_fixture.h"

namespace skitter {
namespace {

constexpr float kUntouched = 1e30f;

// Two kinds, odd counts, pages and blocks that end within herds, nobody in one.
Scene severalHerds(Controller controller) {
  Scene scene;
  scene.herds = {Herd{}};
  scene.herds[0].controller = controller;
  scene.herds[0].agents = 5;
  scene.herds.resize(4, scene.herds[0]);
  scene.herds[1].agents = 0;
  scene.herds[2].agents = 37;
  scene.herds[2].spawn.heading = 2;
  scene.herds[3].agents = 9;
  scene.herds[3].controller = controller == Controller::loop ? Controller::adaptive : Controller::loop;
  return scene;
}

Heightfield ground() { return generateHeightfield({.columns = 129, .rows = 129}); }

// A transform as a host reads it out of its buffer.
struct Affine {
  glm::dmat3 linear{0};
  glm::dvec3 position{0};
  glm::dvec3 moved(const glm::dvec3& v) const { return linear * v + position; }
};

class PalettesTest : public test::GpuLoadTest {
 protected:
  // The bytes of the caller's buffer, all of it, after a tick that the writes follow.
  std::vector<float> written(Crowd& crowd, const Palettes& palettes, const gpu::Buffer& buffer,
                             const glm::dvec3& origin) {
    gpu::upload(context(), buffer, std::vector<float>(buffer.size() / sizeof(float), kUntouched));
    const gpu::Buffer copy(context(), buffer.size(), "copy");
    gpu::CommandRing ring(context());
    for (int i = 0; i < 2; ++i) {
      const vk::CommandBuffer cmd = ring.begin();
      crowd.record(cmd, 1.0f / 60);
      palettes.record(cmd, origin);
      // The host reads it, without a barrier of its own.
      cmd.copyBuffer(buffer.handle(), copy.handle(), vk::BufferCopy{.size = buffer.size()});
      gpu::allToAll(cmd);
      ring.submit();
    }
    ring.waitAll();
    return gpu::download<float>(context(), copy);
  }
};
INSTANTIATE_TEST_SUITE_P(Loads, PalettesTest, test::bothLoadPaths(), test::loadPathName);

// Reads transforms, and remembers which floats are theirs.
struct Reader {
  const std::vector<float>& floats;
  const TransformRange& range;
  uint64_t count;
  std::vector<bool> theirs = std::vector<bool>(floats.size(), false);

  glm::dvec4 part(uint64_t transform, uint64_t k) {
    const uint64_t parts = bytesOf(range.format) / 16;
    const uint64_t stride = range.stride > 0 ? range.stride / 16 : parts;
    const uint64_t at =
        range.offset / 4 + 4 * (range.planar ? k * count + transform : transform * stride + k);
    std::fill_n(theirs.begin() + static_cast<ptrdiff_t>(at), 4, true);
    return {floats.at(at), floats.at(at + 1), floats.at(at + 2), floats.at(at + 3)};
  }
  Affine transform(uint64_t i) {
    if (range.format == TransformFormat::quaternion) {
      const glm::dvec4 q = part(i, 0), p = part(i, 1);
      return {p.w * glm::mat3_cast(glm::dquat(q.w, q.x, q.y, q.z)), p};
    }
    const glm::dmat3x4 rows(part(i, 0), part(i, 1), part(i, 2));
    const glm::dmat4x3 columns = glm::transpose(rows);
    return {glm::dmat3(columns), columns[3]};
  }
};

// Where the pose records have a vertex at rest, relative to the origin, along world axes.
glm::dvec3 skinned(const SkinVertex& vertex, const BodyState& body, std::span<const float> pose,
                   bool matrices, const std::vector<glm::vec3>& starts) {
  glm::dvec3 place = body.position;
  for (int i = 0; i < 4; ++i) {
    if (matrices) {
      const glm::dmat4x3 m = glm::transpose(glm::dmat3x4(jointRowsOf(pose, vertex.bones[i])));
      place += double{vertex.weights[i]} * (m * glm::dvec4(vertex.position, 1));
    } else {
      const BonePose bone = bonePoseOf(pose, vertex.bones[i]);
      place += double{vertex.weights[i]} *
               (glm::dvec3(bone.position) +
                glm::dquat(bone.rotation) * glm::dvec3(vertex.position - starts.at(vertex.bones[i])));
    }
  }
  return place;
}

struct Case {
  TransformFormat format = TransformFormat::matrix;
  Axes axes = Axes::rightYUp;
  float metresPerUnit = 1;
  bool relative = false, planar = false;
  uint64_t gap = 0;  // bytes between transforms
};

TEST_P(PalettesTest, SkinTheMeshAsThePosesDo) {
  const std::vector<Case> cases{
      {},
      {.axes = Axes::leftYUp, .relative = true, .gap = 16},
      {.axes = Axes::rightZUp, .metresPerUnit = 0.01f, .planar = true},
      {.axes = Axes::leftZUp, .metresPerUnit = 0.01f, .relative = true, .planar = true},
      {.format = TransformFormat::quaternion, .axes = Axes::leftZUp, .metresPerUnit = 2, .gap = 48},
      {.format = TransformFormat::quaternion, .axes = Axes::rightZUp, .relative = true, .planar = true},
  };
  const glm::dvec3 origin(-70.3, 12.25, 3.7);
  for (const Controller controller : allControllers) {
    SCOPED_TRACE(nameOf(controller));
    const Scene scene = severalHerds(controller);
    Crowd crowd(device(), ground(), scene, CrowdOptions{.measure = false, .pageAgents = 24});
    for (uint32_t herd = 0; herd < crowd.herdCount(); ++herd) {
      const Controller own = scene.herds[herd].controller;
      const bool matrices = own == Controller::clip || own == Controller::planted;
      const uint32_t agents = Palettes::agentsOf(crowd, herd), entries = Palettes::entriesOf(crowd, herd);
      ASSERT_EQ(agents, scene.herds[herd].agents);
      const SkinMesh rest = skinMeshOf(crowd, herd);
      ASSERT_EQ(rest.entries, entries);
      for (const Case& c : cases) {
        if (matrices && c.format == TransformFormat::quaternion) continue;
        SCOPED_TRACE(testing::Message() << "herd " << herd << " axes " << static_cast<int>(c.axes)
                                        << " format " << static_cast<int>(c.format));
        const HostSpace space{c.axes, c.metresPerUnit};
        const SkinMesh mesh = skinMeshOf(crowd, herd, space);
        const uint64_t each = bytesOf(c.format) + c.gap;
        const auto rangeOf = [&](uint64_t offset, uint64_t count) {
          const uint64_t bytes = count == 0 ? 0 : count * each - c.gap;
          return TransformRange{VK_NULL_HANDLE, offset, bytes, c.format, c.planar ? 0 : each, c.planar};
        };
        TransformRange instances = rangeOf(16 * 7, agents);
        TransformRange palettes = rangeOf(16 * 9 + agents * each, uint64_t{agents} * entries);
        const gpu::Buffer buffer(context(), palettes.offset + palettes.bytes + 16, "the caller's");
        instances.buffer = palettes.buffer = buffer.handle();
        const Palettes writer(device(), crowd, herd, {{instances, palettes}}, {space, c.relative});
        const std::vector<float> floats = written(crowd, writer, buffer, origin);
        const HerdState state = crowd.download(herd);

        Reader bodies{floats, instances, agents};
        Reader bones{floats, palettes, uint64_t{agents} * entries};
        const std::vector<glm::vec3> starts = crowd.rig(herd).restStarts();
        double furthest = 0;
        for (uint32_t agent = 0; agent < agents; ++agent) {
          const BodyState body =
              bodyOf(std::span(state.body).subspan(size_t{agent} * 4 * shared::BODY_STRIDE), origin);
          const size_t poseFloats = state.pose.size() / agents;
          const auto pose = std::span(state.pose).subspan(agent * poseFloats, poseFloats);
          const Affine instance = bodies.transform(agent);
          // Model space's own axes, at an arm's length.
          for (const glm::dvec3 model : {glm::dvec3(0), {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}) {
            const glm::dvec3 expected = space.from(body.position + glm::dquat(body.rotation) * model);
            furthest =
                std::max(furthest, glm::distance(instance.moved(space.from(model)), expected) / mesh.radius);
          }
          std::vector<Affine> palette;
          for (uint32_t e = 0; e < entries; ++e) palette.push_back(bones.transform(agent * entries + e));
          for (size_t v = agent; v < mesh.vertices.size(); v += 41) {
            const SkinVertex& vertex = mesh.vertices[v];
            glm::dvec3 place(0);
            for (int i = 0; i < 4; ++i)
              place += double{vertex.weights[i]} * palette.at(vertex.bones[i]).moved(vertex.position);
            if (c.relative) place = instance.moved(place);
            const glm::dvec3 expected = space.from(skinned(rest.vertices[v], body, pose, matrices, starts));
            furthest = std::max(furthest, glm::distance(place, expected) / mesh.radius);
          }
        }
        // Positions up to 100 m from the origin are rounded to 8e-6 m.
        EXPECT_LT(furthest, 1e-4);
        for (size_t i = 0; i < floats.size(); ++i) {
          if (!bodies.theirs[i] && !bones.theirs[i]) {
            ASSERT_EQ(floats[i], kUntouched) << i;
          }
        }
      }
    }
  }
}

// A herd of several sizes has one mesh, at the first of them.
TEST_P(PalettesTest, BringTheMeshToTheSizeOfEachAgent) {
  constexpr uint64_t agents = 20;
  const glm::dvec3 origin(-70.3, 12.25, 3.7);
  struct Sized {
    Controller controller;
    TransformFormat ofPalettes;
  };
  for (const auto& [controller, ofPalettes] : {Sized{Controller::adaptive, TransformFormat::matrix},
                                               Sized{Controller::adaptive, TransformFormat::quaternion},
                                               Sized{Controller::clip, TransformFormat::matrix}})
    for (const bool relative : {false, true}) {
      SCOPED_TRACE(testing::Message()
                   << nameOf(controller) << ' ' << static_cast<int>(ofPalettes) << ' ' << relative);
      Scene scene;
      scene.herds[0].controller = controller;
      scene.herds[0].agents = agents;
      scene.herds[0].sizes = {2, 0.5f, 1};
      Crowd crowd(device(), ground(), scene, CrowdOptions{.measure = false, .pageAgents = 8});
      const SkinMesh mesh = skinMeshOf(crowd, 0);
      const uint64_t entries = mesh.entries;
      const gpu::Buffer buffer(context(), agents * (1 + entries) * 48, "the caller's");
      const TransformRange instances{buffer.handle(), 0, agents * 48,
                                     relative ? TransformFormat::quaternion : TransformFormat::matrix};
      const TransformRange palettes{buffer.handle(), agents * 48, agents * entries * 48, ofPalettes};
      const Palettes writer(device(), crowd, 0, {{instances, palettes}}, {{}, relative});
      const std::vector<float> floats = written(crowd, writer, buffer, origin);
      const HerdState state = crowd.download(0);
      Reader bodies{floats, instances, agents}, bones{floats, palettes, agents * entries};
      double furthest = 0;
      for (uint32_t agent = 0; agent < agents; ++agent) {
        const BodyState body =
            bodyOf(std::span(state.body).subspan(size_t{agent} * 4 * shared::BODY_STRIDE), origin);
        const size_t poseFloats = state.pose.size() / agents;
        const auto pose = std::span(state.pose).subspan(agent * poseFloats, poseFloats);
        const std::vector<glm::vec3> starts = crowd.rig(0, agent).restStarts();
        const double larger = double{crowd.size(0, agent)} / 2;
        const Affine instance = bodies.transform(agent);
        for (const glm::dvec3 model : {glm::dvec3(0), {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}) {
          const glm::dvec3 expected = body.position + larger * (glm::dquat(body.rotation) * model);
          furthest = std::max(furthest, glm::distance(instance.moved(model), expected) / mesh.radius);
        }
        for (size_t v = agent; v < mesh.vertices.size(); v += 41) {
          SkinVertex vertex = mesh.vertices[v];
          glm::dvec3 place(0);
          for (int i = 0; i < 4; ++i)
            place += double{vertex.weights[i]} *
                     bones.transform(agent * entries + vertex.bones[i]).moved(vertex.position);
          if (relative) place = instance.moved(place);
          vertex.position *= static_cast<float>(larger);
          const glm::dvec3 expected = skinned(vertex, body, pose, controller == Controller::clip, starts);
          furthest = std::max(furthest, glm::distance(place, expected) / mesh.radius);
        }
      }
      EXPECT_LT(furthest, 1e-4);
    }
}

// On the other side of the map, where a float32 of the world is 2.4e-4 m off.
TEST_P(PalettesTest, AreExactFarFromTheWorldsOrigin) {
  Heightfield wide = generateHeightfield({.columns = 129, .rows = 129, .spacing = 62});
  Scene scene;
  scene.herds[0].agents = 9;
  scene.herds[0].spawn = {.kind = Spawn::Kind::grid, .spacing = 2, .centre = {3890, -3901}};
  Crowd crowd(device(), wide, scene, CrowdOptions{.measure = false});
  const gpu::Buffer buffer(context(), 9 * 32, "the caller's");
  const Palettes writer(device(), crowd, 0,
                        {{.instances = {buffer.handle(), 0, 9 * 32, TransformFormat::quaternion}}});
  const glm::dvec3 origin(3889.1, 3.3, -3902.7);
  const std::vector<float> floats = written(crowd, writer, buffer, origin);
  const HerdState state = crowd.download(0);
  for (size_t agent = 0; agent < 9; ++agent) {
    const float* body = &state.body[agent * 4 * shared::BODY_STRIDE];
    const BodyState decoded = bodyOf({body, 4 * shared::BODY_STRIDE}, origin);
    const glm::dvec2 exact(16.0 * shared::tileX(body[3]) + body[0] - origin.x,
                           16.0 * shared::tileZ(body[3]) + body[2] - origin.z);
    EXPECT_LT(glm::length(exact), 16);
    EXPECT_LT(glm::distance(exact, glm::dvec2(decoded.position.x, decoded.position.z)), 1e-9);
    // Two roundings of numbers below 16 m.
    EXPECT_LT(glm::distance(exact, glm::dvec2(floats[agent * 8 + 4], floats[agent * 8 + 6])), 3e-6);
  }
}

// Each frame in flight reads a target of its own.
TEST_P(PalettesTest, TargetsTakeTurns) {
  Scene scene;
  scene.herds[0].agents = 3;
  Crowd crowd(device(), ground(), scene, CrowdOptions{.pose = false, .measure = false});
  const gpu::Buffer buffer(context(), 2 * 3 * 48, "the caller's");
  const Palettes writer(
      device(), crowd, 0,
      {{.instances = {buffer.handle(), 0, 144}}, {.instances = {buffer.handle(), 144, 144}}});
  gpu::clear(context(), buffer);
  gpu::submitAndWait(context(), [&](vk::CommandBuffer cmd) { writer.record(cmd, glm::dvec3(0), 1); });
  const std::vector<float> floats = gpu::download<float>(context(), buffer);
  EXPECT_EQ(std::accumulate(floats.begin(), floats.begin() + 36, 0.0f), 0);
  for (int agent = 0; agent < 3; ++agent) EXPECT_NE(floats[36 + static_cast<size_t>(agent) * 12], 0);
}

// An empty place has transforms of zeros, so that the host draws a point.
TEST_P(PalettesTest, NothingOfWhoIsNotThere) {
  for (const Controller controller : {Controller::adaptive, Controller::clip}) {
    Scene scene;
    scene.herds[0].agents = 3;
    scene.herds[0].controller = controller;
    Crowd crowd(device(), ground(), scene, CrowdOptions{.measure = false});
    const uint64_t entries = Palettes::entriesOf(crowd, 0), floatsEach = 8 + 12 * entries;
    const gpu::Buffer buffer(context(), 3 * floatsEach * sizeof(float), "the caller's");
    const Palettes writer(device(), crowd, 0,
                          {{.instances = {buffer.handle(), 0, 3 * 32, TransformFormat::quaternion},
                            .palettes = {buffer.handle(), 3 * 32, 3 * 48 * entries}}});
    const RecordBuffer bodies = crowd.buffers(0, Record::body).at(0);
    gpu::submitAndWait(context(), [&](vk::CommandBuffer cmd) {
      crowd.record(cmd, 1.0f / 60);
      const float empty = 1;
      cmd.updateBuffer(bodies.buffer, 16 * (bodies.recordAt(1) + 1) + 12, sizeof empty, &empty);
      writer.record(cmd);
    });
    const std::vector<float> floats = gpu::download<float>(context(), buffer);
    const auto isNothing = [&](uint64_t first, uint64_t count) {
      return std::all_of(floats.begin() + static_cast<ptrdiff_t>(first),
                         floats.begin() + static_cast<ptrdiff_t>(first + count),
                         [](float f) { return f == 0; });
    };
    for (uint64_t agent = 0; agent < 3; ++agent) {
      EXPECT_EQ(isNothing(8 * agent, 8), agent == 1) << agent;
      EXPECT_EQ(isNothing(24 + 12 * entries * agent, 12 * entries), agent == 1) << agent;
    }
  }
}

TEST_P(PalettesTest, RefuseWhatCannotBe) {
  Scene scene;
  scene.herds[0].agents = 3;
  scene.herds.push_back(scene.herds[0]);
  scene.herds[1].controller = Controller::clip;
  const Crowd crowd(device(), ground(), scene, CrowdOptions{.measure = false});
  const Crowd poseless(device(), ground(), scene, CrowdOptions{.pose = false, .measure = false});
  const gpu::Buffer buffer(context(), 1 << 20, "the caller's");
  const auto expectRefused = [&](const Crowd& of, uint32_t herd, const PaletteTarget& target,
                                 const std::string& message, float metres = 1) {
    try {
      Palettes(device(), of, herd, {target}, {.space = {.metresPerUnit = metres}});
      ADD_FAILURE() << "taken: " << message;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), Error::Kind::input);
      EXPECT_THAT(error.what(), testing::HasSubstr(message));
    }
  };
  const VkBuffer own = buffer.handle();
  expectRefused(crowd, 0, {.instances = {own, 0, 143}},
                "instances: 143 bytes for 3 transforms, expected at least 144");
  expectRefused(crowd, 0, {.instances = {own, 8, 1 << 19}}, "offset 8, expected a multiple of 16 bytes");
  expectRefused(crowd, 0, {.instances = {own, 0, 1 << 19, TransformFormat::matrix, 32}},
                "stride 32, expected 0 or at least 48 bytes");
  expectRefused(crowd, 0, {.instances = {own, 0, 1 << 19, TransformFormat::matrix, 64, true}},
                "stride 64 of planar transforms, expected 0");
  expectRefused(crowd, 1, {.palettes = {own, 0, 1 << 19, TransformFormat::quaternion}},
                "palettes of herd 1: controller clip poses by matrices");
  expectRefused(poseless, 0, {.palettes = {own, 0, 1 << 19}}, "expected CrowdOptions::pose");
  expectRefused(crowd, 0, {}, "metresPerUnit 0, expected a finite length above 0", 0);
}

TEST_P(PalettesTest, OfAHerdThatIsGoneAreRefused) {
  Scene scene;
  scene.herds[0].agents = 3;
  scene.herds.push_back(scene.herds[0]);
  scene.herds[1].controller = Controller::clip;
  Crowd crowd(device(), ground(), scene, CrowdOptions{.measure = false});
  const gpu::Buffer buffer(context(), 1 << 16, "the caller's");
  const PaletteTarget target{.instances = {buffer.handle(), 0, 1 << 16}};
  const Palettes palettes(device(), crowd, 1, {target});
  crowd.removeHerd(crowd.herdId(1));
  const auto isGone = testing::ThrowsMessage<Error>(testing::HasSubstr("herd 1 was removed"));
  const auto recorded = [&] {
    gpu::CommandRing ring(context());
    const vk::CommandBuffer cmd = ring.begin();
    try {
      palettes.record(cmd);
    } catch (...) {
      ring.submit();
      throw;
    }
    ring.submit();
  };
  EXPECT_THAT(recorded, isGone);
  const auto isNone = testing::ThrowsMessage<Error>(testing::HasSubstr("herd 1: was removed"));
  EXPECT_THAT([&] { Palettes(device(), crowd, 1, {target}); }, isNone);
  EXPECT_THAT([&] { Palettes::agentsOf(crowd, 1); }, isNone);
  EXPECT_THAT([&] { Palettes::entriesOf(crowd, 1); }, isNone);
  EXPECT_THAT([&] { skinMeshOf(crowd, 1); }, isNone);
  EXPECT_THAT([&] { crowd.rig(1); }, isNone);
  crowd.addHerd(scene.herds[0]);
  EXPECT_THAT(recorded, isGone);
}

// Every space shows the same side of each triangle, and levels are coarser and coarser.
TEST(SkinMeshTest, FacesOutwardInEverySpace) {
  Device device = Device::create(test::validatedRequest());
  Scene scene;
  scene.herds[0].agents = 1;
  for (const Controller controller : {Controller::adaptive, Controller::clip}) {
    scene.herds[0].controller = controller;
    const Crowd crowd(device, ground(), scene);
    for (const Axes axes : allAxes) {
      const SkinMesh mesh = skinMeshOf(crowd, 0, {axes, 0.5f});
      ASSERT_EQ(mesh.levels.size(), 4u);
      EXPECT_EQ(mesh.levels.back().pixels, 0);
      for (size_t l = 0; l < mesh.levels.size(); ++l) {
        if (l > 0) {
          EXPECT_LT(mesh.levels[l].indexCount, mesh.levels[l - 1].indexCount);
        }
        size_t outward = 0;
        for (uint32_t i = 0; i < mesh.levels[l].indexCount; i += 3) {
          const auto corner = [&](uint32_t k) -> const SkinVertex& {
            return mesh.vertices.at(mesh.indices.at(mesh.levels[l].firstIndex + i + k));
          };
          // In left-handed axes the cross product of what is seen counter-clockwise points away from the eye.
          const glm::vec3 face =
              glm::cross(corner(1).position - corner(0).position, corner(2).position - corner(0).position);
          const float side = glm::dot(face, corner(0).normal + corner(1).normal + corner(2).normal);
          outward += (HostSpace{axes}.isMirrored() ? -side : side) > 0;
        }
        // Thin parts of the coarsest levels have normals of both of their sides.
        EXPECT_GT(static_cast<double>(outward), (l == 0 ? 0.9 : 0.7) * mesh.levels[l].indexCount / 3) << l;
      }
    }
  }
  test::failOnMessages(*device.validationLog());
}

}  // namespace
}  // namespace skitter
