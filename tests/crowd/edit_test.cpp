// Heights edited while the crowd walks: feet land on what rises under them, stand anew where the ground
// moves, and nothing else changes.
#include <cmath>

#include "crowd/herd.h"
#include "crowd/simulation.h"
#include "gpu/transfer.h"
#include "skitter/error.h"
#include "validation/convert.h"
#include "validation/herd_facts.h"

namespace skitter::test {
namespace {

using EditTest = GpuLoadTest;
using EditInputTest = GpuTest;

struct Rectangle {
  uint32_t x, z, columns, rows;
};
// The samples within `radius` metres of a world position, and those just outside.
Rectangle around(const Heightfield& field, double x, double z, double radius) {
  const auto sample = [](double at, float origin, float spacing) {
    return static_cast<uint32_t>(std::max(0.0, std::round((at - origin) / spacing)));
  };
  Rectangle r{sample(x - radius, field.originX(), field.spacingX),
              sample(z - radius, field.originZ(), field.spacingZ), 0, 0};
  r.columns = sample(x + radius, field.originX(), field.spacingX) - r.x + 1;
  r.rows = sample(z + radius, field.originZ(), field.spacingZ) - r.z + 1;
  return r;
}

void raise(Crowd& crowd, const Rectangle& r, float by) {
  std::vector<float> heights;
  for (uint32_t z = r.z; z < r.z + r.rows; ++z)
    for (uint32_t x = r.x; x < r.x + r.columns; ++x)
      heights.push_back(crowd.terrain().heights[size_t{z} * crowd.terrain().columns + x] + by);
  crowd.editHeights(r.x, r.z, r.columns, r.rows, heights);
}

// World position of a step's landing.
glm::dvec3 landingOf(const HerdState& state, size_t leg) {
  const reference::Step s = validation::stepOf(state, leg);
  return {s.tileX * shared::TILE_SIZE + s.landing.x, s.landing.y, s.tileZ * shared::TILE_SIZE + s.landing.z};
}
double durationOf(const HerdState& state, size_t leg) { return validation::stepOf(state, leg).duration; }

// Height of a planted foot's landing above the ground as it now is.
double aboveGround(const Crowd& crowd, const HerdState& state, size_t leg) {
  const glm::dvec3 p = landingOf(state, leg);
  return p.y - crowd.terrain().at(static_cast<float>(p.x), static_cast<float>(p.z));
}

TEST_P(EditTest, AFootLandsOnABlockThatRisesUnderIt) {
  Crowd crowd(device(), flatGround(), sceneOf(4));
  simulate(device(), crowd, 150);
  // A leg early in its swing.
  HerdState state = crowd.download(0);
  size_t leg = 0;
  const auto progress = [&] { return state.foot[leg * 4 + 3]; };
  for (int i = 0; i < 60 && !(progress() > 0.3f && progress() < 0.5f); ++i) {
    simulate(device(), crowd, 1);
    state = crowd.download(0);
  }
  ASSERT_LT(progress(), 0.5f);
  const glm::dvec3 aim = landingOf(state, leg);
  const Rectangle block = around(crowd.terrain(), aim.x, aim.z, 0.6);
  raise(crowd, block, 0.12f);
  int ticks = 0;
  bool again = false;
  for (; ticks < 30; ++ticks) {
    simulate(device(), crowd, 1);
    state = crowd.download(0);
    EXPECT_TRUE(state.watched);
    again = again || (static_cast<uint32_t>(state.gait[2]) >> leg & 1u) != 0;
    if (plantedOf(state, leg)) break;
  }
  EXPECT_TRUE(again) << "never aimed anew";
  EXPECT_LT(ticks, 16) << "not in the same swing";
  EXPECT_GT(durationOf(state, leg), 0);
  EXPECT_NEAR(aboveGround(crowd, state, leg), 0, 1e-4);
  // On the block, not where its ground was.
  EXPECT_GT(landingOf(state, leg).y, 0.02);
}

TEST_P(EditTest, FeetStandAnewWhereTheGroundDropsAway) {
  Scene scene = sceneOf(3);
  scene.herds[0].goal.kind = Goal::Kind::none;
  Crowd crowd(device(), flatGround(), scene);
  simulate(device(), crowd, 120);
  const HerdState before = crowd.download(0);
  EXPECT_FALSE(before.watched);
  const glm::dvec3 place = positionOf(before, 1);
  raise(crowd, around(crowd.terrain(), place.x + 0.8, place.z, 0.7), -0.15f);
  simulate(device(), crowd, 110);
  const HerdState after = crowd.download(0);
  int moved = 0;
  for (size_t leg = 0; leg < 24; ++leg) {
    EXPECT_TRUE(plantedOf(after, leg)) << leg;
    EXPECT_NEAR(aboveGround(crowd, after, leg), 0, 0.02) << leg;
    if (landingOf(before, leg) != landingOf(after, leg)) ++moved;
  }
  EXPECT_GE(moved, 3);
  // The others never noticed.
  for (size_t agent : {0u, 2u}) {
    if (std::abs(positionOf(before, agent).x - place.x) < 2.2) continue;
    for (size_t leg = agent * 8; leg < agent * 8 + 8; ++leg)
      EXPECT_EQ(landingOf(before, leg), landingOf(after, leg)) << leg;
  }
}

TEST_P(EditTest, ReplayThroughEdits) {
  Crowd crowd(device(), rollingGround(), sceneOf(32));
  simulate(device(), crowd, 90);
  const crowd::Kind& kind = implOf(crowd).kindOf(0);
  validation::Replay replay(validation::herdFacts(kind, crowd.terrain()));
  HerdState before = crowd.download(0);
  for (int tick = 0; tick < 200; ++tick) {
    if (tick % 20 == 0 && tick < 100) {
      for (size_t agent = 0; agent < 32; ++agent) {
        const glm::dvec3 place = positionOf(before, agent);
        const Rectangle r = around(crowd.terrain(), place.x + 0.6, place.z + 0.7, 0.5);
        raise(crowd, r, agent % 2 == 0 ? 0.15f : -0.2f);
        std::vector<float> now;
        for (uint32_t z = r.z; z < r.z + r.rows; ++z)
          for (uint32_t x = r.x; x < r.x + r.columns; ++x)
            now.push_back(crowd.terrain().heights[size_t{z} * crowd.terrain().columns + x]);
        replay.edit(r.x, r.z, r.columns, r.rows, now);
      }
    }
    simulate(device(), crowd, 1);
    HerdState after = crowd.download(0);
    replay.tick(crowd.tick(), before, after);
    before = std::move(after);
  }
  expectAllPass(replay.results());
}

INSTANTIATE_TEST_SUITE_P(, EditTest, bothLoadPaths(), loadPathName);

// Edits wider and larger than one update of a command buffer takes, whose rows are no part of it, over each
// other and to the last sample.
TEST_F(EditInputTest, TheDeviceHasTheHeightsOfTheTerrain) {
  Crowd crowd(device(), rollingGround(), sceneOf(1));
  const uint32_t columns = crowd.terrain().columns, rows = crowd.terrain().rows;
  for (const Rectangle& r : {Rectangle{0, 0, columns, rows}, Rectangle{20, 10, 300, 200},
                             Rectangle{columns - 130, rows - 127, 130, 127}}) {
    std::vector<float> heights(size_t{r.columns} * r.rows);
    for (size_t i = 0; i < heights.size(); ++i) heights[i] = static_cast<float>(i % 4099) * 1e-3f;
    crowd.editHeights(r.x, r.z, r.columns, r.rows, heights);
  }
  simulate(device(), crowd, 1);
  EXPECT_EQ(gpu::downloadImage<float>(context(), implOf(crowd).heights, gpu::ImageState::sampled),
            crowd.terrain().heights);
}

TEST_F(EditInputTest, TheSameEditsGiveTheSameBits) {
  const auto hash = [&] {
    Crowd crowd(device(), rollingGround(), sceneOf(40), CrowdOptions{.pageAgents = 16});
    simulate(device(), crowd, 30);
    // Wider than one update of a command buffer takes.
    raise(crowd, {0, 0, 513, 200}, 0.05f);
    simulate(device(), crowd, 30);
    return crowd.stateHash();
  };
  EXPECT_EQ(hash(), hash());
}

TEST_F(EditInputTest, AnEditThatChangesNothingShowsNowhere) {
  Crowd edited(device(), rollingGround(), sceneOf(40)), plain(device(), rollingGround(), sceneOf(40));
  for (Crowd* crowd : {&edited, &plain}) simulate(device(), *crowd, 30);
  raise(edited, {200, 0, 40, 300}, 0);
  for (Crowd* crowd : {&edited, &plain}) simulate(device(), *crowd, 30);
  EXPECT_EQ(edited.stateHash(), plain.stateHash());
}

TEST_F(EditInputTest, RefusesWhatDoesNotFit) {
  Crowd crowd(device(), flatGround(), sceneOf(1));
  const std::vector<float> four(4), bad = {0, NAN, 0, 0};
  EXPECT_THROW(crowd.editHeights(128, 0, 2, 2, four), Error);
  EXPECT_THROW(crowd.editHeights(0, UINT32_MAX, 2, 2, four), Error);
  EXPECT_THROW(crowd.editHeights(0, 0, 2, 3, four), Error);
  EXPECT_THROW(crowd.editHeights(0, 0, 2, 2, bad), Error);
  EXPECT_NO_THROW(crowd.editHeights(127, 127, 2, 2, four));
  EXPECT_NO_THROW(crowd.editHeights(0, 0, 0, 0, {}));
  simulate(device(), crowd, 2);
}

}  // namespace
}  // namespace skitter::test
