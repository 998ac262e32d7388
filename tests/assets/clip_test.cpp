#include "skitter/clip.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <random>

#include "assets/models/clip_sampler.h"
#include "assets/rigs/placement.h"
#include "assets/rigs/rig_source.h"
#include "files.h"
#include "glb_builder.h"
#include "gltf_pose.h"
#include "made_models.h"
#include "skitter/rig_setup.h"

// Clips as they are baked, of files that nobody prepared and of the smallest rig with all sorts of channels.
namespace skitter {
namespace {

using test::Glb;
using test::inputFault;

Rig rigFor(const std::filesystem::path& file) {
  try {
    return proposedRig(file);
  } catch (const Error&) {
    return {};
  }
}

glm::dvec3 transform(const glm::vec4* rows, const glm::dvec3& p) {
  const glm::dvec4 point(p, 1);
  return {glm::dot(glm::dvec4(rows[0]), point), glm::dot(glm::dvec4(rows[1]), point),
          glm::dot(glm::dvec4(rows[2]), point)};
}

// A clip at a time, as a device has it.
std::vector<glm::vec4> play(const ClipSet& set, const Clip& clip, double time) {
  size_t f = clip.frames() - 1;
  while (f > 0 && static_cast<double>(clip.times[f]) > time) --f;
  const size_t n = 3 * set.joints.size();
  std::vector<glm::vec4> rows(clip.rows.begin() + static_cast<std::ptrdiff_t>(f * n),
                              clip.rows.begin() + static_cast<std::ptrdiff_t>((f + 1) * n));
  if (f + 1 == clip.frames()) return rows;
  const double from = static_cast<double>(clip.times[f]), to = static_cast<double>(clip.times[f + 1]);
  const auto u = static_cast<float>((time - from) / (to - from));
  for (size_t k = 0; k < n; ++k) rows[k] = glm::mix(rows[k], clip.rows[(f + 1) * n + k], u);
  return rows;
}

glm::dvec3 skin(const SkinVertex& vertex, const std::vector<glm::vec4>& rows) {
  glm::dvec3 sum(0);
  for (int k = 0; k < 4; ++k) {
    if (vertex.weights[k] > 0) {
      sum += static_cast<double>(vertex.weights[k]) *
             transform(rows.data() + 3 * vertex.bones[k], glm::dvec3(vertex.position));
    }
  }
  return sum;
}

// The file's vertices at a time, skinned by what the file says and nothing of what was baked: the largest
// distance to the baked ones, at shares of every interval.
double worstMiss(const std::filesystem::path& file, const ClipSet& set, size_t index) {
  const RigSource source = loadRigSource(file, NoLegs::proposed);
  const Placement placement = placeModel(source.model, source.setup.legs.empty() ? RigSetup() : source.setup,
                                         source.name, source.path);
  const gltf::Document& document = source.document;
  const Clip& clip = set.clips[index];
  ClipSampler sampler(document, document.clips[index], document.parentsFirst, glm::dmat4(1));
  double worst = 0;
  for (size_t f = 0; f + 1 < clip.frames(); ++f) {
    for (const double share : {0.0, 0.1, 0.25, 0.4, 0.5, 0.75, 0.9}) {
      const double from = static_cast<double>(clip.times[f]), to = static_cast<double>(clip.times[f + 1]);
      // Keys are not all single-precision numbers: at a jump the frame's time may be the moment before.
      if (share == 0 && (f == 0 || clip.times[f - 1] == clip.times[f] || from == to)) continue;
      const double time = from + share * (to - from);
      const std::vector<glm::vec4> rows = play(set, clip, time);
      const std::vector<glm::dmat4>& modelFromNode = sampler.sample(time);
      size_t v = 0;
      for (size_t n = 0; n < document.nodes.size(); ++n) {
        const gltf::Node& node = document.nodes[n];
        if (!node.inScene || node.mesh == -1) continue;
        for (const gltf::Primitive& part : document.meshes[static_cast<size_t>(node.mesh)].primitives) {
          for (size_t p = 0; p < part.positions.size(); ++p, ++v) {
            glm::dmat4 matrix = modelFromNode[n];
            if (node.skin != -1) {
              const gltf::Skin& from_ = document.skins[static_cast<size_t>(node.skin)];
              matrix = glm::dmat4(0);
              double total = 0;
              for (size_t k = 0; k < part.influencesPerVertex; ++k) {
                const gltf::Influence& influence = part.influences[p * part.influencesPerVertex + k];
                matrix +=
                    influence.weight * (modelFromNode[static_cast<size_t>(from_.joints[influence.joint])] *
                                        from_.nodeFromBind[influence.joint]);
                total += influence.weight;
              }
              matrix /= total;
            }
            if (v % 3 != f % 3) continue;  // a third of them an interval
            const glm::dvec3 exact =
                placement.toCreature(glm::dvec3(matrix * glm::dvec4(part.positions[p], 1))) -
                glm::dvec3(clip.rootVelocity) * time;
            worst = std::max(worst, glm::length(exact - skin(set.vertices[v], rows)));
          }
        }
      }
    }
  }
  return worst;
}

class MadeClips : public ::testing::Test {
 protected:
  MadeClips() { test::writeMadeModels(folder_.path()); }

  test::TemporaryFolder folder_;
};

// Metres that a unit of the model has become.
double scaleOf(const Model& model, const Rig& rig) {
  const Leg& leg = rig.legs[0];
  const auto at = [&](const std::string& joint) {
    const auto named = [&](const Model::Node& node) { return node.name == joint; };
    return std::find_if(model.nodes.begin(), model.nodes.end(), named)->position();
  };
  return double{leg.bones[0].length} / glm::distance(at(leg.bones[0].joint), at(leg.bones[1].joint));
}

TEST_F(MadeClips, AsTheyCome) {
  struct Expected {
    const char* file;
    size_t clips, joints;
  };
  for (const Expected& expected :
       {Expected{"fox.glb", 3, 23}, Expected{"spider.gltf", 1, 49}, Expected{"figure.glb", 1, 19},
        Expected{"column.glb", 1, 2}, Expected{"simple_skin.gltf", 1, 2}, Expected{"step_skin.gltf", 1, 2},
        Expected{"interpolations.gltf", 9, 10}}) {
    const std::filesystem::path file = folder_ / expected.file;
    const ClipSet set = loadClips(file, rigFor(file));
    EXPECT_EQ(set.joints.size(), expected.joints) << expected.file;
    ASSERT_EQ(set.clips.size(), expected.clips) << expected.file;
    EXPECT_TRUE(set.notes.empty());
    for (size_t i = 0; i < set.clips.size(); ++i) {
      const Clip& clip = set.clips[i];
      SCOPED_TRACE(std::string(expected.file) + " " + clip.name);
      EXPECT_LE(clip.error, 1e-4 * set.size);
      EXPECT_LE(worstMiss(file, set, i), 1e-4 * set.size);
      EXPECT_EQ(clip.times.front(), 0);
      EXPECT_EQ(clip.times.back(), static_cast<float>(clip.seconds));
      EXPECT_EQ(clip.rows.size(), 3 * clip.frames() * set.joints.size());
      EXPECT_EQ(clip.feet.size(), clip.frames() * set.legs.size());
      EXPECT_EQ(clip.stance.size(), clip.feet.size());
      EXPECT_TRUE(std::is_sorted(clip.times.begin(), clip.times.end()));
      EXPECT_LE(clip.frames(), 300u);
      for (double t = 0; t <= clip.seconds; t += clip.seconds / 7) {
        const std::vector<glm::vec4> rows = play(set, clip, t);
        for (const SkinVertex& vertex : set.vertices) {
          const glm::vec3 p(skin(vertex, rows));
          EXPECT_TRUE(glm::all(glm::greaterThanEqual(p, clip.least - 1e-5f)) &&
                      glm::all(glm::lessThanEqual(p, clip.most + 1e-5f)));
        }
      }
    }
  }
}

TEST_F(MadeClips, FoxWalksRunsAndStands) {
  const Model model = loadModel(folder_ / "fox.glb");
  const Rig rig = proposedRig(folder_ / "fox.glb");
  const ClipSet set = loadClips(folder_ / "fox.glb", rig);
  const double scale = scaleOf(model, rig);
  EXPECT_EQ(set.clip("Survey").speed, 0);
  // The keys lie on the way of the feet; between them, joints that turn carry a foot off it.
  EXPECT_NEAR(set.clip("Walk").speed, test::madeFoxWalk * scale, 0.02 * test::madeFoxWalk * scale);
  EXPECT_NEAR(set.clip("Run").speed, test::madeFoxRun * scale, 0.02 * test::madeFoxRun * scale);
  const double rest = (1 - proposeRig(model).setup.origin->y) * scale;  // feet rest at a height of 1
  for (const Clip& clip : set.clips) {
    EXPECT_EQ(clip.rootVelocity, glm::vec3(0)) << "it runs on the spot";
    EXPECT_NEAR(clip.ground, rest, 0.01);
  }
  for (const uint8_t stands : set.clip("Survey").stance) EXPECT_EQ(stands, 1);
  // Nearly always a paw stands.
  const Clip& walk = set.clip("Walk");
  size_t none = 0;
  for (size_t f = 0; f < walk.frames(); ++f) {
    int standing = 0;
    for (size_t l = 0; l < 4; ++l) standing += walk.stance[4 * f + l];
    none += standing == 0;
  }
  EXPECT_LE(none, walk.frames() / 20);
}

TEST_F(MadeClips, AWalkCutOutOfATake) {
  const std::filesystem::path file = folder_ / "spider.gltf";
  const Rig rig = proposedRig(file);
  const ClipCut cut{"Take", "walk", test::madeSpiderWalks, test::madeSpiderWalks + test::madeSpiderCycle};
  const ClipSet set = loadClips(file, rig, std::span(&cut, 1));
  ASSERT_EQ(set.clips.size(), 2u);
  const Clip &whole = set.clips[0], &walk = set.clip("walk");
  EXPECT_NEAR(walk.seconds, test::madeSpiderCycle, 1e-6);
  EXPECT_LE(walk.error, 1e-4 * set.size);
  // Feet that stand are carried straight back, so nothing but single precision is lost.
  EXPECT_NEAR(walk.speed, test::madeSpiderSpeed * scaleOf(loadModel(file), rig), 1e-3);
  for (double t = 0; t <= walk.seconds; t += 0.01) {
    const std::vector<glm::vec4> part = play(set, walk, t), all = play(set, whole, test::madeSpiderWalks + t);
    for (const SkinVertex& vertex : set.vertices) {
      const glm::dvec3 given(static_cast<double>(walk.rootVelocity.x) * t, 0,
                             static_cast<double>(walk.rootVelocity.z) * t);
      EXPECT_LT(glm::length(skin(vertex, part) + given - skin(vertex, all)), 2.1e-4 * set.size);
    }
  }
  for (const ClipCut& wrong :
       {ClipCut{"none", "walk", 0, 1}, ClipCut{"Take", "walk", 2, 2}, ClipCut{"Take", "walk", -1, 2},
        ClipCut{"Take", "walk", 0, 5.1}, ClipCut{"Take", "walk", 0, NAN}}) {
    const std::string what = inputFault([&] { loadClips(file, rig, std::span(&wrong, 1)); });
    EXPECT_NE(what.find("spider.gltf: cut \"walk\" is"), std::string::npos) << what;
  }
}

class SmallClips : public ::testing::Test {
 protected:
  // The smallest rig, its skin bound in its rest pose.
  static Glb small() {
    Glb glb = test::smallestRig();
    std::vector<float> bind;
    const float offsets[4][3] = {{0, -1, 0}, {0, -1, 0}, {-1, -1, 0}, {-1, 0, 0}};
    for (const auto& offset : offsets) {
      bind.insert(bind.end(), {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, offset[0], offset[1], offset[2], 1});
    }
    glb.json["skins"][0]["inverseBindMatrices"] = glb.append(bind, "MAT4");
    return glb;
  }
  static void move(Glb& glb, const std::string& node, const char* path, const char* interpolation,
                   const std::vector<float>& times, const std::vector<float>& values) {
    size_t index = 0;
    while (glb.json["nodes"][index].value("name", "") != node) ++index;
    glb.animate(index, path, interpolation, times, values);
  }
  ClipSet load(const Glb& glb) const {
    test::writeBytes(folder_ / "odd.glb", glb.bytes());
    return loadClips(folder_ / "odd.glb", loadRig(folder_ / "odd.glb"));
  }
  static size_t joint(const ClipSet& set, const std::string& name) {
    size_t j = 0;
    while (set.joints.at(j).name != name) ++j;
    return j;
  }
  static glm::dvec3 at(const ClipSet& set, const Clip& clip, size_t frame, size_t joint,
                       const glm::dvec3& p) {
    return transform(clip.rows.data() + 3 * (frame * set.joints.size() + joint), p);
  }

  test::TemporaryFolder folder_;
};

TEST_F(SmallClips, AJumpIsTwoFramesAtOneTime) {
  Glb glb = small();
  move(glb, "knee", "translation", "STEP", {0, 1, 2, 3}, {1, 0, 0, 2, 0, 0, 2, 0, 0, 4, 0, 0});
  const ClipSet set = load(glb);
  const Clip& clip = set.clips.at(0);
  // No jump at 2, where the value stays.
  EXPECT_EQ(clip.times, (std::vector<float>{0, 1, 1, 3, 3}));
  const size_t knee = joint(set, "knee");
  const double x[] = {1, 1, 2, 2, 4};
  for (size_t f = 0; f < 5; ++f) EXPECT_EQ(at(set, clip, f, knee, {1, 1, 0}), glm::dvec3(x[f], 1, 0)) << f;
  EXPECT_EQ(clip.error, 0);
}

TEST_F(SmallClips, RootMotionComesBackExactly) {
  Glb glb = small();
  // Its way forward and to the left, not even, with a hop; and a leg that turns meanwhile.
  move(glb, "body", "translation", "LINEAR", {0, 0.5f, 2}, {0, 1, 0, 1, 1.5f, 4, 2, 1.25f, 6});
  move(glb, "knee", "rotation", "LINEAR", {0, 2}, {0, 0, 0, 1, 0, 0, 0.70710678f, 0.70710678f});
  const ClipSet set = load(glb);
  const Clip& clip = set.clips.at(0);
  EXPECT_EQ(clip.rootVelocity, glm::vec3(1, 0, 3));
  const size_t body = joint(set, "body");
  const glm::dvec3 path[] = {{0, 1, 0}, {1, 1.5, 4}, {2, 1.25, 6}};
  const float times[] = {0, 0.5f, 2};
  for (size_t k = 0; k < 3; ++k) {
    size_t f = 0;
    while (clip.times[f] != times[k]) ++f;
    const glm::dvec3 there =
        at(set, clip, f, body, {0, 1, 0}) + glm::dvec3(clip.rootVelocity) * static_cast<double>(times[k]);
    EXPECT_LT(glm::length(there - path[k]), 1e-6);
  }
  // The height it gained stays in the frames.
  EXPECT_NEAR(at(set, clip, clip.frames() - 1, body, {0, 1, 0}).y, 1.25, 1e-6);
}

TEST_F(SmallClips, SpeedIsThatOfAFootThatStands) {
  // A foot that goes back on the ground for 0.6 s at 0.5 m/s and forward through the air for 0.4 s.
  Glb glb = small();
  move(glb, "hip", "translation", "LINEAR", {0, 0.6f, 0.8f, 1},
       {0, 0, 0.15f, 0, 0, -0.15f, 0, 0.3f, 0, 0, 0, 0.15f});
  const ClipSet set = load(glb);
  EXPECT_NEAR(set.clips.at(0).speed, 0.5, 1e-3);
  EXPECT_NEAR(set.clips[0].ground, 0, 1e-3);
  // The same, carried forward by its root: the feet stand in the file, and the speed is the same.
  move(glb, "body", "translation", "LINEAR", {0, 1}, {0, 1, 0, 0, 1, 0.5f});
  const ClipSet carried = load(glb);
  EXPECT_NEAR(carried.clips.at(0).rootVelocity.z, 0.5, 1e-6);
  EXPECT_NEAR(carried.clips[0].speed, 0.5, 1e-3);
  // Backward.
  Glb back = small();
  move(back, "hip", "translation", "LINEAR", {0, 0.6f, 0.8f, 1},
       {0, 0, -0.15f, 0, 0, 0.15f, 0, 0.3f, 0, 0, 0, -0.15f});
  EXPECT_NEAR(load(back).clips.at(0).speed, -0.5, 1e-3);
}

TEST_F(SmallClips, ShearComesOutRight) {
  Glb glb = small();
  move(glb, "body", "scale", "LINEAR", {0, 1}, {1, 1, 1, 1, 3, 1});
  move(glb, "knee", "rotation", "LINEAR", {0, 1}, {0, 0, 0, 1, 0, 0, 0.70710678f, 0.70710678f});
  const ClipSet set = load(glb);
  const Clip& clip = set.clips.at(0);
  // The shin turned to the right, and then everything drawn out upward from the body at (0, 1, 0).
  EXPECT_LT(glm::length(glm::dvec3(clip.feet.back()) - glm::dvec3(2, 1, 0)), 1e-6);
  // A point of the shin to the right of its knee goes up, three times as far as it lay off.
  const size_t knee = joint(set, "knee");
  EXPECT_LT(glm::length(at(set, clip, clip.frames() - 1, knee, {2, 1, 0}) - glm::dvec3(1, 4, 0)), 1e-6);
  EXPECT_LE(clip.error, 1e-4 * set.size);
}

TEST_F(SmallClips, PosesSingleKeysAndLateFirstKeys) {
  Glb glb = small();
  move(glb, "knee", "translation", "LINEAR", {0}, {3, 0, 0});
  ClipSet set = load(glb);
  EXPECT_EQ(set.clips.at(0).times, std::vector<float>{0});
  EXPECT_EQ(set.clips[0].seconds, 0);
  EXPECT_EQ(at(set, set.clips[0], 0, joint(set, "knee"), {1, 1, 0}), glm::dvec3(3, 1, 0));
  // One key at 2 s: held from 0.
  glb = small();
  move(glb, "knee", "translation", "STEP", {2}, {3, 0, 0});
  set = load(glb);
  EXPECT_EQ(set.clips.at(0).times, (std::vector<float>{0, 2}));
  EXPECT_EQ(at(set, set.clips[0], 0, joint(set, "knee"), {1, 1, 0}), glm::dvec3(3, 1, 0));
}

// A channel with keys at random times.
void moveAtRandom(Glb& glb, const std::string& node, const std::string& path,
                  const std::string& interpolation, std::mt19937& random) {
  const auto uniform = [&](float low, float high) {
    return std::uniform_real_distribution<float>(low, high)(random);
  };
  std::vector<float> times, values, rest(3, path == "scale" ? 1.0f : 0.0f);
  if (path == "translation") rest = glb.node(node).value("translation", rest);
  const auto value = [&] {
    if (path == "rotation") {
      const glm::quat q =
          glm::normalize(glm::quat(1, uniform(-0.4f, 0.4f), uniform(-0.4f, 0.4f), uniform(-0.4f, 0.4f)));
      values.insert(values.end(), {q.x, q.y, q.z, q.w});
    } else {
      for (const float v : rest) values.push_back(v + uniform(-0.3f, 0.3f));
    }
  };
  const auto tangent = [&] {
    for (size_t k = 0; k < (path == "rotation" ? 4 : 3); ++k) values.push_back(uniform(-2, 2));
  };
  float time = 0;
  for (int key = 0; key < 5; ++key, time += uniform(0.05f, 0.4f)) {
    times.push_back(time);
    if (interpolation == "CUBICSPLINE") tangent();
    value();
    if (interpolation == "CUBICSPLINE") tangent();
  }
  size_t index = 0;
  while (glb.json["nodes"][index].value("name", "") != node) ++index;
  glb.animate(index, path, interpolation, times, values);
}

// How far the frames, as `docs/clip.md` plays them, are from the file's own nodes at `samples` random times:
// of what a palette entry moves, which are its vertices and the joint of its leg.
double worstOf(const Glb& glb, const ClipSet& set, const Clip& clip, int samples, std::mt19937& random) {
  const test::GltfPose pose(glb);
  std::vector<std::pair<size_t, glm::dvec3>> points;
  for (const SkinVertex& vertex : set.vertices)
    for (int k = 0; k < 4; ++k)
      if (vertex.weights[k] > 0) points.emplace_back(vertex.bones[k], vertex.position);
  for (const ClipLeg& leg : set.legs)
    for (size_t i = 0; i < leg.joints.size(); ++i) points.emplace_back(leg.joints[i], leg.starts[i]);
  double worst = 0;
  for (int i = 0; i < samples; ++i) {
    const double time = std::uniform_real_distribution<double>(0, clip.seconds)(random);
    size_t f = 0;
    while (f + 2 < clip.frames() && double{clip.times[f + 1]} <= time) ++f;
    const double from = clip.times[f], u = (time - from) / (double{clip.times[f + 1]} - from);
    for (const auto& [entry, point] : points) {
      const auto frameAt = [&, e = entry, p = point](size_t frame) {
        return transform(&clip.rows[3 * (frame * set.joints.size() + e)], p);
      };
      const std::string& node = set.joints[entry].name;
      const glm::dmat4 matrix = pose.at(clip.name, node, time) * pose.inverseBind(node);
      const glm::dvec3 exact =
          glm::dvec3(matrix * glm::dvec4(point, 1)) - time * glm::dvec3(clip.rootVelocity);
      worst = std::max(worst, glm::length((1 - u) * frameAt(f) + u * frameAt(f + 1) - exact));
    }
  }
  return worst;
}

// Whatever moves, and however it does between its keys.
TEST_F(SmallClips, NoMomentErrsMore) {
  constexpr const char* kinds[] = {"STEP", "LINEAR", "CUBICSPLINE"};
  constexpr const char* paths[] = {"translation", "rotation", "scale"};
  constexpr const char* nodes[] = {"body", "hip", "knee", "foot"};
  std::mt19937 random(7);
  for (const std::string kind : kinds)
    for (const std::string path : paths)
      for (const std::string node : nodes) {
        Glb glb = small();
        moveAtRandom(glb, node, path, kind, random);
        const ClipSet set = load(glb);
        const double worst = worstOf(glb, set, set.clips.at(0), 150, random);
        EXPECT_LE(worst, 1e-4 * set.size) << kind << " " << path << " of " << node;
        EXPECT_LE(worst, set.clips[0].error + 1e-6) << kind << " " << path << " of " << node;
      }
  for (int mixture = 0; mixture < 4; ++mixture) {
    Glb glb = small();
    for (const char* node : nodes)
      for (const char* path : paths) moveAtRandom(glb, node, path, kinds[random() % 3], random);
    const ClipSet set = load(glb);
    const double worst = worstOf(glb, set, set.clips.at(0), 150, random);
    EXPECT_LE(worst, 1e-4 * set.size) << "mixture " << mixture;
    EXPECT_LE(worst, set.clips[0].error + 1e-6) << "mixture " << mixture;
  }
}

// Curves that are small at all quarter points between keys and largest elsewhere: each is the cubic that
// grows most beyond them, in an interval of its own, beside one key, and between two.
TEST_F(SmallClips, NoCubicErrsMoreBetweenTheQuarterPoints) {
  struct Curve {
    std::vector<float> values, in, out;  // at keys a second apart, and slopes there
  };
  const double size = load(small()).size;
  for (const Curve& curve : {Curve{{0, 0}, {0, -4 / 3.0f}, {20 / 3.0f, 0}},
                             Curve{{0, -1, 0}, {0, 13 / 3.0f, 1}, {29 / 3.0f, 1, 0}},
                             Curve{{0, 1, 1, 0}, {0, 1, 16, -1}, {1, 16 / 3.0f, -1, 0}}}) {
    Glb glb = small();
    std::vector<float> times, values;
    const auto scale = static_cast<float>(0.99e-4 * size);
    for (size_t key = 0; key < curve.values.size(); ++key) {
      times.push_back(static_cast<float>(key));
      for (const float x : {scale * curve.in[key], 1 + scale * curve.values[key], scale * curve.out[key]})
        values.insert(values.end(), {x, 0, 0});
    }
    move(glb, "knee", "translation", "CUBICSPLINE", times, values);
    const ClipSet set = load(glb);
    std::mt19937 random(1);
    const double worst = worstOf(glb, set, set.clips.at(0), 600, random);
    EXPECT_LE(worst, 1e-4 * set.size) << times.size() << " keys";
    EXPECT_LE(worst, set.clips[0].error) << times.size() << " keys";
    EXPECT_GT(set.clips[0].frames(), 2u) << times.size() << " keys";
  }
}

TEST_F(SmallClips, AFaultOfAllChannelsCostsTheClip) {
  const std::pair<std::function<void(Glb&)>, const char*> cases[] = {
      {[](Glb& g) {
         move(g, "knee", "translation", "LINEAR", {0, 1}, {1, 0, 0});
       },
       "1 outputs for 2 keys, expected 2"},
      {[](Glb& g) {
         move(g, "knee", "translation", "CUBICSPLINE", {0, 1}, {1, 0, 0, 1, 0, 0});
       },
       "2 outputs for 2 keys, expected 6"},
      {[](Glb& g) {
         move(g, "knee", "translation", "SMOOTH", {0}, {1, 0, 0});
       },
       "interpolation is \"SMOOTH\""},
  };
  for (const auto& [change, expected] : cases) {
    Glb glb = small();
    change(glb);
    EXPECT_TRUE(load(glb).clips.empty()) << expected;
    const Model model = loadModel(folder_ / "odd.glb");
    ASSERT_EQ(model.notes.size(), 1u) << expected;
    EXPECT_NE(model.notes[0].find(expected), std::string::npos) << model.notes[0];
    EXPECT_NE(model.notes[0].find("clip left out"), std::string::npos) << model.notes[0];
  }
}

TEST_F(SmallClips, WhatCannotMoveIsLeftOutAlone) {
  Glb glb = small();
  move(glb, "knee", "translation", "LINEAR", {0, 1}, {1, 0, 0, 2, 0, 0});
  move(glb, "foot", "translation", "LINEAR", {0, 1}, {0, -1, 0, 0, 5, 0});
  glb.node("foot").erase("translation");
  glb.node("foot")["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1};
  const ClipSet set = load(glb);
  EXPECT_LT(glm::length(set.clips.at(0).feet.back() - glm::vec3(2, 0, 0)), 1e-6f);
  EXPECT_NE(loadModel(folder_ / "odd.glb").notes.at(0).find("moves nodes[4], which has a matrix: not moved"),
            std::string::npos);
}

TEST_F(SmallClips, WhatTakesTooMuchIsLeftOutSoon) {
  const std::pair<std::function<void(Glb&)>, const char*> cases[] = {
      // Back and forth at each of 10,000 keys.
      {[](Glb& g) {
         std::vector<float> times, values;
         for (int k = 0; k < 10000; ++k) {
           times.push_back(static_cast<float>(k) * 0.01f);
           values.insert(values.end(), {k % 2 ? 1.0f : 1.5f, 0, 0});
         }
         move(g, "knee", "translation", "LINEAR", times, values);
       },
       "takes over 4096 frames to err by"},
      {[](Glb& g) {
         move(g, "knee", "translation", "LINEAR", {0, 1e30f}, {1, 0, 0, 2, 0, 0});
       },
       "expected up to 86400"},
      {[](Glb& g) {
         move(g, "knee", "translation", "LINEAR", {0, 1}, {1, 0, 0, 2e6f, 0, 0});
       },
       "carries skin"},
      {[](Glb& g) {
         move(g, "knee", "scale", "LINEAR", {0, 1}, {1, 1, 1, 3e38f, 1, 1});
       },
       "has a matrix that holds"},
  };
  for (const auto& [change, expected] : cases) {
    Glb glb = small();
    change(glb);
    const auto start = std::chrono::steady_clock::now();
    const ClipSet set = load(glb);
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5)) << expected;
    EXPECT_TRUE(set.clips.empty());
    ASSERT_EQ(set.notes.size(), 1u) << expected;
    EXPECT_NE(set.notes[0].find(expected), std::string::npos) << set.notes[0];
    EXPECT_EQ(set.notes[0].find("clip 0 \"clip\": "), 0u) << set.notes[0];
  }
}

TEST_F(SmallClips, ManyClipsOfManyNodesEndSoon) {
  Glb glb = small();
  move(glb, "knee", "translation", "LINEAR", {0, 1}, {1, 0, 0, 2, 0, 0});
  const nlohmann::json clip = glb.json["animations"][0];
  glb.json["animations"] = std::vector<nlohmann::json>(10000, clip);
  for (int i = 0; i < 50000; ++i) glb.json["nodes"].push_back(nlohmann::json::object());
  const auto start = std::chrono::steady_clock::now();
  const ClipSet set = load(glb);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
  EXPECT_GT(set.clips.size(), 1000u);
  EXPECT_EQ(set.clips.size() + set.notes.size(), 10000u);
  EXPECT_NE(set.notes.at(0).find("take too long to bake"), std::string::npos);
}

TEST_F(SmallClips, ARigOfAnotherFileIsRefused) {
  Glb glb = small();
  test::writeBytes(folder_ / "odd.glb", glb.bytes());
  const std::string what = inputFault([&] { loadClips(folder_ / "odd.glb", spiderRig()); });
  EXPECT_NE(what.find("odd.glb: the rig given is not of this file"), std::string::npos) << what;
  EXPECT_NE(inputFault([&] { load(glb).clip("walk"); }).find("no clip is named \"walk\", and there is none"),
            std::string::npos);
}

// The rest pose need not be the one in which the skin was bound.
TEST_F(SmallClips, SkinBoundInAnotherPose) {
  Glb glb = small();
  move(glb, "knee", "rotation", "LINEAR", {0, 1}, {0, 0, 0, 1, 0, 0, 0.70710678f, 0.70710678f});
  const ClipSet plain = load(glb);
  glb.node("knee")["rotation"] = {0, 0, -0.70710678, 0.70710678};
  const ClipSet turned = load(glb);
  EXPECT_GT(glm::length(loadRig(folder_ / "odd.glb").vertices[2].position - plain.vertices[2].position),
            0.5f);
  for (const double t : {0.0, 0.3, 1.0}) {
    const auto a = play(plain, plain.clips.at(0), t), b = play(turned, turned.clips.at(0), t);
    for (size_t v = 0; v < 3; ++v) {
      EXPECT_LT(glm::length(skin(plain.vertices[v], a) - skin(turned.vertices[v], b)), 2e-4 * plain.size);
      EXPECT_LT(glm::length(turned.vertices[v].position - plain.vertices[v].position), 1e-6f);
    }
  }
  EXPECT_LT(glm::length(plain.clips[0].feet.back() - turned.clips[0].feet.back()), 1e-6f);
}

}  // namespace
}  // namespace skitter
