// Each stage against the reference on states that no walk would lead to: random ones, targets at the root,
// beyond reach and exactly at full stretch, straight chains, bones of no length, bodies on their side.
#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>
#include <random>
#include <string_view>

#include "crowd/herd.h"
#include "crowd/simulation.h"
#include "gpu/submit.h"
#include "gpu/transfer.h"
#include "support/rounding.h"
#include "validation/convert.h"
#include "validation/herd_facts.h"

namespace skitter::test {
namespace {

using NastyTest = GpuLoadTest;

// One straight leg after another around a disc, each pointing outward and level, with cones of `degrees`.
Rig straightLegs(std::vector<int> bones, float degrees) {
  Rig rig;
  rig.name = "straight";
  rig.groups = {"A", "B"};
  rig.bodyHeight = 0.3f;
  rig.bodyRadius = 0.2f;
  for (size_t l = 0; l < bones.size(); ++l) {
    const float angle =
        glm::two_pi<float>() * (static_cast<float>(l) + 0.5f) / static_cast<float>(bones.size());
    const glm::vec3 out(std::sin(angle), 0, std::cos(angle));
    Leg leg;
    leg.name = "leg" + std::to_string(l);
    leg.group = static_cast<int>(l % 2);
    for (int i = 0; i < bones[l]; ++i) {
      Bone bone;
      bone.length = 1.0f / static_cast<float>(bones[l]);
      bone.start = 0.1f * out + glm::vec3(0, 0.3f, 0) + out * (bone.length * static_cast<float>(i));
      bone.direction = out;
      bone.coneHalfAngle = glm::radians(degrees);
      leg.bones.push_back(bone);
    }
    leg.home = 0.7f * out;
    leg.reach = 1;
    rig.legs.push_back(leg);
  }
  return rig;
}

// Overwrites the herd's records with a state drawn from `seed`: bodies turned and tilted anyhow, feet
// anywhere from the root itself to far beyond reach, chains bent anyhow within their cones, some of them at
// rest.
void scramble(const gpu::Context& context, Crowd& crowd, uint64_t seed, float farthest) {
  std::mt19937_64 random(seed);
  const auto uniform = [&](float low, float high) {
    return low + (high - low) * static_cast<float>(random() >> 40) * 0x1p-24f;
  };
  crowd::Kind& kind = implOf(crowd).kindOf(0);
  const crowd::Page& page = kind.pages.at(0);
  auto body = gpu::download<float>(context, page.body), gait = gpu::download<float>(context, page.gait);
  auto step = gpu::download<float>(context, page.step), arc = gpu::download<float>(context, page.arc);
  auto chain = gpu::download<float>(context, page.chain);
  const auto legs = static_cast<size_t>(kind.legs), bones = static_cast<size_t>(kind.bones);
  const auto chainFloats = static_cast<size_t>(shared::chainStride(kind.bones)) * 4;
  for (size_t agent = 0; agent < page.agents; ++agent) {
    float* b = &body[agent * 16];
    const float heading = uniform(-3, 3);
    const glm::quat q = glm::normalize(
        glm::angleAxis(uniform(0, 1.2f), glm::normalize(glm::vec3(uniform(-1, 1), 0.01f, uniform(-1, 1)))) *
        glm::angleAxis(heading, glm::vec3(0, 1, 0)));
    b[4] = std::sin(heading), b[5] = std::cos(heading), b[6] = uniform(0, 3);
    b[8] = q.x, b[9] = q.y, b[10] = q.z, b[11] = q.w;
    b[12] = uniform(-1.5f, 1.5f), b[13] = uniform(0, 2), b[15] = b[6];
    gait[agent * 8] = uniform(0, 1);
    for (size_t l = 0; l < legs; ++l) {
      const auto record =
          static_cast<size_t>(shared::legRecord(static_cast<int>(agent), static_cast<int>(l), kind.legs));
      float *s = &step[record * 8], *a = &arc[record * 8];
      const Leg& leg = kind.rig.legs[l];
      const glm::vec3 root = q * leg.root();
      const glm::vec3 way = glm::normalize(glm::vec3(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)) + 1e-3f);
      const float distances[] = {0, 1e-4f, 0.2f, uniform(0, 1), 1, uniform(1, farthest)};
      const glm::vec3 foot = root + way * (leg.reach * distances[random() % 6]);
      s[0] = b[0] + foot.x, s[1] = b[1] + foot.y, s[2] = b[2] + foot.z;
      s[4] = s[0] + uniform(-0.5f, 0.5f), s[5] = s[1], s[6] = s[2] + uniform(-0.5f, 0.5f);
      std::fill_n(a, 8, 0.0f);
      a[1] = a[5] = uniform(0, 0.4f);
      s[3] = -std::floor(uniform(0, 30));
      s[7] = shared::packedTicks(std::floor(uniform(3, 20)),
                                 shared::stepTile(shared::tileX(b[3]), shared::tileZ(b[3])));
      const bool rest = random() % 3 == 0;
      for (size_t i = 0; i < bones && i < leg.bones.size(); ++i) {
        const float t = rest ? 0 : uniform(0, std::tan(std::min(leg.bones[i].coneHalfAngle, 2.5f) / 2)),
                    turn = uniform(-3, 3);
        chain[record * chainFloats + 2 * i] = t * std::cos(turn);
        chain[record * chainFloats + 2 * i + 1] = t * std::sin(turn);
      }
    }
  }
  gpu::upload(context, page.body, body);
  gpu::upload(context, page.gait, gait);
  gpu::upload(context, page.step, step);
  gpu::upload(context, page.arc, arc);
  gpu::upload(context, page.chain, chain);
}

void expectEveryStage(Device& device, const Rig& rig, uint64_t seeds, float farthest) {
  const Heightfield ground = rollingGround();
  for (uint64_t seed = 1; seed <= seeds; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Crowd crowd(device, ground, sceneOf(65), {.rigs = {rig}});
    scramble(device.context(), crowd, seed, farthest);
    expectAllPass(replay(device, crowd, validation::herdFacts(implOf(crowd).kindOf(0), ground), 4));
  }
}

// Solves every leg as those that ik's first dispatch lists are solved.
void solveListed(const gpu::Context& context, const crowd::Kind& kind, uint64_t tick) {
  const crowd::Page& page = kind.pages.at(0);
  std::vector<uint32_t> list;
  for (int agent = 0; agent < static_cast<int>(page.agents); ++agent)
    for (int leg = 0; leg < kind.legs; ++leg)
      list.push_back(static_cast<uint32_t>(shared::legRecord(agent, leg, kind.legs)));
  gpu::upload(context, page.list, list);
  auto counters = gpu::download<uint32_t>(context, page.counters);
  const auto legs = static_cast<uint32_t>(list.size());
  counters[shared::COUNTER_IK_LISTED] = legs;
  counters[shared::COUNTER_IK_DISPATCH_X] = gpu::groupsFor(legs, shared::WORK_GROUP);
  gpu::upload(context, page.counters, counters);
  const auto ik = static_cast<size_t>(
      std::ranges::find_if(kind.stages,
                           [](const crowd::Stage& stage) { return stage.makes.has(crowd::StageId::ik); }) -
      kind.stages.begin());
  shared::TickConstants constants{};
  constants.tick = static_cast<float>(tick);
  gpu::submitAndWait(context, [&](vk::CommandBuffer cmd) {
    kind.stages[ik].listed.dispatchIndirect(cmd, page.bindings[ik], gpu::bytesOf(constants), page.counters,
                                            shared::COUNTER_IK_DISPATCH_X * sizeof(uint32_t));
  });
}

// The miss of each leg in the crowd's last tick.
std::vector<double> missesOf(const Crowd& crowd) {
  const crowd::Kind& kind = implOf(crowd).kindOf(0);
  const HerdState state = crowd.download(0);
  std::vector<double> misses;
  for (size_t agent = 0; agent < state.agents; ++agent)
    for (size_t leg = 0; leg < static_cast<size_t>(kind.legs); ++leg)
      misses.push_back(validation::missOf(state, agent, leg, kind.legs, state.tick));
  return misses;
}

// What is left out of ik's first dispatch would not have changed a bit of a leg that it solves.
TEST_P(NastyTest, ListedLegsAndOthersAreSolvedAlike) {
  if (!kernelsRoundAlike(device())) GTEST_SKIP() << "this device may round the two kernels differently";
  const gpu::Context& context = device().context();
  for (const Rig& rig : {spiderRig(), straightLegs({2, 5, 3, 1, 4, 5}, 60), straightLegs({15, 15}, 30)}) {
    SCOPED_TRACE(rig.name + " with " + std::to_string(rig.maxBones()) + " bones");
    Crowd crowd(device(), rollingGround(), sceneOf(65), {.rigs = {rig}});
    const crowd::Kind& kind = implOf(crowd).kindOf(0);
    const crowd::Page& page = kind.pages.at(0);
    scramble(context, crowd, 1, 1.1f);
    uint32_t atOnce = 0;
    for (int tick = 0; tick < 4; ++tick) {
      const auto before = gpu::download<uint32_t>(context, page.chain),
                 places = gpu::download<uint32_t>(context, page.tip);
      simulate(device(), crowd, 1);
      const auto solved = gpu::download<uint32_t>(context, page.chain),
                 tips = gpu::download<uint32_t>(context, page.tip);
      const std::vector<double> told = missesOf(crowd);
      const uint32_t listed = gpu::download<uint32_t>(context, page.counters)[shared::COUNTER_IK_LISTED];
      atOnce += page.agents * static_cast<uint32_t>(kind.legs) - listed;
      if (tick == 0) {
        EXPECT_GT(listed, 0u);
      }
      gpu::upload(context, page.chain, before);
      gpu::upload(context, page.tip, places);
      solveListed(context, kind, crowd.tick());
      EXPECT_EQ(gpu::download<uint32_t>(context, page.chain), solved) << "tick " << tick;
      EXPECT_EQ(gpu::download<uint32_t>(context, page.tip), tips) << "tick " << tick;
      EXPECT_EQ(missesOf(crowd), told) << "tick " << tick;
    }
    EXPECT_GT(atOnce, 0u);
  }
}

// What body and gait are told of a leg is what its tip has of a planted foot, padded to whole vec4s or not,
// and is over a tick later.
TEST_P(NastyTest, MissesAreThoseOfTheTips) {
  for (const Rig& rig : {spiderRig(), straightLegs({2, 5, 3, 1, 4, 5}, 60)}) {
    SCOPED_TRACE(rig.name);
    Crowd crowd(device(), rollingGround(), sceneOf(65), {.rigs = {rig}});
    const crowd::Kind& kind = implOf(crowd).kindOf(0);
    scramble(device().context(), crowd, 1, 1.1f);
    for (int tick = 0; tick < 3; ++tick) {
      simulate(device(), crowd, 1);
      const HerdState state = crowd.download(0);
      const std::vector<double> misses = missesOf(crowd);
      size_t told = 0;
      for (size_t leg = 0; leg < misses.size(); ++leg) {
        const size_t rigAt = leg % rig.legs.size() * 4 * static_cast<size_t>(shared::rigStride(kind.bones));
        const float error = state.tip[4 * leg + 3] / kind.rigRecords[rigAt + 3];
        const bool planted = state.foot[4 * leg + 3] >= 1;
        ASSERT_NEAR(misses[leg], planted && error > kind.parameters.missLeast ? error : 0, 1e-6f)
            << "leg " << leg;
        if (misses[leg] > 0) ++told;
      }
      EXPECT_GT(told, 0u) << "tick " << tick;
      EXPECT_LT(told, misses.size()) << "tick " << tick;
    }
  }
}

// One foot all but right below the body: a hair's breadth from balance is off balance.
TEST_P(NastyTest, AFootRightBelowTheBodyIsMeasured) {
  Rig rig = straightLegs({4}, 120);
  rig.legs[0].home = {0, 0, 4e-5f};
  Scene scene = sceneOf(8, 0);
  scene.herds[0].tuning.breathHeight = 0;
  Crowd crowd(device(), flatGround(), scene, {.rigs = {rig}});
  simulate(device(), crowd, 30);
  expectAllPass(replay(device(), crowd, flatGround(), 4));
  EXPECT_EQ(crowd.fidelity().unstable, 1);
}

TEST_P(NastyTest, SpidersInAnyState) { expectEveryStage(device(), spiderRig(), 8, 3); }
TEST_P(NastyTest, StraightLegs) { expectEveryStage(device(), straightLegs({4, 4, 4, 4, 4, 4}, 70), 4, 1.1f); }
TEST_P(NastyTest, OneBoneAndFifteen) {
  expectEveryStage(device(), straightLegs({1, 1, 1, 1}, 80), 2, 1.1f);
  expectEveryStage(device(), straightLegs({15, 15}, 30), 2, 1.1f);
}
TEST_P(NastyTest, LegsOfDifferentLengthArePaddedWithBonesOfNone) {
  expectEveryStage(device(), straightLegs({2, 5, 3, 1, 4, 5}, 60), 4, 1.1f);
}
TEST_P(NastyTest, LegsWithoutLimits) { expectEveryStage(device(), straightLegs({3, 3, 3, 3}, 180), 2, 1.1f); }

INSTANTIATE_TEST_SUITE_P(, NastyTest, bothLoadPaths(), loadPathName);

}  // namespace
}  // namespace skitter::test
