// A crowd that was saved goes on as if it had never stopped; what is damaged is refused.
#include "skitter/state.h"

#include <gmock/gmock.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "assets/files.h"
#include "crowd/simulation.h"
#include "skitter/error.h"

namespace skitter::test {
namespace {

constexpr int kBefore = 70, kAfter = 50;

bool sameFootfall(const Footfall& a, const Footfall& b) {
  return a.agent == b.agent && a.leg == b.leg && a.tick == b.tick && a.seconds == b.seconds &&
         a.place == b.place && a.speed == b.speed;
}

bool sameFigures(const Fidelity& a, const Fidelity& b) {
  // Sums over pages may be added in another order.
  const auto near = [](double x, double y) { return std::abs(x - y) <= 1e-9 * std::abs(x + y); };
  return a.agentTicks == b.agentTicks && a.stances == b.stances && near(a.slip, b.slip) &&
         near(a.penetration, b.penetration) && near(a.footJerk, b.footJerk) && near(a.bodyJerk, b.bodyJerk) &&
         near(a.margin, b.margin) && a.reachErrorP99 == b.reachErrorP99 && a.lastResorts == b.lastResorts &&
         a.notFinite == b.notFinite;
}

void expectSame(const Crowd& a, const Crowd& b) {
  ASSERT_EQ(a.herdCount(), b.herdCount());
  EXPECT_EQ(a.tick(), b.tick());
  EXPECT_EQ(a.stateHash(), b.stateHash());
  EXPECT_EQ(a.sleeping(), b.sleeping());
  EXPECT_EQ(a.terrain().heights, b.terrain().heights);
  for (uint32_t h = 0; h < a.herdCount(); ++h) {
    const HerdState x = a.download(h), y = b.download(h);
    for (const Record record : allRecords)
      EXPECT_TRUE(sameBits(x.of(record), y.of(record)))
          << "herd " << h << ", record " << static_cast<int>(record) << ": " << x.of(record).size() << ", "
          << y.of(record).size();
    EXPECT_EQ(x.watched, y.watched);
    EXPECT_TRUE(std::ranges::equal(x.footfalls, y.footfalls, sameFootfall)) << "herd " << h;
    EXPECT_EQ(a.droppedFootfalls(h), b.droppedFootfalls(h));
    EXPECT_TRUE(sameFigures(a.fidelity(h), b.fidelity(h))) << "herd " << h;
  }
}

// Herds of every kind: two that share pages, one of them of two sizes, one without agents, another rig.
Scene manyHerds(Controller controller) {
  Scene scene = sceneOf(21, 1, 5, controller);
  scene.herds.resize(4, scene.herds[0]);
  scene.herds[1].rig = SKITTER_ROOT "/assets/quadruped.glb";
  scene.herds[1].controller = Controller::adaptive;  // it has no clips
  scene.herds[1].agents = 10;
  scene.herds[2].agents = 0;
  scene.herds[3].agents = 13;
  scene.herds[3].goal = {.kind = Goal::Kind::point, .target = {3, -4}, .speed = 2};
  scene.herds[3].sizes = {0.5f, 1};
  return scene;
}

// All records that a herd can have.
CrowdOptions everything() { return {.watchEvery = 4, .feet = true, .footfalls = UINT32_MAX}; }

class StateTest : public GpuTest, public ::testing::WithParamInterface<Controller> {};

TEST_P(StateTest, GoesOnAsIfItHadNeverStopped) {
  Crowd crowd(device(), smallRollingGround(), manyHerds(GetParam()), everything());
  simulate(device(), crowd, kBefore);
  State state = parseState(crowd.saveToMemory(), "a state");
  state.options.pageAgents = 7;
  Crowd again(device(), state);
  expectSame(crowd, again);
  simulate(device(), crowd, kAfter);
  simulate(device(), again, kAfter);
  expectSame(crowd, again);
  // From its pages to others, and over the end of a watch.
  Crowd third(device(), parseState(again.saveToMemory(), "another"));
  expectSame(crowd, third);
  simulate(device(), crowd, kAfter);
  simulate(device(), third, kAfter);
  expectSame(crowd, third);
}

TEST_P(StateTest, GoesOnAsleep) {
  Scene scene = sceneOf(20, 1, 1, GetParam());
  scene.herds.push_back(scene.herds[0]);
  scene.herds[0].goal.kind = Goal::Kind::none;
  CrowdOptions options = everything();
  options.sleep = true;
  Crowd crowd(device(), smallRollingGround(), scene, options);
  simulate(device(), crowd, 400);
  ASSERT_GT(crowd.sleeping(), 0u);
  ASSERT_LT(crowd.sleeping(), 40u);
  Crowd again(device(), parseState(crowd.saveToMemory(), "a state"));
  expectSame(crowd, again);
  simulate(device(), crowd, kAfter);
  simulate(device(), again, kAfter);
  expectSame(crowd, again);
}

// `made` has poses that follow from a state without them.
void expectPosesOf(const Crowd& crowd, const Crowd& made) {
  EXPECT_EQ(made.stateHash(), crowd.stateHash());
  const HerdState a = crowd.download(0), b = made.download(0);
  ASSERT_EQ(a.pose.size(), b.pose.size());
  for (size_t i = 0; i < a.pose.size(); ++i) ASSERT_NEAR(a.pose[i], b.pose[i], 1e-5) << i;
}

// Near and far in turn, so that rates change.
void walkSeen(Device& device, Crowd& crowd, int ticks) {
  for (int i = 0; i < ticks; ++i) {
    const auto t = static_cast<float>(crowd.tick() + 1);
    crowd.lookFrom({9 * std::sin(0.05f * t), 1 + 14 * std::abs(std::sin(0.031f * t)), 4});
    simulate(device, crowd, 1);
  }
}

CrowdOptions levelled() {
  return {
      .watchEvery = 4, .feet = true, .levels = Levels{.distances = {6, 10, 14}, .most = {16, 1000, 1000}}};
}

TEST_P(StateTest, GoesOnAtRatesOfItsOwn) {
  Scene scene = manyHerds(GetParam());
  scene.herds[0].reserve = 3;
  scene.herds[0].avoid = true;
  Crowd crowd(device(), smallRollingGround(), scene, levelled());
  crowd.remove(crowd.agentId(0, 1));
  walkSeen(device(), crowd, kBefore);
  State state = parseState(crowd.saveToMemory(), "a state");
  EXPECT_EQ(state.options.levels, levelled().levels);
  state.options.pageAgents = 16;
  Crowd again(device(), state);
  // The camera stays where it was.
  for (Crowd* each : {&crowd, &again}) simulate(device(), *each, 20);
  expectSame(crowd, again);
  for (Crowd* each : {&crowd, &again}) walkSeen(device(), *each, kAfter);
  expectSame(crowd, again);
  const std::vector<LevelFigures> a = crowd.levels(), b = again.levels();
  ASSERT_EQ(a.size(), b.size());
  for (size_t k = 0; k < a.size(); ++k) {
    EXPECT_EQ(a[k].agents, b[k].agents) << a[k].rate;
    EXPECT_EQ(a[k].agentTicks, b[k].agentTicks) << a[k].rate;
    EXPECT_GT(a[k].agentTicks, 0u) << a[k].rate;
  }
}

// Poses and feet that the saved run did not keep. A slow agent's pose is that of its last tick.
TEST_P(StateTest, WhatItLacksFollowsAtRatesOfItsOwn) {
  CrowdOptions few = levelled(), all = levelled();
  few.pose = few.feet = few.measure = all.measure = false;
  Crowd saved(device(), smallRollingGround(), sceneOf(40, 1, 1, GetParam()), few);
  Crowd crowd(device(), smallRollingGround(), sceneOf(40, 1, 1, GetParam()), all);
  for (Crowd* each : {&saved, &crowd}) walkSeen(device(), *each, kBefore);
  State state = parseState(saved.saveToMemory(), "a state");
  state.options = all;
  Crowd again(device(), state);
  expectPosesOf(crowd, again);
  for (Crowd* each : {&crowd, &again}) walkSeen(device(), *each, kAfter);
  expectSame(crowd, again);
}

// A program may give a state levels, or take them away.
TEST_P(StateTest, LevelsMayComeAndGo) {
  Crowd crowd(device(), smallRollingGround(), sceneOf(40, 1, 1, GetParam()));
  simulate(device(), crowd, kBefore);
  State state = parseState(crowd.saveToMemory(), "a state");
  EXPECT_FALSE(state.options.levels);
  state.options.levels = levelled().levels;
  Crowd slower(device(), state);
  EXPECT_THAT(slower.download(0).rate, ::testing::Each(0));
  walkSeen(device(), slower, kAfter);
  EXPECT_GT(slower.levels().back().agentTicks, 0u);
  state = parseState(slower.saveToMemory(), "a state");
  state.options.levels.reset();
  Crowd full(device(), state);
  const HerdState before = full.download(0);
  simulate(device(), full, 1);
  const HerdState after = full.download(0);
  for (size_t agent = 0; agent < 40; ++agent)
    EXPECT_NE(positionOf(before, agent), positionOf(after, agent)) << agent;
}

TEST_P(StateTest, GoesOnAfterAnEdit) {
  Crowd crowd(device(), smallRollingGround(), sceneOf(20, 1, 1, GetParam()), everything());
  simulate(device(), crowd, kBefore);
  const std::vector<float> raised(size_t{30} * 30, 2.0f);
  crowd.editHeights(10, 5, 30, 30, raised);  // no tick has it yet
  Crowd again(device(), parseState(crowd.saveToMemory(), "a state"));
  for (int ticks : {1, kAfter, 150}) {  // the last are beyond those that look at the ground
    simulate(device(), crowd, ticks);
    simulate(device(), again, ticks);
    expectSame(crowd, again);
  }
}

TEST_P(StateTest, BeforeTheFirstTick) {
  Crowd crowd(device(), smallRollingGround(), sceneOf(20, 1, 1, GetParam()), everything());
  const State state = parseState(crowd.saveToMemory(), "a state");
  EXPECT_EQ(state.tick, 0u);
  Crowd again(device(), state);
  expectSame(crowd, again);
  simulate(device(), crowd, kAfter, 1.0f / 50);
  simulate(device(), again, kAfter, 1.0f / 50);
  expectSame(crowd, again);
}

// Steering that no tick has seen, agents and herds that have come and gone, and handles of all of them.
TEST_P(StateTest, GoesOnAfterSteering) {
  Scene scene = sceneOf(6, 1, 1, GetParam());
  scene.herds[0].reserve = 4;
  Crowd crowd(device(), smallRollingGround(), scene, everything());
  simulate(device(), crowd, 20);
  crowd.remove(crowd.agentId(0, 2));
  const AgentId came = crowd.add(0, {{1, 2}, 0.5f}, {.kind = Goal::Kind::point, .target = {5, 5}});
  crowd.remove(crowd.agentId(0, 4));
  const HerdId gone = crowd.addHerd(sceneOf(3, 1, 1, GetParam()).herds[0]);
  const HerdId stays = crowd.addHerd(sceneOf(5, 1, 1, GetParam()).herds[0]);
  simulate(device(), crowd, 20);
  crowd.removeHerd(gone);
  crowd.setSpeed(stays.index, 2);
  crowd.teleport(came, {{-3, 4}, 1});
  Crowd again(device(), parseState(crowd.saveToMemory(), "a state"));
  EXPECT_EQ(again.stateHash(), crowd.stateHash());
  EXPECT_EQ(again.agentCount(), crowd.agentCount());
  EXPECT_TRUE(again.has(came));
  EXPECT_TRUE(again.has(stays));
  EXPECT_FALSE(again.has(gone));
  EXPECT_FALSE(again.has(AgentId(0, 4, 0)));
  simulate(device(), crowd, kAfter);
  simulate(device(), again, kAfter);
  EXPECT_EQ(again.stateHash(), crowd.stateHash());
  const Goal goal{.kind = Goal::Kind::none};
  EXPECT_EQ(again.add(0, {{0, 0}, 0}, goal).bits(), crowd.add(0, {{0, 0}, 0}, goal).bits());
  const Herd next = sceneOf(2, 1, 1, GetParam()).herds[0];
  EXPECT_TRUE(again.addHerd(next) == crowd.addHerd(next));
  simulate(device(), crowd, kAfter);
  simulate(device(), again, kAfter);
  EXPECT_EQ(again.stateHash(), crowd.stateHash());
}

// What nobody had asked for follows from the rest: poses at once, feet and footfalls from the next tick on.
TEST_P(StateTest, WhatItLacksFollows) {
  CrowdOptions few{.pose = false, .measure = false};
  const CrowdOptions all{.measure = false, .feet = true, .footfalls = UINT32_MAX};
  const Scene scene = sceneOf(40, 2, 1, GetParam());
  Crowd saved(device(), smallRollingGround(), scene, few);
  Crowd crowd(device(), smallRollingGround(), scene, all);
  simulate(device(), saved, 240);
  simulate(device(), crowd, 240);
  State state = parseState(saved.saveToMemory(), "a state");
  state.options = all;
  Crowd again(device(), state);
  expectPosesOf(crowd, again);
  const HerdState a = crowd.download(0), b = again.download(0);
  EXPECT_EQ(a.tip.size(), b.tip.size());
  for (size_t i = 0; i < a.flight.size(); i += 4) ASSERT_EQ(a.flight[i + 3], b.flight[i + 3]) << i;
  size_t footfalls = 0;
  for (int i = 0; i < 30; ++i) {
    simulate(device(), crowd, 1);
    simulate(device(), again, 1);
    const std::vector<Footfall> x = crowd.footfalls(0), y = again.footfalls(0);
    ASSERT_EQ(x.size(), y.size());
    footfalls += x.size();
  }
  EXPECT_GT(footfalls, 0u);
  expectSame(crowd, again);
}

INSTANTIATE_TEST_SUITE_P(, StateTest, ::testing::ValuesIn(allControllers),
                         [](const auto& param) { return testNameOf(param.param); });

class StateFileTest : public GpuTest {
 protected:
  Crowd walking(uint32_t agents = 9, const CrowdOptions& options = {}) {
    Crowd crowd(device(), smallRollingGround(), sceneOf(agents), options);
    simulate(device(), crowd, 10);
    return crowd;
  }
  std::string refusalOf(std::vector<std::byte> bytes) {
    return inputFault([&] { Crowd(device(), parseState(std::move(bytes), "a state")); });
  }
};

TEST_F(StateFileTest, SaysWhatItHolds) {
  Scene scene = sceneOf(9);
  scene.name = "nine";
  scene.herds[0].rig = "spider";
  Crowd crowd(device(), smallRollingGround(), scene, {.pose = false, .sleep = true});
  simulate(device(), crowd, 10, 1.0f / 50);
  const TemporaryFolder folder;
  crowd.save(folder / "walk.state", R"({"by": ["a program", 1.5]})");
  const State state = loadState(folder / "walk.state");
  EXPECT_EQ(state.tick, 10u);
  EXPECT_EQ(state.dt, 1.0f / 50);
  EXPECT_TRUE(state.scene == scene);
  EXPECT_EQ(state.terrain.heights, smallRollingGround().heights);
  EXPECT_EQ(state.terrain.name, smallRollingGround().name);
  EXPECT_FALSE(state.options.pose);
  EXPECT_TRUE(state.options.sleep);
  EXPECT_EQ(state.options.watchEvery, 1u);
  EXPECT_EQ(nlohmann::json::parse(state.note), nlohmann::json::parse(R"({"by": ["a program", 1.5]})"));
  EXPECT_TRUE(isState(folder / "walk.state"));
  EXPECT_FALSE(isState(folder / "none"));
  expectSame(crowd, Crowd(device(), state));
  const auto bytes = static_cast<double>(std::filesystem::file_size(folder / "walk.state"));
  EXPECT_NEAR(static_cast<double>(crowd.stateBytes()), bytes, 80e3);
}

TEST_F(StateFileTest, TakesItsNameWhenItIsWhole) {
  const Crowd crowd = walking();
  const TemporaryFolder folder;
  crowd.save(folder / "walk.state");
  const auto before = readBytes(folder / "walk.state");
  EXPECT_EQ(inputFault([&] { crowd.save(folder / "walk.state", "{"); }), "the note of a state is not JSON");
  EXPECT_EQ(readBytes(folder / "walk.state"), before);
  EXPECT_NE(inputFault([&] { crowd.save(folder / "none" / "walk.state"); }).find("cannot be written"),
            std::string::npos);
  size_t files = 0;
  for ([[maybe_unused]] const auto& each : std::filesystem::directory_iterator(folder.path())) ++files;
  EXPECT_EQ(files, 1u);
}

TEST_F(StateFileTest, EveryByteIsChecked) {
  const std::vector<std::byte> whole = walking(3).saveToMemory(R"({"a": 1})");
  EXPECT_EQ(Crowd(device(), parseState(whole, "a state")).tick(), 10u);
  for (size_t at = 0; at < whole.size(); at += at < 200 ? 1 : 4099) {
    std::vector<std::byte> damaged = whole;
    damaged[at] ^= std::byte{0x20};
    EXPECT_EQ(refusalOf(damaged).substr(0, 9), "a state: ") << at;
  }
  std::vector<std::byte> damaged = whole;
  damaged.back() ^= std::byte{1};
  EXPECT_NE(refusalOf(damaged).find("is damaged"), std::string::npos);
}

TEST_F(StateFileTest, MustBeWholeAndAlone) {
  const std::vector<std::byte> whole = walking(3).saveToMemory();
  for (const size_t size : {size_t{0}, size_t{7}, size_t{23}, size_t{24}, size_t{500}, whole.size() / 2,
                            whole.size() - 4, whole.size() - 1})
    EXPECT_EQ(refusalOf({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)}).substr(0, 9),
              "a state: ")
        << size;
  std::vector<std::byte> longer = whole;
  longer.push_back({});
  EXPECT_NE(refusalOf(longer).find("expected"), std::string::npos);
  EXPECT_EQ(refusalOf(std::vector<std::byte>(5000)), "a state: is no state of a crowd");
}

// A file that was copied half over another one of the same scene.
TEST_F(StateFileTest, TwoHalvesAreNoWhole) {
  Crowd crowd = walking();
  const std::vector<std::byte> earlier = crowd.saveToMemory();
  simulate(device(), crowd, 1);
  std::vector<std::byte> later = crowd.saveToMemory();
  ASSERT_EQ(earlier.size(), later.size());
  std::copy(earlier.begin() + static_cast<std::ptrdiff_t>(earlier.size() / 2), earlier.end(),
            later.begin() + static_cast<std::ptrdiff_t>(later.size() / 2));
  EXPECT_NE(refusalOf(later).find("is damaged"), std::string::npos);
}

TEST_F(StateFileTest, OwnRigsAreGivenAgain) {
  Crowd crowd(device(), smallRollingGround(), sceneOf(9), {.rigs = {scaledSpider(0.5f)}});
  simulate(device(), crowd, 10);
  State state = parseState(crowd.saveToMemory(), "a state");
  EXPECT_NE(inputFault([&] { Crowd(device(), state); }).find("must give them again"), std::string::npos);
  state.options.rigs = {scaledSpider(0.5f)};
  expectSame(crowd, Crowd(device(), state));
  state.options.rigs = {scaledSpider(0.6f)};
  EXPECT_NE(inputFault([&] { Crowd(device(), state); }).find("other legs or clips"), std::string::npos);
}

TEST_F(StateFileTest, OwnRigsAreOfTheHerdsThatItBeganWith) {
  Scene scene = sceneOf(9);
  scene.events = {{0.1f, HerdAddition{sceneOf(4).herds[0]}}};
  Crowd crowd(device(), smallRollingGround(), scene, {.rigs = {scaledSpider(0.5f)}});
  simulate(device(), crowd, 10);
  ASSERT_EQ(crowd.herdCount(), 2u);
  State state = parseState(crowd.saveToMemory(), "a state");
  state.options.rigs = {scaledSpider(0.5f)};
  Crowd again(device(), state);
  for (Crowd* each : {&crowd, &again}) simulate(device(), *each, 10);
  EXPECT_EQ(again.stateHash(), crowd.stateHash());
  state.options.rigs.resize(3, scaledSpider(0.5f));
  EXPECT_EQ(inputFault([&] { Crowd(device(), state); }),
            "a state: 3 rigs for 2 herds, expected one for each that the crowd began with");
}

TEST_F(StateFileTest, FiguresAreKeptOrNot) {
  State state = parseState(walking(9, {.measure = false}).saveToMemory(), "a state");
  state.options.measure = true;
  EXPECT_EQ(inputFault([&] { Crowd(device(), state); }),
            "a state: has no metric records, which the crowd's options ask for");
  state = parseState(walking(9).saveToMemory(), "a state");
  state.options.watchEvery = 2;
  EXPECT_NE(inputFault([&] { Crowd(device(), state); }).find("expected 1"), std::string::npos);
}

}  // namespace
}  // namespace skitter::test
