#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "skitter/clip.h"

// The built-in spider's walk and idle, as they are baked.
namespace skitter {
namespace {

const ClipSet& clips() {
  static const ClipSet set = spiderClips();
  return set;
}

glm::vec3 footAt(const Clip& clip, size_t leg, float time) {
  size_t f = 0;
  while (f + 2 < clip.frames() && clip.times[f + 1] <= time) ++f;
  const float u = (time - clip.times[f]) / (clip.times[f + 1] - clip.times[f]);
  return glm::mix(clip.feet[f * 8 + leg], clip.feet[(f + 1) * 8 + leg], u);
}

// The phase of the walk at which a foot leaves the ground, by its height.
double liftPhase(const Clip& clip, size_t leg) {
  constexpr int steps = 600;
  for (int k = 0; k < steps; ++k) {
    const auto at = [&](int step) {
      return footAt(clip, leg, static_cast<float>(clip.seconds) * static_cast<float>(step % steps) / steps).y;
    };
    if (at(k) <= 0.002f && at(k + 1) > 0.002f) return static_cast<double>(k) / steps;
  }
  ADD_FAILURE() << "never lifts";
  return 0;
}

TEST(SpiderClips, WalkAndIdleOnTheRigsSkin) {
  const Rig rig = spiderRig();
  ASSERT_EQ(clips().clips.size(), 2u);
  EXPECT_TRUE(clips().notes.empty());
  EXPECT_EQ(clips().clip("walk").name, "walk");
  EXPECT_NEAR(clips().clip("idle").seconds, 3, 1e-6);
  ASSERT_EQ(clips().vertices.size(), rig.vertices.size());
  EXPECT_EQ(clips().indices, rig.indices);
  for (size_t v = 0; v < rig.vertices.size(); ++v) {
    EXPECT_LT(glm::length(clips().vertices[v].position - rig.vertices[v].position), 1e-6f);
    EXPECT_LT(glm::length(clips().vertices[v].normal - rig.vertices[v].normal), 1e-5f);
    EXPECT_EQ(clips().vertices[v].colour, rig.vertices[v].colour);
  }
  for (size_t l = 0; l < 8; ++l) {
    ASSERT_EQ(clips().legs[l].joints.size(), 5u);
    for (size_t i = 0; i < 5; ++i) {
      const ClipJoint& joint = clips().joints[clips().legs[l].joints[i]];
      EXPECT_EQ(joint.leg, static_cast<int>(l));
      EXPECT_EQ(joint.bone, static_cast<int>(std::min(i, size_t{3})));
      if (i < 4) {
        EXPECT_EQ(joint.name, rig.legs[l].bones[i].joint);
        EXPECT_LT(glm::length(clips().legs[l].starts[i] - rig.legs[l].bones[i].start), 1e-6f);
      }
    }
    EXPECT_LT(glm::length(clips().legs[l].starts[4] - rig.legs[l].home), 1e-6f);
  }
  EXPECT_EQ(clips().joints[0].leg, -1);
}

TEST(SpiderClips, StanceFeetGoStraightBackOnTheGround) {
  const Clip& walk = clips().clip("walk");
  const Rig rig = spiderRig();
  EXPECT_NEAR(walk.speed, 1, 1e-3);
  EXPECT_NEAR(walk.ground, 0, 1e-3);
  EXPECT_EQ(walk.rootVelocity, glm::vec3(0));
  constexpr int steps = 600;
  for (size_t leg = 0; leg < 8; ++leg) {
    SCOPED_TRACE(rig.legs[leg].name);
    int standing = 0;
    float highest = 0;
    for (int k = 0; k < steps; ++k) {
      const float time = static_cast<float>(walk.seconds) * static_cast<float>(k) / steps;
      const glm::vec3 foot = footAt(walk, leg, time);
      EXPECT_GT(foot.y, -1e-3f);
      highest = std::max(highest, foot.y);
      EXPECT_NEAR(foot.x, rig.legs[leg].home.x, 1e-3);
      EXPECT_NEAR(foot.z, rig.legs[leg].home.z, 0.2);
      standing += foot.y < 1e-3f;
    }
    EXPECT_NEAR(static_cast<double>(standing) / steps, 0.6, 0.05);
    EXPECT_NEAR(highest, 0.12, 0.003);
    // A loop: no jump from its end to its beginning.
    EXPECT_LT(glm::length(walk.feet[leg] - walk.feet[(walk.frames() - 1) * 8 + leg]), 1e-4f);
  }
}

TEST(SpiderClips, TetrapodsAlternateInTheOrderOfRealSpiders) {
  const Clip& walk = clips().clip("walk");
  const Rig rig = spiderRig();
  std::map<std::string, double> lift;
  for (size_t leg = 0; leg < 8; ++leg) lift[rig.legs[leg].name] = liftPhase(walk, leg);
  const auto after = [&](const std::string& a, const std::string& b) {
    const double phase = lift[b] - lift[a];
    return phase - std::floor(phase);
  };
  for (const std::string side : {"L", "R"}) {
    SCOPED_TRACE(side);
    const std::string other = side == "L" ? "R" : "L";
    // 4, soon 2; half a cycle after 4 comes 3, soon 1.
    EXPECT_NEAR(after(side + "4", side + "2"), 1 / 30.0, 0.01);
    EXPECT_NEAR(after(side + "4", side + "3"), 0.5 + 1 / 30.0, 0.01);
    EXPECT_NEAR(after(side + "3", side + "1"), 1 / 30.0, 0.01);
    for (const char* leg : {"1", "2", "3", "4"}) EXPECT_NEAR(after(side + leg, other + leg), 0.5, 0.01);
  }
}

// The bones keep their lengths, and each its cone about where the bone before carries its rest direction.
TEST(SpiderClips, PosesAreWithinTheRigsLimits) {
  const Rig rig = spiderRig();
  const size_t joints = clips().joints.size();
  for (const Clip& clip : clips().clips) {
    for (size_t f = 0; f < clip.frames(); ++f) {
      for (size_t l = 0; l < 8; ++l) {
        std::vector<glm::vec3> points;
        for (size_t i = 0; i < 5; ++i) {
          const glm::vec4* rows = clip.rows.data() + 3 * (f * joints + clips().legs[l].joints[i]);
          const glm::vec4 start(clips().legs[l].starts[i], 1);
          points.emplace_back(glm::dot(rows[0], start), glm::dot(rows[1], start), glm::dot(rows[2], start));
        }
        EXPECT_LT(glm::length(points[4] - clip.feet[f * 8 + l]), 1e-6f);
        glm::mat3 before(1);
        for (size_t i = 0; i < 4; ++i) {
          const Bone& bone = rig.legs[l].bones[i];
          const glm::vec3 along = points[i + 1] - points[i];
          EXPECT_NEAR(glm::length(along), bone.length, 2e-4) << clip.name << " " << f;
          const float cosine = glm::dot(glm::normalize(along), before * bone.direction);
          EXPECT_GT(cosine, std::cos(bone.coneHalfAngle));
          const glm::vec4* rows = clip.rows.data() + 3 * (f * joints + clips().legs[l].joints[i]);
          before = glm::transpose(glm::mat3(glm::vec3(rows[0]), glm::vec3(rows[1]), glm::vec3(rows[2])));
        }
        // Knees up.
        EXPECT_GT(points[2].y, points[1].y + 0.1f);
      }
    }
  }
}

TEST(SpiderClips, BodyIsSteadyAndIdleFeetStand) {
  const size_t body = 0;
  for (const Clip& clip : clips().clips) {
    float least = 10, most = -10;
    for (size_t f = 0; f < clip.frames(); ++f) {
      const float y = clip.rows[3 * f * clips().joints.size() + 3 * body + 1].w;
      least = std::min(least, y);
      most = std::max(most, y);
    }
    EXPECT_GT(most - least, 0.005f);
    EXPECT_LE(most - least, 0.0125f) << clip.name;
  }
  const Clip& idle = clips().clip("idle");
  EXPECT_EQ(idle.speed, 0);
  for (size_t k = 0; k < idle.feet.size(); ++k) {
    EXPECT_LT(glm::length(idle.feet[k] - idle.feet[k % 8]), 1e-4f);
    EXPECT_EQ(idle.stance[k], 1);
  }
}

}  // namespace
}  // namespace skitter
