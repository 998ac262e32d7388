// Agents that are hidden are left out, and no picture shows it (docs/stages/pictures.md, Occlusion).
#include <glm/gtc/quaternion.hpp>
#include <map>
#include <numbers>
#include <numeric>
#include <random>
#include <span>

#include "gpu/transfer.h"
#include "render/composition.h"
#include "render/hulls.h"
#include "render/limbs.h"
#include "render/occlusion.h"
#include "render/pictures.h"
#include "render/sight.h"
#include "skitter/clip.h"

namespace skitter::render {
namespace {

using test::Picture;
using test::Stage;

// Flat ground with a wall of so many metres across it, two metres thick, that has battlements down to `low`.
Heightfield walled(float height, float low) {
  constexpr uint32_t side = 65;
  Heightfield field{
      .name = "wall", .columns = side, .rows = side, .spacingX = 0.5f, .spacingZ = 0.5f, .heights = {}};
  for (uint32_t z = 0; z < side; ++z)
    for (uint32_t x = 0; x < side; ++x)
      field.heights.push_back(z < 26 || z > 30 ? 0 : x % 8 < 6 ? height : low);
  return field;
}

// Agents in rows beyond the wall.
Scene crowded(uint32_t agents, float spacing) {
  Scene scene = test::smallScene(agents);
  scene.herds[0].spawn = Spawn{.kind = Spawn::Kind::grid, .spacing = spacing, .centre = {0, 5}};
  scene.herds[0].goal.speed = 1.5f;
  return scene;
}

class OcclusionTest : public test::GpuLoadTest {
 protected:
  struct Totals {
    uint64_t agents = 0, hidden = 0;
  };
  // Draws the crowd with occlusion and without it, from a camera that moves and jumps.
  Totals expectSamePictures(const Scene& scene, const Heightfield& ground, float eyeHeight,
                            const CrowdOptions& options = {}, const std::function<void(Stage&)>& before = {},
                            float detail = 3) {
    constexpr uint32_t width = 327, height = 181;  // no multiple of any square
    Stage stage(device(), scene, ground, width, height, {.detail = detail, .occlusion = false}, options);
    const RendererOptions leavingOut{.detail = detail, .occlusion = true};
    Renderer leaving(device(), stage.crowd, width, height, leavingOut);
    if (before) before(stage);
    Totals totals;
    for (int picture = 0; picture < 10; ++picture) {
      const float turn =
          picture < 8 ? 0.06f * float(picture) : 0.5f * std::numbers::pi_v<float> * float(picture);
      const View view{.eye = {7 * std::sin(turn), eyeHeight, -7 * std::cos(turn)}, .target = {0, 0.3f, 2}};
      stage.crowd.lookFrom(view.eye);
      stage.tick(5);
      const Picture all = stage.draw(view);
      const auto expectSame = [&](Renderer& renderer, const char* what) {
        gpu::submitAndWait(context(), [&](vk::CommandBuffer cmd) { renderer.record(cmd, view); });
        EXPECT_EQ(test::differing(all, {width, height, renderer.download()}), 0u)
            << what << " picture " << picture;
      };
      expectSame(leaving, "the next");
      const PictureCounts expected = stage.renderer.counts(), found = leaving.counts();
      EXPECT_EQ(found.agents, expected.agents);
      EXPECT_EQ(found.splats, expected.splats);
      EXPECT_EQ(expected.hidden, 0u);
      EXPECT_LE(found.triangles, expected.triangles);
      EXPECT_EQ(found.triangles == expected.triangles, found.hidden == 0);
      totals.agents += found.agents - found.splats;
      totals.hidden += found.hidden;
      // Whom a first picture shows the pyramid alone decides. At rates of their own agents are on the way
      // from the last one.
      if (scene.levels) continue;
      Renderer fresh(device(), stage.crowd, width, height, leavingOut);
      expectSame(fresh, "a first");
    }
    return totals;
  }
};
INSTANTIATE_TEST_SUITE_P(Loads, OcclusionTest, test::bothLoadPaths(), test::loadPathName);

TEST_P(OcclusionTest, picturesOfEveryKindStayAsTheyAre) {
  const Scene spiders = crowded(120, 0.7f);
  Totals totals = expectSamePictures(spiders, walled(1.3f, 0.5f), 1.2f);
  EXPECT_GT(totals.hidden, totals.agents / 20);
  EXPECT_LT(totals.hidden, totals.agents);
  // Some go over to splats.
  expectSamePictures(spiders, walled(1.3f, 0.5f), 1.2f, {}, {}, 1);

  Scene other = spiders;
  other.herds[0].controller = Controller::clip;
  for (const bool pose : {true, false}) {
    SCOPED_TRACE(pose ? "clips" : "clips, posed for the picture");
    totals = expectSamePictures(other, walled(1.3f, 0.5f), 1.2f, {.pose = pose});
    EXPECT_GT(totals.hidden, totals.agents / 20);
  }
  other.levels = Levels{.distances = {0, 4, 8}, .most = {}};
  SCOPED_TRACE("with levels of rate");
  totals = expectSamePictures(other, walled(1.3f, 0.5f), 1.2f, {.pose = false});
  EXPECT_GT(totals.hidden, totals.agents / 20);
}

TEST_P(OcclusionTest, picturesOfTexturedModelsAndOfTheHurtStayAsTheyAre) {
  Scene scene = crowded(60, 0.9f);
  scene.herds[0].rig = SKITTER_ASSETS "/piebald.glb";
  Totals totals = expectSamePictures(scene, walled(1.4f, 0.5f), 1.3f);
  EXPECT_GT(totals.hidden, totals.agents / 20);

  scene = crowded(60, 0.8f);
  scene.herds[0].hurt = true;
  totals = expectSamePictures(scene, walled(1.3f, 0.5f), 1.2f, {}, [](Stage& stage) {
    for (uint32_t agent = 0; agent < 60; ++agent)
      for (const int leg : {1, 4}) stage.crowd.hurt(stage.crowd.agentId(0, agent), leg);
  });
  EXPECT_GT(totals.hidden, totals.agents / 20);
}

// Nobody is drawn behind a wall that is high enough, and all are once the camera looks over it.
TEST_P(OcclusionTest, aWallHidesAllBehindIt) {
  constexpr uint32_t agents = 30;
  Scene scene = crowded(agents, 1);
  scene.herds[0].goal.kind = Goal::Kind::none;
  Stage stage(device(), scene, walled(3, 3), 320, 180, {.detail = 5, .occlusion = true});
  stage.tick(20);
  const View behind{.eye = {0, 1, -7}, .target = {0, 0.5f, 6}}, above{.eye = {0, 9, -4}, .target = {0, 0, 6}};
  const auto draw = [&](const View& view) {
    stage.draw(view);
    EXPECT_EQ(stage.renderer.counts().agents, agents);
    EXPECT_EQ(stage.renderer.counts().splats, 0u);
    return stage.renderer.counts().hidden;
  };
  EXPECT_EQ(draw(behind), agents);
  EXPECT_EQ(draw(behind), agents);
  EXPECT_EQ(draw(above), 0u);
  EXPECT_EQ(draw(above), 0u);
  EXPECT_EQ(draw(behind), 0u) << "a picture begins with whom the last one showed";
  EXPECT_EQ(draw(behind), agents);
}

TEST_P(OcclusionTest, picturesOfAnySizeAndOfNobody) {
  for (const uint32_t agents : {0u, 1u, 40u})
    for (const glm::uvec2 size : {glm::uvec2(1, 1), {3, 5}, {4, 4}, {129, 1}}) {
      Stage stage(device(), crowded(agents, 0.8f), size.x, size.y, {.occlusion = true});
      Renderer all(device(), stage.crowd, size.x, size.y, {.occlusion = false});
      const View view{.eye = {0, 1, -3}};
      for (int picture = 0; picture < 3; ++picture) {
        stage.tick(1);
        const Picture found = stage.draw(view);
        gpu::submitAndWait(context(), [&](vk::CommandBuffer cmd) { all.record(cmd, view); });
        EXPECT_EQ(test::differing({size.x, size.y, all.download()}, found), 0u) << agents << ", " << size.x;
      }
    }
}

// The second look is held against points of triangles in doubles, before depths in blocks. Bones 0 and 1
// carry one triangle and bone 2 another, so that an agent has two hulls.
class SecondLookTest : public test::GpuLoadTest {
 protected:
  static constexpr uint32_t kWidth = 327, kHeight = 181, kAgents = 3000, kBlockPixels = 23;
  static constexpr int kBones = 3;
  enum class Form { rotations, matrices, stumps };
  const View view_{.eye = {-203, 12, 517}, .target = {-191, 4.0f, 530.8564f}, .fieldOfView = 0.9f};

  struct Agent {
    glm::dvec3 place;
    glm::dmat3 turns[kBones];
    glm::dvec3 starts[kBones];
    bool isLost = false;  // bone 1
    glm::dvec3 carried(int bone, const glm::vec4& part) const {
      return place + starts[bone] + (isLost && bone == 1 ? glm::dvec3(0) : turns[bone] * glm::dvec3(part));
    }
    glm::dvec3 carried(const MeshVertex& vertex) const {
      glm::dvec3 sum(0);
      for (size_t k = 0; k < 2; ++k)
        sum += double(vertex.influences[k].w) * carried(vertex.bones[k], vertex.influences[k]);
      return sum;
    }
  };
  // Bones 0 and 1 carry a corner each, and both the third.
  static MeshData triangles() {
    MeshData mesh;
    mesh.vertices.resize(6);
    mesh.vertices[0].influences[0] = {0.3f, 0.1f, -0.55f, 1};
    mesh.vertices[1].bones[0] = 1;
    mesh.vertices[1].influences[0] = {-0.1f, 0.9f, 0.1f, 1};
    mesh.vertices[2].bones[1] = 1;
    mesh.vertices[2].influences[0] = {-0.2f, 0, -0.35f, 0.5f};
    mesh.vertices[2].influences[1] = {0.1f, 0.5f, 0.3f, 0.5f};
    for (size_t corner = 3; corner < 6; ++corner) mesh.vertices[corner].bones[0] = 2;
    mesh.vertices[3].influences[0] = {0.2f, 0, 0, 1};
    mesh.vertices[4].influences[0] = {0, 0.3f, 0.1f, 1};
    mesh.vertices[5].influences[0] = {-0.2f, 0.1f, 0, 1};
    mesh.indices = {0, 1, 2, 3, 4, 5};
    mesh.lods[0].indexCount = 6;
    return mesh;
  }
  // The place in the picture, pixels, and its depth.
  glm::dvec3 seen(const glm::dvec3& p) const {
    const test::Sight s(view_, kWidth, kHeight);
    const glm::dvec3 to = p - s.eye;
    const double ahead = glm::dot(to, s.forward);
    return {kWidth * (0.5 + 0.5 * glm::dot(to, s.right) / (ahead * s.tanX)),
            kHeight * (0.5 - 0.5 * glm::dot(to, s.up) / (ahead * s.tanY)), 0.05 / ahead};
  }
  // Whether each agent is shown.
  std::vector<bool> shown(const std::vector<Agent>& agents, const MeshData& mesh,
                          const std::vector<float>& depths, Form form);
  void expectShown(Form form);
};
INSTANTIATE_TEST_SUITE_P(Loads, SecondLookTest, test::bothLoadPaths(), test::loadPathName);

std::vector<bool> SecondLookTest::shown(const std::vector<Agent>& agents, const MeshData& mesh,
                                        const std::vector<float>& depths, Form form) {
  std::vector<glm::vec4> bodies(agents.size() * shared::BODY_STRIDE), poses;
  for (size_t i = 0; i < agents.size(); ++i) {
    const glm::dvec3 tile = glm::floor(agents[i].place / double(shared::TILE_SIZE));
    const glm::dvec3 local = agents[i].place - double(shared::TILE_SIZE) * glm::dvec3(tile.x, 0, tile.z);
    bodies[i * shared::BODY_STRIDE] = glm::vec4(local, shared::packedTile(float(tile.x), float(tile.z)));
    for (int bone = 0; bone < kBones; ++bone) {
      const glm::dmat3& turn = agents[i].turns[bone];
      const glm::dvec3& start = agents[i].starts[bone];
      const glm::dquat q = glm::quat_cast(turn);
      if (form == Form::matrices)
        for (int row = 0; row < 3; ++row)
          poses.emplace_back(turn[0][row], turn[1][row], turn[2][row], start[row]);
      else
        poses.insert(poses.end(),
                     {glm::vec4(q.x, q.y, q.z, q.w), glm::vec4(start, agents[i].isLost && bone == 1)});
    }
  }
  const Heightfield field{
      .name = "flat", .columns = 2, .rows = 2, .spacingX = 9, .spacingZ = 9, .heights = {0, 0, 0, 0}};
  const shared::Picture picture = compose(view_, lightModel({}), field, 0, 0, kWidth, kHeight, 1024).block;
  const gpu::Buffer block(context(), sizeof picture, "picture", gpu::BufferUse::uniform);
  const gpu::Buffer body(context(), bodies.size() * sizeof bodies[0], "bodies");
  const gpu::Buffer pose(context(), poses.size() * sizeof poses[0], "poses");
  gpu::upload(context(), block, std::span(&picture, 1));
  gpu::upload(context(), body, bodies);
  gpu::upload(context(), pose, poses);
  const gpu::Image depth(context(),
                         {.format = vk::Format::eR32Sfloat,
                          .extent = {kWidth, kHeight},
                          .usage = vk::ImageUsageFlagBits::eSampled},
                         "depths"),
      none;
  gpu::uploadImage(context(), depth, depths);
  const ShadowMap shadow;
  const Setting setting{
      context(),         field, none, block, none, {}, shadow, {}, {}, vk::SampleCountFlagBits::e1,
      {kWidth, kHeight}, {},    1,    &depth};

  const Occlusion occlusion(setting);
  crowd::Kind source;
  if (form == Form::matrices) source.controller = Controller::clip;
  source.hurts = form == Form::stumps;
  const Occlusion::Kind kind = occlusion.makeKind(setting, source, mesh, kBones);
  const CulledPage culled =
      Cull(context(), 1).makePage(context(), block, body, uint32_t(agents.size()), false, true);
  const Occlusion::Page page = occlusion.makePage(setting, kind, body, pose, culled);
  std::vector<uint32_t> everybody(agents.size());
  std::iota(everybody.begin(), everybody.end(), 0);
  std::vector<VkDrawIndexedIndirectCommand> draws(shared::INSTANCE_LISTS);
  draws[0].instanceCount = uint32_t(agents.size());
  gpu::upload(context(), culled.instances, everybody);
  gpu::upload(context(), culled.commands, draws);
  gpu::submitAndWait(context(), [&](vk::CommandBuffer cmd) {
    occlusion.lookFirst(cmd, culled, page);
    gpu::computeToCompute(cmd);
    occlusion.makePyramid(cmd);
    occlusion.lookAgain(cmd, kind, culled, page);
  });
  draws = gpu::download<VkDrawIndexedIndirectCommand>(context(), culled.commands);
  const auto instances = gpu::download<uint32_t>(context(), culled.instances);
  EXPECT_EQ(draws[shared::FIRST_LOOK].instanceCount, 0u);
  std::vector<bool> found(agents.size());
  for (uint32_t i = 0; i < draws[shared::LATER].instanceCount; ++i)
    found.at(instances.at(size_t(shared::LATER) * agents.size() + i)) = true;
  return found;
}

void SecondLookTest::expectShown(Form form) {
  std::mt19937 random(7);
  const auto uniform = [&](double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(random);
  };
  std::map<std::pair<uint32_t, uint32_t>, float> blocks;
  std::vector<float> depths;
  for (uint32_t y = 0; y < kHeight; ++y)
    for (uint32_t x = 0; x < kWidth; ++x) {
      float& depth = blocks[{x / kBlockPixels, y / kBlockPixels}];
      if (depth == 0) depth = float(0.05 / std::exp(uniform(std::log(1.5), std::log(45.0))));
      depths.push_back(depth);
    }
  const auto depthAt = [&](double x, double y) { return double(depths[size_t(y) * kWidth + size_t(x)]); };

  const test::Sight sight(view_, kWidth, kHeight);
  std::vector<Agent> agents(kAgents);
  for (Agent& agent : agents) {
    agent.place =
        sight.at(std::exp(uniform(std::log(1.5), std::log(50.0))), uniform(-1.1, 1.1), uniform(-1.1, 1.1));
    for (int bone = 0; bone < kBones; ++bone) {
      const glm::dquat q =
          glm::normalize(glm::dquat(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)));
      agent.turns[bone] = glm::mat3_cast(q);
      // Matrices may stretch.
      if (form == Form::matrices) agent.turns[bone][1] *= uniform(0.5, 2);
      const double far = bone == 2 ? 3 : 0.3;
      agent.starts[bone] = {uniform(-far, far), uniform(-far, far), uniform(-far, far)};
    }
    agent.isLost = form == Form::stumps && uniform(0, 1) < 0.5;
  }
  const MeshData mesh = triangles();
  const std::vector<bool> found = shown(agents, mesh, depths, form);
  int visible = 0, hidden = 0;
  for (size_t i = 0; i < agents.size(); ++i) {
    bool isVisible = false, isHidden = true;
    for (const size_t first : {0, 3}) {
      const std::span<const MeshVertex> corners(&mesh.vertices[first], 3);
      // Points of the triangle that the depth does not hide.
      for (int a = 0; a <= 12; ++a)
        for (int b = 0; a + b <= 12; ++b) {
          const glm::dvec3 sum = double(a) * agents[i].carried(corners[0]) +
                                 double(b) * agents[i].carried(corners[1]) +
                                 double(12 - a - b) * agents[i].carried(corners[2]);
          const glm::dvec3 p = seen(sum / 12.0);
          if (p.x >= 0 && p.x < kWidth && p.y >= 0 && p.y < kHeight) isVisible |= p.z > depthAt(p.x, p.y);
        }
      // The corners of the box about what each bone carries.
      glm::dvec3 least(1e9), most(-1e9);
      for (int bone = 0; bone < kBones; ++bone) {
        glm::vec3 low(1e9f), high(-1e9f);
        for (const MeshVertex& vertex : corners)
          for (size_t k = 0; k < 2; ++k)
            if (vertex.influences[k].w > 0 && vertex.bones[k] == bone) {
              low = glm::min(low, glm::vec3(vertex.influences[k]));
              high = glm::max(high, glm::vec3(vertex.influences[k]));
            }
        if (low.x > high.x) continue;
        for (int corner = 0; corner < 8; ++corner) {
          const glm::vec4 part(corner & 1 ? low.x : high.x, corner & 2 ? low.y : high.y,
                               corner & 4 ? low.z : high.z, 1);
          const glm::dvec3 p = seen(agents[i].carried(bone, part));
          // Behind the eye there is no such place: the agent is neither visible nor hidden for sure.
          isHidden &= p.z > 0;
          least = glm::min(least, p);
          most = glm::max(most, p);
        }
      }
      // Squares are at most as long as the rectangle or 4 pixels, and it reaches two pixels further.
      const double slack = std::max(4.0, std::max(most.x - least.x, most.y - least.y) + 6) + 4;
      for (double y = std::max(0.0, least.y - slack); y < std::min(double(kHeight), most.y + slack); ++y)
        for (double x = std::max(0.0, least.x - slack); x < std::min(double(kWidth), most.x + slack); ++x)
          isHidden &= depthAt(x, y) > 1.02 * most.z;
    }
    EXPECT_FALSE(isVisible && isHidden);
    EXPECT_TRUE(found[i] || !isVisible) << "agent " << i << " is hidden";
    EXPECT_TRUE(!found[i] || !isHidden) << "agent " << i << " is not hidden";
    visible += isVisible;
    hidden += isHidden;
  }
  EXPECT_GT(visible, int(kAgents) / 10);
  EXPECT_GT(hidden, int(kAgents) / 10);
}

TEST_P(SecondLookTest, showsWhatRotationsCarry) { expectShown(Form::rotations); }
TEST_P(SecondLookTest, showsWhatMatricesCarry) { expectShown(Form::matrices); }
TEST_P(SecondLookTest, showsStumpsWhereTheyEnd) { expectShown(Form::stumps); }

// Ribbons that point to the eye reach half a pixel nearer than what their bones carry (skin.glsl): to just
// before a wall, in the middle and at the edge of the picture. Two pixels behind it they are hidden.
TEST_P(SecondLookTest, showsEndsOfRibbons) {
  MeshData ribbon;
  ribbon.vertices.resize(3);
  for (MeshVertex& vertex : ribbon.vertices) {
    vertex.influences[0] = {0, 0, 0, 1};
    vertex.halfWidth = 1e-6f;
  }
  ribbon.vertices[2].bones[0] = 1;
  ribbon.indices = {0, 1, 2};
  ribbon.lods[0].indexCount = 3;
  constexpr double wall = 10;
  const test::Sight sight(view_, kWidth, kHeight);
  std::vector<Agent> agents;
  for (const double x : {0.0, 0.5, -0.95})
    for (const double pixels : {0.48, 2.5}) {
      Agent& agent = agents.emplace_back();
      const glm::dvec3 ray = glm::normalize(sight.at(1, x, -x) - sight.eye);
      const double away = wall / glm::dot(ray, sight.forward), pixel = away * 2 * sight.tanY / kHeight;
      agent.place = sight.eye + ray * (away + pixels * pixel);
      agent.starts[0] = glm::dvec3(0);
      agent.starts[1] = 0.4 * ray;
      for (glm::dmat3& turn : agent.turns) turn = glm::dmat3(1);
    }
  const std::vector<float> depths(size_t(kWidth) * kHeight, float(0.05 / wall));
  EXPECT_EQ(shown(agents, ribbon, depths, Form::rotations),
            (std::vector{true, false, true, false, true, false}));
}

// Each vertex lies in the boxes of its bones, and one hull has those of all vertices of a triangle.
void expectHulls(const MeshData& mesh) {
  const std::vector<shared::HullBox> boxes = hullsOf(mesh);
  ASSERT_FALSE(boxes.empty());
  std::vector<std::vector<shared::HullBox>> hulls(1);
  for (const shared::HullBox& box : boxes) {
    hulls.back().push_back(box);
    if (int(box.centre.w) % 2 == 1) hulls.emplace_back();
  }
  EXPECT_TRUE(hulls.back().empty()) << "the last hull does not end";
  const auto holds = [](const shared::HullBox& box, const MeshVertex& vertex, size_t i) {
    const glm::vec3 off = glm::abs(glm::vec3(vertex.influences[i]) - glm::vec3(box.centre));
    return int(box.centre.w) / 2 == vertex.bones[i] &&
           glm::all(glm::lessThanEqual(off, glm::vec3(box.extents) + 1e-5f)) &&
           std::abs(vertex.halfWidth) <= box.extents.w;
  };
  for (const MeshLod& lod : mesh.lods)
    for (uint32_t i = 0; i < lod.indexCount; i += 3) {
      const auto inHull = [&](const std::vector<shared::HullBox>& hull) {
        for (uint32_t corner = i; corner < i + 3; ++corner) {
          const MeshVertex& vertex =
              mesh.vertices[size_t(lod.firstVertex) + mesh.indices[lod.firstIndex + corner]];
          for (size_t k = 0; k < 4; ++k)
            if (vertex.influences[k].w > 0 &&
                std::ranges::none_of(hull, [&](const shared::HullBox& box) { return holds(box, vertex, k); }))
              return false;
        }
        return true;
      };
      EXPECT_TRUE(std::ranges::any_of(hulls, inHull)) << "triangle at " << lod.firstIndex + i;
    }
}

TEST(Hulls, holdEveryTriangle) {
  const Rig spider = spiderRig(), piebald = loadRig(SKITTER_ASSETS "/piebald.glb");
  for (const Rig* rig : {&spider, &piebald}) {
    const MeshData mesh = makeMesh(*rig, limbsOf(*rig));
    expectHulls(mesh);
    // Not all are in one.
    EXPECT_GE(std::ranges::count_if(hullsOf(mesh),
                                    [](const shared::HullBox& box) { return int(box.centre.w) % 2 == 1; }),
              8);
  }
  EXPECT_TRUE(hullsOf({}).empty());
}

// A skin of which each triangle hangs on bones of its own.
TEST(Hulls, manyBoxesBecomeOneHull) {
  MeshData mesh;
  for (uint16_t bone = 0; bone < 130; ++bone)
    for (int corner = 0; corner < 3; ++corner) {
      MeshVertex vertex{};
      vertex.bones[0] = bone;
      vertex.bones[1] = uint16_t((bone + 1) % 130);
      vertex.influences[0] = {float(corner), float(bone), 1, 0.5f};
      vertex.influences[1] = {-1, float(corner), float(bone), 0.5f};
      mesh.indices.push_back(uint32_t(mesh.vertices.size()));
      mesh.vertices.push_back(vertex);
    }
  mesh.lods[0].indexCount = uint32_t(mesh.indices.size());
  expectHulls(mesh);
  EXPECT_EQ(hullsOf(mesh).size(), 130u);
  // With one bone fewer on each they are hulls of their own.
  for (MeshVertex& vertex : mesh.vertices) vertex.influences[1].w = 0;
  expectHulls(mesh);
  EXPECT_EQ(std::ranges::count_if(hullsOf(mesh),
                                  [](const shared::HullBox& box) { return int(box.centre.w) % 2 == 1; }),
            130);
}

}  // namespace
}  // namespace skitter::render
