// The clip controller: which clip is played and where in it, and what is made of its frames.
#include "cpu_reference/stages/clip.h"

#include <gtest/gtest.h>

#include <cmath>

#include "cpu_reference/clips/blend.h"
#include "cpu_reference/ik/kinematics.h"
#include "cpu_reference/stages/pose_clip.h"
#include "cpu_reference/stages/swing_clip.h"
#include "hand_clips.h"
#include "spider.h"

namespace skitter::test {
namespace {

using reference::Play;

constexpr int idle = 0, walk = 1, run = 2;

class Clip : public testing::Test {
 protected:
  Clip() {
    tuning.dt = 1.0 / 64;
    tuning.clipFade = 1.0 / 16;
    tuning.clipIdle = 0.05;
    tuning.clipHysteresis = 0.25;
    tuning.clipRateMost = 2.5;
  }
  static Play playing(int clip, double time, double weight = 1) {
    Play play;
    play.to = play.from = {clip, time, 0, 0, 0};
    play.weight = weight;
    return play;
  }
  reference::ClipResult tick(double speed, const Play& play) const {
    reference::AgentBody body;
    body.surfaceSpeed = speed;
    return reference::clip(tuning, table, body, play);
  }
  // What is played after a tick at this speed.
  int chosen(int now, double speed) const { return tick(speed, playing(now, 0)).play.to.clip; }

  reference::Tuning tuning;
  reference::ClipTable table = threeGaits();
};

TEST_F(Clip, runsAsFastAsTheBodyUpToABound) {
  const Play half = tick(0.8, playing(walk, 0.25)).play;
  EXPECT_DOUBLE_EQ(half.to.rate, 0.8);
  EXPECT_DOUBLE_EQ(half.to.time, 0.25 + 0.8 / 64);
  EXPECT_DOUBLE_EQ(tick(9, playing(run, 0)).play.to.rate, 2.5);
  EXPECT_DOUBLE_EQ(tick(0, playing(idle, 0.5)).play.to.rate, 1);
}

TEST_F(Clip, turningMovesFeetToo) {
  tuning.homeRadius = 0.7;
  reference::AgentBody body;
  body.surfaceSpeed = 0.3;
  body.turnRate = -1;
  EXPECT_DOUBLE_EQ(reference::clip(tuning, table, body, playing(walk, 0)).play.to.rate, 1);
}

TEST_F(Clip, wrapsAround) {
  EXPECT_NEAR(tick(1, playing(walk, 0.99)).play.to.time, 0.99 + 1.0 / 64 - 1, 1e-15);
  table.clips[walk].seconds = 1e-3;  // several times in a tick
  EXPECT_NEAR(tick(1, playing(walk, 0)).play.to.time, std::fmod(1.0 / 64, 1e-3), 1e-15);
  table.clips[idle].seconds = 0;
  EXPECT_EQ(tick(0, playing(idle, 0)).play.to.time, 0);
}

TEST_F(Clip, standsBelowTheIdleSpeedAndMovesAboveIt) {
  EXPECT_EQ(chosen(walk, 0.049), idle);
  EXPECT_EQ(chosen(idle, 0.049), idle);
  EXPECT_EQ(chosen(idle, 0.051), walk);
  EXPECT_EQ(chosen(idle, 3), run);
}

TEST_F(Clip, movesOnWhereNothingStands) {
  table.clips[idle].speed = 0.5;
  EXPECT_EQ(chosen(run, 0), idle);
  EXPECT_EQ(tick(0, playing(idle, 0.3)).play.to.rate, 0);
}

// Walk and run suit equally at sqrt(2) m/s; what is played is favoured by a quarter of an octave.
TEST_F(Clip, changesOnlyWhenTheOtherSuitsClearlyBetter) {
  const double up = std::exp2(0.5 + 0.125), down = std::exp2(0.5 - 0.125);
  EXPECT_EQ(chosen(walk, up * 0.999), walk);
  EXPECT_EQ(chosen(walk, up * 1.001), run);
  EXPECT_EQ(chosen(run, down * 1.001), run);
  EXPECT_EQ(chosen(run, down * 0.999), walk);
}

TEST_F(Clip, equalCostsGoToTheFirst) {
  table.clips[run].speed = table.clips[walk].speed;
  EXPECT_EQ(chosen(idle, 1), walk);
}

TEST_F(Clip, fadesBeforeItChangesAgain) {
  Play play = tick(1, playing(idle, 0.5)).play;
  EXPECT_EQ(play.to.clip, walk);
  EXPECT_EQ(play.from.clip, idle);
  EXPECT_EQ(play.weight, 0);
  for (int n = 1; n < 16; ++n) {
    play = tick(0, play).play;
    EXPECT_EQ(play.to.clip, walk);
    EXPECT_DOUBLE_EQ(play.weight, n / 16.0);
  }
  play = tick(0, play).play;
  EXPECT_EQ(play.to.clip, idle);
  EXPECT_EQ(play.from.clip, walk);
  EXPECT_EQ(play.weight, 0);
}

TEST_F(Clip, movingClipsMeetInTheSamePhase) {
  const Play play = tick(2, playing(walk, 0.4)).play;
  EXPECT_EQ(play.to.clip, run);
  EXPECT_DOUBLE_EQ(play.from.time, 0.4 + 2.0 / 64);
  EXPECT_DOUBLE_EQ(play.to.time / 0.5, play.from.time / 1);
  EXPECT_EQ(tick(0, playing(walk, 0.4)).play.to.time, 0);
  EXPECT_EQ(tick(1, playing(idle, 0.4)).play.to.time, 0);
}

TEST_F(Clip, bothClipsRunWhileOneFades) {
  Play play = playing(run, 0.1, 0.5);
  play.from = {walk, 0.2, 0, 0, 0};
  play = tick(1.5, play).play;
  EXPECT_DOUBLE_EQ(play.to.time, 0.1 + 0.75 / 64);
  EXPECT_DOUBLE_EQ(play.from.time, 0.2 + 1.5 / 64);
}

TEST_F(Clip, framesAreTheLastBegun) {
  const auto found = [&](int clip, double time) {
    Play::Played played{clip, time, 0, 0, 0};
    reference::findFrame(table, played);
    return std::pair(played.frame, played.fraction);
  };
  EXPECT_EQ(found(walk, 0), std::pair(size_t{2}, 0.0));
  EXPECT_EQ(found(walk, 0.125), std::pair(size_t{2}, 0.5));
  EXPECT_EQ(found(walk, 0.25), std::pair(size_t{3}, 0.0));
  EXPECT_EQ(found(walk, 0.5), std::pair(size_t{5}, 0.0)) << "the later side of a jump";
  EXPECT_EQ(found(walk, 0.875), std::pair(size_t{5}, 0.75));
  EXPECT_EQ(found(walk, 1), std::pair(size_t{6}, 0.0));
  EXPECT_EQ(found(run, 0.125), std::pair(size_t{7}, 0.25));
}

TEST_F(Clip, marginsTellHowNearADecisionWas) {
  const auto result = tick(0.06, playing(walk, 0));
  EXPECT_NEAR(result.idleMargin, 0.01, 1e-15);
  EXPECT_NEAR(tick(1, playing(walk, 0, 0.5)).fadeMargin, 0.5 - 1.0 / 16, 1e-15);
}

// Two frames, of which the second is turned a quarter about Y and moved; and a clip that only moves.
class ClipFrames : public testing::Test {
 protected:
  ClipFrames() {
    table.clips = {{0, 2, 1, 1}, {2, 1, 0, 0}};
    table.frames = {{0, 1}, {1, 0}, {0, 0}};
    reference::Affine turned(0);
    turned[0] = {0, 0, -1};
    turned[1] = {0, 1, 0};
    turned[2] = {1, 0, 0};
    turned[3] = {1, 2, 3};
    reference::Affine moved(1);
    moved[3] = {0, 8, 0};
    table.matrices = {reference::Affine(1), turned, moved};
    table.bones = {{0, 0}};
    play.to = {0, 0.25, 1, 0, 0.25};
    play.from = {1, 0, 1, 2, 0};
  }
  static void expectNear(const reference::Affine& got, const glm::dmat3& linear, const glm::dvec3& place) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(glm::length(got[c] - linear[c]), 0, 1e-12) << c;
    EXPECT_NEAR(glm::length(got[3] - place), 0, 1e-12);
  }
  // A quarter of the way from rest to a quarter turn about Y, element by element.
  const glm::dmat3 quarter{glm::dvec3(0.75, 0, -0.25), glm::dvec3(0, 1, 0), glm::dvec3(0.25, 0, 0.75)};

  reference::ClipTable table;
  Play play;
};

TEST_F(ClipFrames, blendElementByElement) {
  expectNear(reference::blended(table, play, 0), quarter, {0.25, 0.5, 0.75});
  play.weight = 0.5;
  expectNear(reference::blended(table, play, 0), 0.5 * quarter + 0.5 * glm::dmat3(1), {0.125, 4.25, 0.375});
}

TEST_F(ClipFrames, poseIsTheBlendTurnedWithTheBody) {
  reference::AgentBody body;
  expectNear(reference::clipPose(table, body, play, 0), quarter, {0.25, 0.5, 0.75});
  body.orientation = glm::angleAxis(std::acos(0.0), glm::dvec3(0, 1, 0));  // z to x, x to -z
  const glm::dmat3 turn{glm::dvec3(0, 0, -1), glm::dvec3(0, 1, 0), glm::dvec3(1, 0, 0)};
  expectNear(reference::clipPose(table, body, play, 0), turn * quarter, {0.75, 0.5, -0.25});
}

TEST_F(ClipFrames, stanceIsThatOfTheClipThatShowsMore) {
  EXPECT_TRUE(reference::standsInClip(table, play, 0));
  play.weight = 0.5;
  EXPECT_TRUE(reference::standsInClip(table, play, 0));
  play.weight = 0.49;
  EXPECT_FALSE(reference::standsInClip(table, play, 0));
}

TEST(ClipLegs, restHasNoTurns) {
  const reference::Creature creature = spiderCreature();
  const reference::ClipTable table = restClip(creature);
  reference::AgentBody body;
  body.orientation = glm::normalize(glm::dquat(0.9, 0.1, 0.2, -0.1));
  for (size_t l = 0; l < 8; ++l) {
    const reference::Limb& limb = creature.limbs[l];
    const auto result = reference::clipSwing(table, limb, l, body, {});
    for (const glm::dvec2& xy : result.chain.directions) EXPECT_NEAR(glm::length(xy), 0, 1e-6);
    EXPECT_NEAR(glm::length(result.foot.target - body.orientation * table.legs[l].back().start), 0, 1e-12);
    EXPECT_EQ(result.chain.tip, result.foot.target);
    EXPECT_EQ(result.foot.progress, 1);
  }
}

// Joints carried as forward kinematics has them give back the directions that it was given.
TEST(ClipLegs, directionsAreThoseOfTheJoints) {
  const reference::Creature creature = spiderCreature();
  reference::ClipTable table = restClip(creature);
  const reference::Limb& limb = creature.limbs[3];
  const std::vector<glm::dvec2> bent = {{0.1, -0.2}, {0.3, 0}, {-0.2, 0.25}, {0, -0.3}};
  const reference::Posture posture(limb, bent);
  for (const reference::ClipTable::LegJoint& joint : table.legs[3]) {
    const size_t i = joint.joint - table.legs[3].front().joint;
    table.matrices[joint.joint][3] = limb.root + limb.reach * posture.joint(i) - joint.start;
  }
  table.frames[0].standing = ~(1u << 3);
  const auto result = reference::clipSwing(table, limb, 3, {}, {});
  for (size_t i = 0; i < 4; ++i) EXPECT_NEAR(glm::length(result.chain.directions[i] - bent[i]), 0, 1e-6);
  EXPECT_NEAR(glm::length(result.foot.target - limb.root - limb.reach * posture.tip()), 0, 1e-12);
  EXPECT_EQ(result.foot.progress, 0.5);
}

}  // namespace
}  // namespace skitter::test
