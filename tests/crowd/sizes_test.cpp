// Herds whose agents differ in size: each size is a kind of its own, and a run of the herd's agents.
#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <set>

#include "crowd/kinds.h"
#include "crowd/page.h"
#include "crowd/scale.h"
#include "crowd/simulation.h"
#include "crowd/tint.h"
#include "gpu/transfer.h"
#include "render/tint.h"
#include "skitter/error.h"

namespace skitter::test {
namespace {

using ::testing::HasSubstr;

class SizesTest : public GpuTest {};

Scene sizedScene(uint32_t agents, std::vector<float> sizes, Controller controller = Controller::adaptive) {
  Scene scene = sceneOf(agents, 1, 5, controller);
  scene.herds[0].sizes = std::move(sizes);
  return scene;
}

class SizedControllersTest : public GpuTest, public ::testing::WithParamInterface<Controller> {};

// With speeds of 1 m/s, one to four leg lengths a second.
TEST_P(SizedControllersTest, AreReplayed) {
  const Heightfield ground = rollingGround();
  Crowd crowd(device(), ground, sizedScene(24, {0.5f, 1, 2}, GetParam()),
              CrowdOptions{.watchEvery = 1, .footfalls = UINT32_MAX});
  const auto results = replayAll(device(), crowd, ground, 90);
  ASSERT_EQ(results.size(), 3u);
  for (const auto& each : results) {
    expectAllPass(each);
    for (const validation::StageResult& stage : each) EXPECT_GT(stage.samples, 0u) << stage.name;
  }
}

// A creature of twice the size moves as a rig of twice the size does, bit for bit.
TEST_P(SizedControllersTest, MoveAsARigOfThatSizeDoes) {
  if (GetParam() != Controller::adaptive && GetParam() != Controller::loop)
    GTEST_SKIP() << "clips are of a file, whose rig has one size";
  const Heightfield ground = rollingGround();
  Crowd sized(device(), ground, sizedScene(20, {2}, GetParam()));
  Crowd rigged(device(), ground, sizedScene(20, {}, GetParam()),
               std::vector<Rig>{crowd::scaled(spiderRig(), 2)});
  simulate(device(), sized, 60);
  simulate(device(), rigged, 60);
  EXPECT_EQ(sized.stateHash(), rigged.stateHash());
  EXPECT_EQ(sized.rig(0), rigged.rig(0));
}

INSTANTIATE_TEST_SUITE_P(, SizedControllersTest, ::testing::ValuesIn(allControllers),
                         [](const auto& param) { return testNameOf(param.param); });

TEST_F(SizesTest, EqualSizesOfEqualHerdsShareAKind) {
  Scene scene = sizedScene(30, {0.5f, 1});
  scene.herds.push_back(scene.herds[0]);
  scene.herds.push_back(scene.herds[0]);
  scene.herds[1].sizes = {};
  scene.herds[2].sizes = {1, 3, 0.5f};
  const crowd::Kinds kinds = crowd::kindsOf(scene);
  std::vector<uint32_t> of;
  for (const crowd::SizedHerd& herd : kinds.herds) of.push_back(herd.kind);
  EXPECT_EQ(of, (std::vector<uint32_t>{0, 1, 1, 1, 2, 0}));
  const Crowd crowd(device(), rollingGround(), scene);
  EXPECT_EQ(implOf(crowd).kinds.size(), 3u);
  EXPECT_EQ(crowd.agentCount(), 90u);
  EXPECT_EQ(crowd.rig(0).legLength, 0.5f);
  EXPECT_EQ(crowd.rig(1).legLength, 1);
  EXPECT_EQ(crowd.rig(2).legLength, 1);
}

// The agents of a herd that has one size twice are those of a herd without sizes, in another order.
TEST_F(SizesTest, PlacesAreThoseOfAHerdWithoutSizes) {
  const Heightfield ground = rollingGround();
  const auto bodies = [&](std::vector<float> sizes) {
    Crowd crowd(device(), ground, sizedScene(200, std::move(sizes)));
    simulate(device(), crowd, 30);
    const HerdState state = crowd.download(0);
    EXPECT_EQ(state.agents, 200u);
    constexpr auto floats = static_cast<ptrdiff_t>(4 * shared::BODY_STRIDE);
    std::vector<std::vector<float>> each;
    for (auto at = state.body.begin(); at != state.body.end(); at += floats)
      each.emplace_back(at, at + floats);
    return each;
  };
  auto plain = bodies({}), twice = bodies({1, 1});
  EXPECT_NE(plain, twice);
  std::ranges::sort(plain);
  std::ranges::sort(twice);
  EXPECT_EQ(plain, twice);
}

TEST_F(SizesTest, AreDrawnBySeedAndMixedByPlace) {
  const Scene scene = sizedScene(4000, {0.8f, 1, 1.2f, 1});
  const Crowd crowd(device(), rollingGround(), scene, {.pose = false, .measure = false});
  const HerdState state = crowd.download(0);
  const double middle = [&] {
    double sum = 0;
    for (uint32_t a = 0; a < 4000; ++a) sum += positionOf(state, a).x;
    return sum / 4000;
  }();
  std::map<float, std::pair<int, int>> sides;
  for (uint32_t a = 0; a < 4000; ++a) {
    auto& [left, right] = sides[crowd.size(0, a)];
    ++(positionOf(state, a).x < middle ? left : right);
  }
  // 500 of 4000 with a standard deviation of 21; size 1 is drawn twice as often.
  for (const auto& [size, counts] : sides) {
    const int expected = size == 1 ? 1000 : 500;
    EXPECT_NEAR(counts.first, expected, 130) << size;
    EXPECT_NEAR(counts.second, expected, 130) << size;
  }
  Scene other = scene;
  other.seed = 6;
  const crowd::SpawnPlaces a(scene), b(other);
  EXPECT_FALSE(std::ranges::equal(a.of(0, 0), b.of(0, 0)));
  EXPECT_TRUE(std::ranges::equal(a.of(0, 0), crowd::SpawnPlaces(scene).of(0, 0)));
}

TEST_F(SizesTest, AgentsAreNumberedSizeAfterSize) {
  const Heightfield ground = rollingGround();
  Crowd crowd(device(), ground, sizedScene(41, {2, 0.5f}),
              CrowdOptions{.watchEvery = 1, .footfalls = UINT32_MAX, .pageAgents = 8});
  const Crowd::Impl& impl = implOf(crowd);
  ASSERT_EQ(impl.herds.size(), 2u);
  const uint32_t large = impl.herds[0].agents;
  EXPECT_EQ(large + impl.herds[1].agents, 41u);
  EXPECT_EQ(crowd.size(0, large - 1), 2);
  EXPECT_EQ(crowd.size(0, large), 0.5f);
  EXPECT_EQ(crowd.rig(0, 40).legLength, 0.5f);
  EXPECT_EQ(crowd.rig(0).legLength, 2);
  simulate(device(), crowd, 50);
  const HerdState all = crowd.download(0);
  const HerdState first = crowd::download(impl, impl.herds[0]), last = crowd::download(impl, impl.herds[1]);
  for (const Record record : {Record::body, Record::step, Record::chain, Record::pose, Record::foot}) {
    std::vector<float> joined = first.of(record);
    joined.insert(joined.end(), last.of(record).begin(), last.of(record).end());
    EXPECT_FALSE(joined.empty());
    EXPECT_EQ(all.of(record), joined);
  }
  EXPECT_TRUE(all.watch.empty());
  // Every third agent, across the two sizes.
  const HerdState some = crowd.download(0, {.first = 1, .stride = 3});
  ASSERT_EQ(some.agents, 14u);
  for (uint32_t i = 0; i < some.agents; ++i) EXPECT_EQ(positionOf(some, i), positionOf(all, 1 + 3 * i)) << i;
  // A touchdown is near the agent whose number it has.
  std::set<uint32_t> landed;
  for (int tick = 0; tick < 30; ++tick) {
    simulate(device(), crowd, 1);
    const HerdState state = crowd.download(0);
    EXPECT_TRUE(state.footfallsKept);
    for (const Footfall& f : state.footfalls) {
      const glm::dvec3 body = positionOf(state, f.agent);
      EXPECT_LT(glm::distance(body, glm::dvec3(f.place)), 1.2 * crowd.rig(0, f.agent).legLength) << f.agent;
      landed.insert(f.agent);
    }
  }
  EXPECT_GT(landed.size(), 35u);
  uint32_t agents = 0;
  for (const FootfallBuffer& buffer : crowd.footfallBuffers(0))
    if (buffer.firstOfHerd == 0) agents = buffer.agents;
  EXPECT_EQ(agents, large);
}

TEST_F(SizesTest, FiguresAreOfAllSizesInLegLengthsOfEach) {
  const Heightfield ground = flatGround();
  Scene scene = sizedScene(30, {0.5f, 2});
  Crowd crowd(device(), ground, scene, CrowdOptions{.watchEvery = 1});
  simulate(device(), crowd, 120);
  const std::vector<Fidelity> each = crowd.agentFidelity(0);
  ASSERT_EQ(each.size(), 30u);
  uint64_t ticks = 0, stances = 0;
  double margin = 0;
  for (const Fidelity& f : each) {
    EXPECT_EQ(f.agentTicks, 120u);
    // Standing on a spider's feet its middle is a good part of a leg length from the edge of their hull.
    EXPECT_GT(f.margin, 0.1);
    EXPECT_LT(f.margin, 1);
    ticks += f.agentTicks;
    stances += f.stances;
    margin += f.margin / 30;
  }
  const Fidelity all = crowd.fidelity(0);
  EXPECT_EQ(all.agentTicks, ticks);
  EXPECT_EQ(all.stances, stances);
  EXPECT_NEAR(all.margin, margin, 0.01);
  uint64_t bytes = 0;
  for (const MemoryUse& use : crowd.memoryUse(0)) bytes += use.bytes;
  EXPECT_EQ(bytes, crowd.memoryBytes());
}

TEST_F(SizesTest, ThatCannotBeAreRefused) {
  const Heightfield ground = flatGround();
  const auto fault = [&](const std::vector<float>& sizes) -> std::string {
    try {
      const Crowd crowd(device(), ground, sizedScene(4, sizes));
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), Error::Kind::input);
      return error.what();
    }
    return "taken";
  };
  EXPECT_THAT(fault(std::vector<float>(17, 1.0f)), HasSubstr("herds[0].sizes are 17, expected at most 16"));
  EXPECT_THAT(fault({1, 0.04f}), HasSubstr("herds[0].sizes[1] is 0.04, expected 0.05 to 20"));
  EXPECT_THAT(fault({21}), HasSubstr("herds[0].sizes[0] is 21"));
  EXPECT_THAT(fault({std::numeric_limits<float>::quiet_NaN()}), HasSubstr("herds[0].sizes[0] is nan"));
}

TEST_F(SizesTest, PhasesAreDrawnOrGiven) {
  const Heightfield ground = flatGround();
  const auto phases = [&](std::optional<float> phase, Controller controller) {
    Scene scene = sizedScene(50, {}, controller);
    scene.herds[0].phase = phase;
    const HerdState state = Crowd(device(), ground, scene).download(0);
    std::set<float> all;
    for (uint32_t a = 0; a < 50; ++a) {
      if (controller == Controller::clip)
        all.insert(state.play[a * 4 * shared::PLAY_STRIDE + 1]);
      else
        all.insert(state.gait[a * 4 * shared::GAIT_STRIDE]);
    }
    return all;
  };
  EXPECT_EQ(phases({}, Controller::adaptive).size(), 50u);
  EXPECT_EQ(phases(0.25f, Controller::adaptive), std::set<float>{0.25f});
  EXPECT_EQ(phases(1, Controller::adaptive), std::set<float>{0});
  EXPECT_EQ(phases({}, Controller::clip).size(), 50u);
  EXPECT_EQ(phases(0, Controller::clip), std::set<float>{0});
  const std::set<float> half = phases(0.5f, Controller::clip);
  ASSERT_EQ(half.size(), 1u);
  EXPECT_GT(*half.begin(), 0.1f);
  Scene scene = sizedScene(1, {});
  scene.herds[0].phase = 1.5f;
  EXPECT_THROW(Crowd(device(), ground, scene), Error);
}

std::vector<glm::vec4> tintsOf(const Crowd& crowd, uint32_t herd) {
  std::vector<glm::vec4> tints;
  for (const crowd::Part& part : crowd::partsOf(implOf(crowd), herd)) {
    const auto all = gpu::download<glm::vec4>(*implOf(crowd).context, part.page->tint);
    tints.insert(tints.end(), all.begin() + part.first, all.begin() + part.first + part.agents);
  }
  return tints;
}

TEST_F(SizesTest, OnlyHerdsThatAskHaveTintsAndTheyAreDrawnBySeed) {
  const Heightfield ground = flatGround();
  Scene scene = sizedScene(40, {});
  scene.herds.resize(4, scene.herds[0]);
  scene.herds[1].colour = glm::vec3(0.5f, 0.25f, 0.125f);
  scene.herds[2].tint = 0;
  scene.herds[3].tint = 1;
  scene.herds.push_back(scene.herds[0]);
  scene.herds[4].controller = Controller::loop;
  const Crowd crowd(device(), ground, scene);
  const Crowd::Impl& impl = implOf(crowd);
  ASSERT_EQ(impl.kinds.size(), 2u);
  EXPECT_TRUE(impl.kinds[0].tinted);
  EXPECT_FALSE(impl.kinds[1].tinted);
  const std::vector<glm::vec4> plain = tintsOf(crowd, 0), coloured = tintsOf(crowd, 1),
                               alike = tintsOf(crowd, 2), varied = tintsOf(crowd, 3);
  for (const glm::vec4& tint : plain) EXPECT_EQ(tint, glm::vec4(1, 1, 1, 0));
  for (const glm::vec4& tint : coloured) {
    EXPECT_EQ(tint, coloured.front());
    EXPECT_EQ(tint.w, shared::TINT_LIGHTNESS);
    // Of the model's mean lightness it makes the colour.
    EXPECT_NEAR(tint.x * crowd::meanLightness(impl.kinds[0]), 0.5f, 1e-6f);
    EXPECT_NEAR(tint.z * crowd::meanLightness(impl.kinds[0]), 0.125f, 1e-6f);
  }
  for (const glm::vec4& tint : alike) {
    EXPECT_EQ(tint, alike.front());
    EXPECT_EQ(tint.w, shared::TINT_VARIED);
    EXPECT_NEAR(tint.x, shared::LEAST_VALUE + shared::VALUE_RANGE / 2, 1e-6f);
  }
  std::set<float> values;
  for (const glm::vec4& tint : varied) {
    values.insert(tint.y);
    EXPECT_GE(tint.y, shared::LEAST_VALUE - shared::VALUE_RANGE / 2 - 1e-6f);
    EXPECT_LE(tint.y, shared::LEAST_VALUE + 1.5f * shared::VALUE_RANGE + 1e-6f);
  }
  EXPECT_EQ(values.size(), varied.size());
  EXPECT_GT(*values.rbegin() - *values.begin(), shared::VALUE_RANGE);
  Scene other = scene;
  other.seed = 9;
  EXPECT_NE(tintsOf(Crowd(device(), ground, other), 3), varied);
  const auto hasTints = [](const MemoryUse& use) { return use.name == "tint"; };
  EXPECT_TRUE(std::ranges::any_of(crowd.memoryUse(0), hasTints));
  EXPECT_FALSE(std::ranges::any_of(crowd.memoryUse(4), hasTints));
  const Crowd unseen(device(), ground, scene, {.pose = false});
  EXPECT_FALSE(std::ranges::any_of(unseen.memoryUse(0), hasTints));
}

}  // namespace
}  // namespace skitter::test
