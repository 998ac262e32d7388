// The crowd's tables of matrices and key poses, against the file of the model whose clips they are.
#include "crowd/clip_records.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "assets/files.h"
#include "assets/gltf_pose.h"
#include "cpu_reference/ik/kinematics.h"
#include "crowd/key_poses.h"
#include "crowd/rig_records.h"
#include "crowd/simulation.h"
#include "validation/convert.h"
#include "validation/convert_clip.h"

namespace skitter::test {
namespace {

glm::dvec3 transformed(const glm::dmat4& matrix, const glm::dvec3& p) {
  return glm::dvec3(matrix * glm::dvec4(p, 1));
}

// The spider's file with another way of its body in the walk.
class ModelClips {
 public:
  explicit ModelClips(const std::function<glm::vec3(float)>& bodyAt)
      : glb_(changed(bodyAt)),
        pose_(glb_),
        file_(written()),
        rig_(loadRig(file_)),
        set_(loadClips(file_, rig_)) {}

  const Rig& rig() const { return rig_; }
  const ClipSet& set() const { return set_; }
  double allowed() const { return 1e-4 * set_.size; }
  glm::dvec3 skinned(const std::string& clip, const std::string& node, double time,
                     const glm::dvec3& p) const {
    return transformed(pose_.at(clip, node, time) * pose_.inverseBind(node), p);
  }
  // Joint i of a leg, and the foot after the last one.
  glm::dvec3 jointAt(const std::string& clip, size_t leg, size_t i, double time) const {
    const std::vector<Bone>& bones = rig_.legs[leg].bones;
    const std::string name = i < bones.size() ? bones[i].joint : rig_.legs[leg].name + "_foot";
    return glm::dvec3(pose_.at(clip, name, time)[3]);
  }

 private:
  static Glb changed(const std::function<glm::vec3(float)>& bodyAt) {
    Glb glb = readGlb(SKITTER_ROOT "/assets/spider.glb");
    nlohmann::json& walk = glb.json["animations"][0];
    const size_t body = 1;
    const nlohmann::json channels = walk["channels"];
    for (size_t c = 0; c < channels.size(); ++c)
      if (channels[c]["target"] == nlohmann::json{{"node", body}, {"path", "translation"}}) {
        walk["channels"].erase(c);
        break;
      }
    std::vector<float> times, values;
    for (int key = 0; key <= 30; ++key) {
      times.push_back(0.02f * static_cast<float>(key));
      const glm::vec3 p = glm::vec3(0, 0.27f, 0) + bodyAt(times.back());
      values.insert(values.end(), {p.x, p.y, p.z});
    }
    const size_t input = glb.append(times, "SCALAR"), output = glb.append(values, "VEC3");
    walk["channels"].push_back(
        {{"sampler", walk["samplers"].size()}, {"target", {{"node", body}, {"path", "translation"}}}});
    walk["samplers"].push_back({{"input", input}, {"output", output}});
    return glb;
  }
  std::filesystem::path written() const {
    writeBytes(folder_ / "spider.glb", glb_.bytes());
    return folder_ / "spider.glb";
  }

  TemporaryFolder folder_;
  Glb glb_;
  GltfPose pose_;
  std::filesystem::path file_;
  Rig rig_;
  ClipSet set_;
};

// A body that walks on, 0.1 m above the ground of the file.
TEST(ClipRecords, TablesAreTheModels) {
  constexpr float way = 0.5f, height = 0.1f;
  const ModelClips model([](float time) { return glm::vec3(0, height, way * time); });
  const ClipSet& set = model.set();
  const int maxBones = model.rig().maxBones();
  const crowd::ClipRecords records = crowd::clipRecords(set, {"idle", "walk"}, maxBones);
  ASSERT_EQ(records.clips, 2);
  ASSERT_EQ(static_cast<size_t>(records.joints), set.joints.size());

  std::vector<std::pair<size_t, glm::dvec3>> points;  // entries, and what each moves
  for (size_t v = 0; v < set.vertices.size(); v += 15)
    for (int k = 0; k < 4; ++k)
      if (set.vertices[v].weights[k] > 0)
        points.emplace_back(set.vertices[v].bones[k], set.vertices[v].position);
  std::mt19937 random(3);
  for (const int c : {0, 1}) {
    const std::string name = c == 0 ? "idle" : "walk";
    SCOPED_TRACE(name);
    const float* head = &records.heads[4 * static_cast<size_t>(c)];
    const auto first = static_cast<size_t>(head[0]), frames = static_cast<size_t>(head[1]);
    EXPECT_NEAR(head[2], c == 0 ? 3 : 0.6, 1e-6);
    EXPECT_NEAR(head[3], c == 0 ? 0 : 1, 2e-3);
    EXPECT_NEAR(set.clip(name).ground, c == 0 ? 0 : height, 1e-3);
    const auto timeOf = [&](size_t frame) { return double{records.times[4 * (first + frame)]}; };
    for (size_t f = 0; f + 1 < frames; ++f)
      EXPECT_FLOAT_EQ(records.times[4 * (first + f) + 1],
                      static_cast<float>(1 / (timeOf(f + 1) - timeOf(f))));
    EXPECT_EQ(records.times[4 * (first + frames - 1) + 1], 0);
    for (int i = 0; i < 60; ++i) {
      const double time = std::uniform_real_distribution<double>(0, head[2])(random);
      size_t f = 0;
      while (f + 2 < frames && timeOf(f + 1) <= time) ++f;
      const double u = (time - timeOf(f)) * double{records.times[4 * (first + f) + 1]};
      const auto inTable = [&](size_t entry, const glm::dvec3& p) {
        glm::dvec3 sum(0);
        for (int r = 0; r < 3; ++r)
          for (const size_t frame : {f, f + 1}) {
            const float* row =
                &records
                     .rows[(((first + frame) * set.joints.size() + entry) * 3 + static_cast<size_t>(r)) * 4];
            sum[r] += (frame == f ? 1 - u : u) * (row[0] * p.x + row[1] * p.y + row[2] * p.z + row[3]);
          }
        return sum;
      };
      const glm::dvec3 taken(0, set.clip(name).ground, c == 0 ? 0 : double{way} * time);
      for (const auto& [entry, p] : points) {
        const glm::dvec3 exact = model.skinned(name, set.joints[entry].name, time, p) - taken;
        ASSERT_LE(glm::length(inTable(entry, p) - exact), model.allowed() + 1e-6)
            << set.joints[entry].name << " at " << time;
      }
      for (size_t leg = 0; leg < 8; ++leg) {
        for (size_t joint = 0; joint <= 4; ++joint) {
          const float* start = &records.legs[(leg * static_cast<size_t>(maxBones + 1) + joint) * 4];
          const glm::dvec3 p = inTable(static_cast<size_t>(start[3]), {start[0], start[1], start[2]});
          ASSERT_LE(glm::length(p - (model.jointAt(name, leg, joint, time) - taken)), model.allowed() + 1e-6)
              << "leg " << leg << ", joint " << joint << " at " << time;
        }
        // A frame's mask has the feet that are down; near where one lifts or lands, either.
        const double from = model.jointAt(name, leg, 4, timeOf(f) - 0.012).y - set.clip(name).ground,
                     to = model.jointAt(name, leg, 4, timeOf(f) + 0.012).y - set.clip(name).ground;
        const bool stands = (static_cast<uint32_t>(records.times[4 * (first + f) + 2]) >> leg & 1) != 0;
        if (std::min(from, to) > 0.02) {
          EXPECT_FALSE(stands) << "leg " << leg << " at " << timeOf(f);
        }
        if (timeOf(f) > 0.012 && std::max(from, to) < 0.002) {
          EXPECT_TRUE(stands) << "leg " << leg << " at " << timeOf(f);
        }
      }
    }
  }
  for (size_t entry = 0; entry < set.joints.size(); ++entry) {
    int place = -1;
    for (size_t leg = 0; leg < 8; ++leg)
      for (size_t bone = 0; bone < 4; ++bone) {
        const Leg& own = model.rig().legs[leg];
        const bool foot = bone == 3 && set.joints[entry].name == own.name + "_foot";
        if (foot || set.joints[entry].name == own.bones[bone].joint)
          place = static_cast<int>(leg) * maxBones + static_cast<int>(bone);
      }
    EXPECT_EQ(records.bones[4 * entry], static_cast<float>(place)) << set.joints[entry].name;
  }
}

// The legs of a body that stays where the rig has it begin at the rig's own roots, so that key poses need not
// be moved there: their joints are the model's. They take rounding of the lengths from joint to joint.
TEST(ClipRecords, KeyPosesAreTheModels) {
  const ModelClips model([](float) { return glm::vec3(0); });
  const Rig& rig = model.rig();
  const std::vector<float> rigRecords = crowd::rigRecords(rig);
  const reference::Creature creature =
      validation::creatureOf(rigRecords, rig.legCount(), rig.maxBones(), rig.groupCount());
  const double allowed = 8 * model.allowed();
  for (const uint32_t keys : {2u, 5u, 8u}) {
    const reference::KeyPoses poses = validation::keyPosesOf(
        crowd::keyPoses(model.set(), {}, keys, rig, rigRecords), rig.legCount(), rig.maxBones());
    EXPECT_NEAR(poses.stride, 0.6, 1e-3);
    for (size_t leg = 0; leg < 8; ++leg) {
      const reference::Limb& limb = creature.limbs[leg];
      const auto jointsOf = [&](const reference::KeyPoses::Directions& directions) {
        const reference::Posture posture(limb, directions);
        std::vector<glm::dvec3> joints;
        for (size_t i = 0; i <= 4; ++i) joints.push_back(limb.root + limb.reach * posture.joint(i));
        return joints;
      };
      for (uint32_t key = 0; key < keys; ++key) {
        SCOPED_TRACE(testing::Message() << "leg " << leg << ", key " << key << " of " << keys);
        const reference::KeyPoses::Leg& own = poses.legs[leg];
        // A tangent leads from a 64th of a cycle before to one after.
        const double aside = keys / 64.0;
        reference::KeyPoses::Directions before = own.keys[key], after = before;
        for (size_t i = 0; i < before.size(); ++i)
          before[i] -= aside * own.tangents[key][i], after[i] += aside * own.tangents[key][i];
        const auto at = jointsOf(own.keys[key]), from = jointsOf(before), to = jointsOf(after);
        for (size_t i = 0; i <= 4; ++i) {
          const auto inModel = [&](double phase) {
            return model.jointAt("walk", leg, i, 0.6 * (phase - std::floor(phase)));
          };
          const double phase = static_cast<double>(key) / keys;
          EXPECT_LE(glm::length(at[i] - inModel(phase)), allowed) << "joint " << i;
          const glm::dvec3 led = inModel(phase + 1 / 64.0) - inModel(phase - 1 / 64.0);
          EXPECT_LE(glm::length(to[i] - from[i] - led), allowed)
              << "joint " << i << ", led " << glm::length(led);
        }
      }
      const auto standing = jointsOf(poses.legs[leg].standing);
      // The body of idle stands where the rig's does at its first moment.
      for (size_t i = 0; i <= 4; ++i)
        EXPECT_LE(glm::length(standing[i] - model.jointAt("idle", leg, i, 0)), allowed) << "joint " << i;
    }
  }
}

}  // namespace
}  // namespace skitter::test
