#include "crowd/events.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "crowd/simulation.h"
#include "skitter/error.h"

namespace skitter::test {
namespace {

using ::testing::HasSubstr;

class EventsTest : public GpuTest {};

TEST(Events, HappenBeforeTheFirstTickThatEndsThenOrLater) {
  std::vector<Event> events;
  for (const float at : {0.0f, 0.05f, 0.1f, 0.1f, 0.11f, 5.0f}) events.push_back({at, Mound{}});
  const auto counts = [&](double dt, uint64_t ticks) {
    std::vector<size_t> each;
    for (uint64_t tick = 1; tick <= ticks; ++tick) each.push_back(crowd::eventsAt(events, tick, dt).size());
    return each;
  };
  EXPECT_EQ(counts(0.1, 4), (std::vector<size_t>{4, 1, 0, 0}));
  EXPECT_EQ(counts(0.05, 4), (std::vector<size_t>{2, 2, 1, 0}));
  // 5 s are 300 ticks of a sixtieth, though neither is exact.
  EXPECT_EQ(crowd::eventsAt(events, 300, double{1.0f / 60}).size(), 1u);
  EXPECT_EQ(crowd::eventsAt(events, 301, double{1.0f / 60}).size(), 0u);
}

// What a scene says happens as if the caller did it.
TEST_F(EventsTest, AreWhatTheCallerCouldDo) {
  const Heightfield ground = rollingGround();
  Scene scene = sceneOf(40);
  Scene plain = scene;
  scene.events = {{0.25f, HeightSamples{60, 70, 2, 1, {1.5f, -1}}},
                  {0.5f, Mound{.centre = {1, 2}, .radius = 3, .height = -0.7f}}};
  Crowd crowd(device(), ground, scene), other(device(), ground, plain);
  const auto both = [&](int ticks) {
    simulate(device(), crowd, ticks);
    simulate(device(), other, ticks);
  };
  both(14);
  EXPECT_EQ(crowd.stateHash(), other.stateHash());
  other.editHeights(60, 70, 2, 1, std::vector<float>{1.5f, -1});
  both(1);
  EXPECT_EQ(crowd.terrain().heights, other.terrain().heights);
  EXPECT_EQ(crowd.terrain().heights[70 * ground.columns + 61], -1);
  both(14);
  EXPECT_EQ(crowd.stateHash(), other.stateHash());
  simulate(device(), crowd, 1);
  const Heightfield& edited = crowd.terrain();
  size_t changed = 0;
  for (uint32_t z = 0; z < ground.rows; ++z)
    for (uint32_t x = 0; x < ground.columns; ++x) {
      const size_t at = size_t{z} * ground.columns + x;
      const float before = other.terrain().heights[at], after = edited.heights[at];
      const double px = double{ground.originX()} + x * double{ground.spacingX} - 1;
      const double pz = double{ground.originZ()} + z * double{ground.spacingZ} - 2;
      const double inside = std::max(0.0, 1 - (px * px + pz * pz) / 9);
      ASSERT_NEAR(after - before, -0.7 * inside * inside, 1e-4) << x << ", " << z;
      changed += after != before;
    }
  EXPECT_GT(changed, 50u);
  EXPECT_TRUE(crowd.download(0).watched);
}

TEST_F(EventsTest, BeyondTheMapAreRefusedOrChangeNothing) {
  const Heightfield ground = flatGround();
  const auto fault = [&](Event event) -> std::string {
    Scene scene = sceneOf(2);
    scene.name = "late.json";
    scene.events = {{0, Mound{}}, std::move(event)};
    try {
      Crowd crowd(device(), ground, scene);
      simulate(device(), crowd, 2);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), Error::Kind::input);
      return error.what();
    }
    return "taken";
  };
  EXPECT_THAT(fault({0, HeightSamples{ground.columns - 1, 0, 2, 1, {0, 0}}}),
              HasSubstr("late.json: events[1].edit"));
  EXPECT_THAT(fault({std::numeric_limits<float>::quiet_NaN(), Mound{}}), HasSubstr("events[1].at is nan"));
  EXPECT_THAT(fault({0, Mound{.radius = 0}}), HasSubstr("events[1].mound"));
  EXPECT_EQ(fault({0, Mound{.centre = {4000, 4000}}}), "taken");
}

// assets/scenes/events.json.
TEST_F(EventsTest, ExampleRuns) {
  const Scene scene = loadScene(SKITTER_ROOT "/assets/scenes/events.json");
  const Heightfield ground = scene.loadTerrain();
  Crowd crowd(device(), ground, scene);
  ASSERT_EQ(scene.events.size(), 3u);
  std::vector<float> before = ground.heights;
  for (const Event& event : scene.events) {
    const auto due = static_cast<int>(std::lround(60 * event.at)) - 1;
    simulate(device(), crowd, due - static_cast<int>(crowd.tick()));
    EXPECT_EQ(crowd.terrain().heights, before) << event.at;
    simulate(device(), crowd, 1);
    EXPECT_NE(crowd.terrain().heights, before) << event.at;
    before = crowd.terrain().heights;
  }
  EXPECT_LT(crowd.fidelity().penetration, 0.01);
}

}  // namespace
}  // namespace skitter::test
