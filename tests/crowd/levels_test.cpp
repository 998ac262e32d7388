// Levels of rate (docs/levels.md): who is far from the camera ticks less often, and nobody sees it.
#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <string>

#include "crowd/herd.h"
#include "crowd/simulation.h"
#include "skitter/error.h"
#include "skitter/levels.h"
#include "validation/lockstep/lockstep.h"

namespace skitter::test {
namespace {

using ::testing::HasSubstr;

constexpr Levels near = {.distances = {6, 10, 14}, .most = {1000, 1000, 1000}};

CrowdOptions levelled(const Levels& levels = near) {
  CrowdOptions options;
  options.feet = true;
  options.levels = levels;
  return options;
}

int levelOf(const HerdState& state, size_t agent) { return static_cast<int>(state.rate.at(4 * agent)); }

// So high above the middle that everybody has an eighth of the rate.
constexpr glm::vec3 farAway{0, 500, 0};

// Over the crowd and away, at less than 40 m.
glm::vec3 cameraAt(uint64_t tick) {
  const auto t = static_cast<float>(tick);
  return {20 * std::sin(0.05f * t), 1 + 12 * std::abs(std::sin(0.031f * t)), 20 * std::cos(0.043f * t)};
}

void walk(Device& device, Crowd& crowd, int ticks, const std::function<glm::vec3(uint64_t)>& camera) {
  for (int i = 0; i < ticks; ++i) {
    crowd.lookFrom(camera(crowd.tick() + 1));
    simulate(device, crowd, 1);
  }
}
const auto away = [](uint64_t) { return farAway; };

Scene someOf(uint32_t agents, Controller controller) {
  Scene scene = sceneOf(agents, 1, 1, controller);
  scene.herds[0].spawn.kind = Spawn::Kind::grid;
  scene.herds[0].spawn.spacing = 2;
  return scene;
}

class LevelsFootTest : public GpuTest {};
class LevelsTest : public GpuTest, public ::testing::WithParamInterface<Controller> {
 protected:
  Scene sceneOfSome(uint32_t agents) const { return someOf(agents, GetParam()); }
};

TEST_P(LevelsTest, WithoutThemACameraChangesNothing) {
  Crowd crowd(device(), smallRollingGround(), sceneOfSome(20)),
      seen(device(), smallRollingGround(), sceneOfSome(20));
  simulate(device(), crowd, 30);
  walk(device(), seen, 30, cameraAt);
  EXPECT_EQ(crowd.stateHash(), seen.stateHash());
  EXPECT_TRUE(crowd.levels().empty());
  EXPECT_TRUE(crowd.download(0).rate.empty());
}

TEST_P(LevelsTest, WithoutACameraEverybodyTicks) {
  Crowd crowd(device(), smallRollingGround(), sceneOfSome(20), levelled());
  simulate(device(), crowd, 10);
  const std::vector<LevelFigures> levels = crowd.levels();
  ASSERT_EQ(levels.size(), 4u);
  EXPECT_EQ(levels[0].agents, 20u);
  EXPECT_EQ(levels[0].agentTicks, 200u);
}

TEST_P(LevelsTest, TheSameCameraGivesTheSameBits) {
  const Heightfield ground = smallRollingGround();
  const Levels levels{.distances = {6, 10, 14}, .most = {8, 16, 16}};
  CrowdOptions paged = levelled(levels), apart = levelled(levels);
  paged.pageAgents = 16;
  apart.fuse = false;
  Crowd whole(device(), ground, sceneOfSome(60), levelled(levels)),
      inPages(device(), ground, sceneOfSome(60), paged), inParts(device(), ground, sceneOfSome(60), apart),
      other(device(), ground, sceneOfSome(60), levelled(levels));
  for (int i = 0; i < 12; ++i) {
    for (Crowd* crowd : {&whole, &inPages, &inParts}) walk(device(), *crowd, 20, cameraAt);
    walk(device(), other, 20, [](uint64_t tick) { return -cameraAt(tick); });
    ASSERT_EQ(whole.stateHash(), inPages.stateHash()) << "tick " << whole.tick();
    ASSERT_EQ(whole.stateHash(), inParts.stateHash()) << "tick " << whole.tick();
  }
  EXPECT_NE(whole.stateHash(), other.stateHash());
}

TEST_P(LevelsTest, WhoIsFarAwayMovesInEveryEighthTick) {
  Crowd crowd(device(), smallRollingGround(), sceneOfSome(60), levelled());
  walk(device(), crowd, 16, away);
  HerdState before = crowd.download(0);
  std::vector<int> moves(60);
  std::vector<int> perTick;
  for (int i = 0; i < 16; ++i) {
    walk(device(), crowd, 1, away);
    const HerdState after = crowd.download(0);
    int moving = 0;
    for (size_t agent = 0; agent < 60; ++agent) {
      EXPECT_EQ(levelOf(after, agent), 3);
      moving += positionOf(before, agent) != positionOf(after, agent) ? 1 : 0;
      moves[agent] += positionOf(before, agent) != positionOf(after, agent) ? 1 : 0;
    }
    perTick.push_back(moving);
    before = after;
  }
  EXPECT_THAT(moves, ::testing::Each(2));
  // Eight blocks, the last of four agents: one a tick.
  for (const int moving : perTick) EXPECT_THAT(moving, ::testing::AnyOf(8, 4));
}

// No tick of an agent is longer than 2/15 s, if the crowd's are not.
TEST_P(LevelsTest, LongTicksHaveFewerRates) {
  for (const auto& [dt, slowest] :
       {std::pair(1.0f / 30, 2), {1.0f / 24, 1}, {1.0f / 15, 1}, {0.1f, 0}, {0.15f, 0}}) {
    Crowd crowd(device(), smallRollingGround(), sceneOfSome(20), levelled());
    crowd.lookFrom(farAway);
    simulate(device(), crowd, 9, dt);
    const HerdState state = crowd.download(0);
    for (size_t agent = 0; agent < 20; ++agent) EXPECT_EQ(levelOf(state, agent), slowest) << dt;
  }
}

// A share of the way that they would walk at full rate. At an eighth, a body waits for its feet.
TEST_P(LevelsTest, TheyWalkNearlyAsFarAsAtFullRate) {
  const Heightfield ground = rollingGround();
  const auto start = Crowd(device(), ground, sceneOf(64, 1, 1, GetParam())).download(0);
  const auto wayOf = [&](const CrowdOptions& options) {
    Crowd crowd(device(), ground, sceneOf(64, 1, 1, GetParam()), options);
    walk(device(), crowd, 8 * 37, away);
    const HerdState end = crowd.download(0);
    double way = 0;
    for (size_t agent = 0; agent < 64; ++agent)
      way += glm::length(positionOf(end, agent) - positionOf(start, agent));
    return way;
  };
  const double full = wayOf({});
  const double quarter = wayOf(levelled({.distances = {0, 0, 8000}, .most = {0, 0, 64}}));
  EXPECT_NEAR(quarter / full, 1, 0.05);
  const double eighth = wayOf(levelled()), least = GetParam() == Controller::adaptive ? 0.7 : 0.9;
  EXPECT_GT(eighth / full, least);
  EXPECT_LT(eighth / full, 1.1);
}

// The goals of docs/levels.md, as shares of the leg length.
TEST_F(LevelsFootTest, SlowFeetHardlySlide) {
  const Heightfield ground = rollingGround();
  const auto slipOf = [&](const Levels& levels, uint32_t rate) {
    CrowdOptions options;
    options.levels = levels;
    Crowd crowd(device(), ground, sceneOf(64, 1, 1, Controller::adaptive), options);
    walk(device(), crowd, 600, away);
    for (const LevelFigures& level : crowd.levels())
      if (level.rate == rate) return level.slip.value_or(1);
    return 1.0;
  };
  EXPECT_LT(slipOf({.distances = {0, 8000, 8000}, .most = {0, 64, 64}}, 2), 2e-4);
  EXPECT_LT(slipOf({.distances = {0, 0, 8000}, .most = {0, 0, 64}}, 4), 5e-4);
  EXPECT_LT(slipOf({.distances = {0, 0, 0}, .most = {0, 0, 0}}, 8), 5e-3);
}

TEST_P(LevelsTest, CountsAddUpAndNumbersAreKept) {
  const Levels levels{.distances = {1000, 1000, 1000}, .most = {16, 24, 40}};
  Crowd crowd(device(), rollingGround(), sceneOfSome(200), levelled(levels));
  const auto middle = [](uint64_t) { return glm::vec3(0, 2, 0); };
  walk(device(), crowd, 40, middle);
  uint64_t ticks = 0;
  for (const LevelFigures& level : crowd.levels()) ticks += level.agentTicks;
  for (int i = 0; i < 16; ++i) {
    walk(device(), crowd, 1, middle);
    const std::vector<LevelFigures> now = crowd.levels();
    ASSERT_EQ(now.size(), 4u);
    uint64_t agents = 0;
    for (const LevelFigures& level : now) agents += level.agents;
    EXPECT_EQ(agents, 200u);
    EXPECT_LE(now[0].agents, 16u);
    EXPECT_LE(now[0].agents + now[1].agents, 40u);
    EXPECT_LE(now[0].agents + now[1].agents + now[2].agents, 80u);
    EXPECT_GE(now[3].agents, 120u);
    EXPECT_GT(now[0].agents, 0u);
  }
  uint64_t later = 0;
  for (const LevelFigures& level : crowd.levels()) later += level.agentTicks;
  // 16 at most in each tick, 24 in every second, 40 in every fourth, the others in every eighth.
  EXPECT_LE(later - ticks, 16u * (16 + 24 / 2 + 40 / 4 + 200 / 8));
  EXPECT_GE(later - ticks, 16u * 200 / 8);
}

// Where a foot is to stand stays, to the rounding of places within 32 m, while its agent changes rate. Feet
// of controller loop slide at every rate.
TEST_F(LevelsFootTest, NoPlantedFootJumpsAsTheRateChanges) {
  Crowd crowd(device(), smallRollingGround(), someOf(40, Controller::adaptive), levelled());
  const double leg = crowd.rig(0).legLength;
  const size_t legs = crowd.rig(0).legs.size();
  HerdState before = crowd.download(0);
  int changes = 0;
  double most = 0;
  for (int i = 0; i < 400; ++i) {
    const bool isNear = i / 50 % 2 == 1;
    walk(device(), crowd, 1, [&](uint64_t) { return isNear ? glm::vec3(0, 1, 0) : farAway; });
    const HerdState after = crowd.download(0);
    for (size_t agent = 0; agent < 40; ++agent) {
      changes += levelOf(before, agent) != levelOf(after, agent) ? 1 : 0;
      const glm::dvec3 moved = positionOf(after, agent) - positionOf(before, agent);
      for (size_t l = agent * legs; l < (agent + 1) * legs; ++l) {
        if (!plantedOf(before, l) || !plantedOf(after, l)) continue;
        glm::dvec3 apart = moved;
        for (int axis = 0; axis < 3; ++axis)
          apart[axis] += double{after.foot[4 * l + static_cast<size_t>(axis)]} -
                         double{before.foot[4 * l + static_cast<size_t>(axis)]};
        most = std::max(most, glm::length(apart) / leg);
      }
    }
    before = after;
  }
  EXPECT_GT(changes, 40);
  EXPECT_LT(most, 1e-5);
}

TEST_P(LevelsTest, TheReferenceFollowsEveryRate) {
  const Levels levels{.distances = {6, 10, 14}, .most = {16, 16, 1000}};
  for (const bool fuse : {true, false}) {
    CrowdOptions options = levelled(levels);
    options.fuse = fuse;
    const Scene scene = sceneOfSome(60);
    Crowd crowd(device(), smallRollingGround(), scene, options);
    validation::Lockstep lockstep(crowd, scene, kTick);
    for (int i = 0; i < 240; ++i) {
      lockstep.begin();
      crowd.lookFrom(cameraAt(crowd.tick() + 1));
      simulate(device(), crowd, 1);
      lockstep.end();
    }
    expectAllPass(lockstep.results());
    for (const LevelFigures& level : crowd.levels()) EXPECT_GT(level.agentTicks, 100u) << level.rate;
    EXPECT_EQ(lockstep.results()[1].name, "wake");
  }
}

INSTANTIATE_TEST_SUITE_P(, LevelsTest, ::testing::ValuesIn(allControllers),
                         [](const auto& each) { return testNameOf(each.param); });

class LevelsRefusalTest : public GpuTest {
 protected:
  void expectRefused(const Scene& scene, const CrowdOptions& options, const std::string& expected) {
    try {
      Crowd crowd(device(), smallRollingGround(), scene, options);
      FAIL() << expected;
    } catch (const Error& fault) {
      EXPECT_EQ(fault.kind(), Error::Kind::input);
      EXPECT_THAT(fault.what(), HasSubstr(expected));
    }
  }
};

TEST_F(LevelsRefusalTest, NamesWhatTheyAreNotMadeFor) {
  CrowdOptions options = levelled();
  options.sleep = true;
  expectRefused(sceneOf(9), options, "levels of rate with sleep");
  for (const auto& [distances, fault] : {std::pair<std::array<float, 3>, const char*>{
                                             {20, 10, 180}, "distances[1] is 10, expected 20 to 8000"},
                                         {{-1, 10, 180}, "distances[0] is -1, expected 0 to 8000"},
                                         {{1, NAN, 180}, "distances[1] is nan"},
                                         {{1, 2, 9000}, "distances[2] is 9000"}})
    expectRefused(sceneOf(9), levelled({.distances = distances, .most = {1, 1, 1}}), fault);
}

TEST_F(LevelsRefusalTest, OfCameras) {
  Crowd crowd(device(), smallRollingGround(), sceneOf(9), levelled());
  EXPECT_THROW(crowd.lookFrom({0, NAN, 0}), Error);
}

TEST(Levels, AreReadFromJson) {
  const Levels levels = parseLevels(R"({"distances": [1, 2.5, 2.5], "most": [3, 4, 5]})", "some.json");
  EXPECT_EQ(levels, (Levels{.distances = {1, 2.5f, 2.5f}, .most = {3, 4, 5}}));
  EXPECT_EQ(loadLevels("default"), Levels{});
  try {
    parseLevels(R"({"distance": [1, 2, 3]})", "some.json");
    FAIL();
  } catch (const Error& fault) {
    EXPECT_THAT(fault.what(), HasSubstr("some.json: distance is no known key; did you mean distances?"));
  }
}

}  // namespace
}  // namespace skitter::test
