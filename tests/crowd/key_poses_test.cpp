// Key poses as they are made of a clip, and what is refused.
#include "crowd/key_poses.h"

#include "cpu_reference/ik/kinematics.h"
#include "cpu_reference/stages/clip.h"
#include "cpu_reference/stages/swing_clip.h"
#include "crowd/clip_records.h"
#include "crowd/rig_records.h"
#include "crowd/simulation.h"
#include "skitter/error.h"
#include "validation/convert.h"
#include "validation/convert_clip.h"

namespace skitter::test {
namespace {

class KeyPosesTest : public testing::Test {
 protected:
  reference::KeyPoses of(uint32_t keys, const std::vector<std::string>& names = {}) const {
    return validation::keyPosesOf(crowd::keyPoses(clips, names, keys, rig, rigRecords), rig.legCount(),
                                  rig.maxBones());
  }
  std::string refusalOf(uint32_t keys, const std::vector<std::string>& names) const {
    try {
      of(keys, names);
    } catch (const Error& error) {
      return error.what();
    }
    return {};
  }
  glm::dvec3 footOf(size_t leg, const reference::KeyPoses::Directions& directions) const {
    const reference::Limb& limb = creature.limbs[leg];
    return limb.root + limb.reach * reference::Posture(limb, directions).tip();
  }

  const Rig rig = spiderRig();
  const std::vector<float> rigRecords = crowd::rigRecords(rig);
  const reference::Creature creature =
      validation::creatureOf(rigRecords, rig.legCount(), rig.maxBones(), rig.groupCount());
  const ClipSet clips = spiderClips();
};

// Whatever the body of the clip does, feet are where the clip has them.
TEST_F(KeyPosesTest, FeetAreTheClips) {
  const reference::ClipTable table = validation::clipTableOf(
      crowd::clipRecords(clips, {"walk", "idle"}, rig.maxBones()), rig.legCount(), rig.maxBones());
  const auto footInClip = [&](int clip, double time, size_t leg) {
    reference::Play play;
    play.to.clip = clip;
    play.to.time = time;
    reference::findFrame(table, play.to);
    play.from = play.to;
    return reference::clipLeg(table, creature.limbs[leg], leg, play).joints.back();
  };
  const double seconds = table.clips[0].seconds;
  for (const uint32_t keys : {2u, 5u, 8u}) {
    const reference::KeyPoses poses = of(keys);
    EXPECT_NEAR(poses.stride, table.clips[0].speed * seconds, 1e-6);
    for (size_t l = 0; l < 8; ++l) {
      ASSERT_EQ(poses.legs[l].keys.size(), keys);
      EXPECT_LT(glm::length(footOf(l, poses.legs[l].standing) - footInClip(1, 0, l)), 1e-4);
      for (uint32_t k = 0; k < keys; ++k)
        EXPECT_LT(glm::length(footOf(l, poses.legs[l].keys[k]) - footInClip(0, seconds * k / keys, l)), 1e-4)
            << "leg " << l << ", key " << k;
    }
  }
}

// From the clip's own masks, at times of no frame.
TEST_F(KeyPosesTest, FeetStandWhenTheClipsDo) {
  const auto walk =
      std::find_if(clips.clips.begin(), clips.clips.end(), [](const Clip& c) { return c.name == "walk"; });
  const reference::KeyPoses poses = of(4);
  for (size_t l = 0; l < 8; ++l) {
    const reference::KeyPoses::Leg& leg = poses.legs[l];
    EXPECT_GT(leg.stand, 0.5);
    EXPECT_LT(leg.stand, 0.75);
    for (size_t f = 0; f + 1 < walk->frames(); ++f) {
      if (walk->times[f + 1] - walk->times[f] < 1e-4) continue;
      const double phase = (0.5 * walk->times[f] + 0.5 * walk->times[f + 1]) / walk->seconds;
      const double since = phase - leg.land - std::floor(phase - leg.land);
      EXPECT_EQ(since < leg.stand, walk->stance[f * 8 + l] == 1) << "leg " << l << " at " << phase;
    }
  }
}

TEST_F(KeyPosesTest, TangentsAreTheWayOn) {
  const reference::KeyPoses few = of(4), many = of(8);
  for (size_t l = 0; l < 8; ++l)
    for (size_t k = 0; k < 4; ++k)
      for (size_t i = 0; i < 4; ++i)
        EXPECT_LT(glm::length(few.legs[l].tangents[k][i] - 2.0 * many.legs[l].tangents[2 * k][i]), 1e-5);
}

TEST_F(KeyPosesTest, WithoutAStandingClipLegsStandAtRest) {
  const reference::KeyPoses poses = of(4, {"walk"});
  for (const reference::KeyPoses::Leg& leg : poses.legs)
    for (const glm::dvec2& direction : leg.standing) EXPECT_EQ(direction, glm::dvec2(0));
}

TEST_F(KeyPosesTest, RefusesWhatCannotWalk) {
  const std::string idle = refusalOf(4, {"idle"});
  EXPECT_NE(idle.find("a clip that moves forward"), std::string::npos) << idle;
  EXPECT_NE(idle.find("idle"), std::string::npos) << idle;
  EXPECT_NE(refusalOf(1, {}).find("expected 2 to 8"), std::string::npos) << refusalOf(1, {});
  EXPECT_NE(refusalOf(9, {}).find("expected 2 to 8"), std::string::npos) << refusalOf(9, {});
  EXPECT_EQ(refusalOf(4, {}), "");
}

using KeyPoseHerdTest = GpuTest;

// Nobody springs into place at the start.
TEST_F(KeyPoseHerdTest, BeginsInTheStandingPose) {
  Scene scene = sceneOf(20, 1, 1, Controller::keyPoses);
  scene.herds[0].goal.kind = Goal::Kind::none;
  Crowd crowd(device(), rollingGround(), scene);
  const HerdState before = crowd.download(0);
  simulate(device(), crowd, 30);
  const HerdState after = crowd.download(0);
  for (size_t i = 0; i < after.spring.size(); ++i) EXPECT_EQ(after.spring[i], 0);
  const Rig& rig = crowd.rig(0);
  for (size_t leg = 0; leg < 160; ++leg) {
    const auto directions = validation::chainOf(after, leg, rig.maxBones()).directions;
    EXPECT_EQ(directions, validation::chainOf(before, leg, rig.maxBones()).directions);
  }
}

}  // namespace
}  // namespace skitter::test
