// Prints that feet leave (docs/stages/pictures.md, Footprints).
#include <algorithm>
#include <cmath>

#include "render/pictures.h"
#include "skitter/records.h"
#include "support/gpu_fixture.h"

namespace skitter::render {
namespace {

constexpr uint32_t kSeenWidth = 512, kSeenHeight = 384;

class FootprintTest : public test::GpuLoadTest {
 protected:
  static Scene walker(uint32_t agents) {
    Scene scene = test::smallScene(agents);
    scene.herds[0].spawn = Spawn{.kind = Spawn::Kind::grid, .spacing = 3, .centre = {1, 0}};
    // Over the corner of four tiles.
    scene.herds[0].goal = Goal{.kind = Goal::Kind::point, .target = {-6, 6}, .speed = 1};
    return scene;
  }
};
INSTANTIATE_TEST_SUITE_P(Loads, FootprintTest, test::bothLoadPaths(), test::loadPathName);

// From high above the middle.
const View kAbove{.eye = {0, 24, 2}, .target = {0, 0, 2.01f}, .fieldOfView = 0.35f};

// The places that feet have left in a tick.
std::vector<glm::vec3> leftBy(const HerdState& before, const HerdState& after, size_t legs, float tick) {
  std::vector<glm::vec3> places;
  for (size_t l = 0; l < size_t(after.agents) * legs; ++l) {
    const float *was = &before.step[l * 4 * shared::STEP_STRIDE],
                *now = &after.step[l * 4 * shared::STEP_STRIDE];
    const size_t agent = l / legs;
    if (was[3] == now[3]) continue;
    // On its way it may be aimed anew; then it lifts off from the air.
    const float ticks = shared::ticksOf(was[7]);
    if (tick - 1 < was[3] + ticks) continue;
    const float tile = before.body[agent * 4 * shared::BODY_STRIDE + 3];
    const float apart = shared::tilesApart(shared::tileOfTicks(was[7]),
                                           shared::stepTile(shared::tileX(tile), shared::tileZ(tile)));
    places.emplace_back(was[0] + shared::TILE_SIZE * (shared::tileX(tile) + shared::apartX(apart)), was[1],
                        was[2] + shared::TILE_SIZE * (shared::tileZ(tile) + shared::apartZ(apart)));
  }
  return places;
}

TEST_P(FootprintTest, areWhereFeetStood) {
  const Scene scene = walker(3);
  test::Stage plain(device(), scene, kSeenWidth, kSeenHeight),
      printed(device(), scene, kSeenWidth, kSeenHeight, {.footprints = true});
  const size_t legs = plain.crowd.rig(0).legs.size();
  std::vector<glm::vec3> places;
  test::Picture without, with;
  HerdState before = plain.crowd.download(0);
  for (int tick = 0; tick < 150; ++tick) {
    for (test::Stage* stage : {&plain, &printed}) stage->tick(1);
    with = printed.draw(kAbove);
    const HerdState after = plain.crowd.download(0);
    if (tick > 0)
      for (const glm::vec3& place : leftBy(before, after, legs, float(tick + 1))) places.push_back(place);
    before = after;
  }
  without = plain.draw(kAbove);
  ASSERT_GT(places.size(), 60u);

  const auto pixelIn = [](const glm::vec3& p) { return test::pixelOf(kAbove, p, kSeenWidth, kSeenHeight); };
  const auto light = [](const test::Picture& picture, uint32_t x, uint32_t y) {
    int sum = 0;
    for (size_t c = 0; c < 3; ++c) sum += picture.rgba[4 * (size_t(y) * kSeenWidth + x) + c];
    return sum;
  };
  // A print is two pixels wide here; what is blended with its neighbours at edges may be one further.
  const float metre = 0.5f * kSeenHeight / std::tan(0.5f * kAbove.fieldOfView) / (24 - 3);
  const float radius = 0.085f * plain.crowd.rig(0).legLength * metre + 2;
  size_t dark = 0, lighter = 0, found = 0;
  for (uint32_t y = 0; y < kSeenHeight; ++y)
    for (uint32_t x = 0; x < kSeenWidth; ++x) {
      const int less = light(without, x, y) - light(with, x, y);
      lighter += less < -20 ? 1 : 0;
      if (less < 20) continue;
      ++dark;
      const glm::vec2 at(float(x) + 0.5f, float(y) + 0.5f);
      EXPECT_TRUE(std::ranges::any_of(
          places, [&](const glm::vec3& place) { return glm::distance(pixelIn(place), at) < radius; }))
          << x << ", " << y;
    }
  for (const glm::vec3& place : places) {
    const glm::vec2 at = pixelIn(place);
    const auto x = uint32_t(at.x), y = uint32_t(at.y);
    found += x < kSeenWidth && y < kSeenHeight && light(without, x, y) - light(with, x, y) >= 20 ? 1 : 0;
  }
  EXPECT_GT(dark, places.size());
  // Next to a print the filter of edges may find another edge than before.
  EXPECT_LT(lighter, dark / 50);
  // All but those below who walks on.
  EXPECT_GT(found, places.size() * 8 / 10) << places.size();
}

// They fade, and after their twenty seconds none is left.
TEST_P(FootprintTest, fade) {
  Scene scene = walker(1);
  scene.herds[0].goal = Goal{.kind = Goal::Kind::point, .target = {0, 3}, .speed = 2};
  test::Stage plain(device(), scene, kSeenWidth, kSeenHeight),
      printed(device(), scene, kSeenWidth, kSeenHeight, {.footprints = true});
  const auto printsNow = [&] {
    const test::Picture without = plain.draw(kAbove), with = printed.draw(kAbove);
    double sum = 0;
    for (size_t i = 0; i < with.rgba.size(); ++i) sum += std::abs(int(with.rgba[i]) - int(without.rgba[i]));
    return sum;
  };
  // Where it comes to, it stands.
  for (int i = 0; i < 300; ++i) {
    printed.tick(1);
    printed.draw(kAbove);
  }
  plain.tick(300);
  const double fresh = printsNow();
  for (test::Stage* stage : {&plain, &printed}) stage->tick(750);
  const double old = printsNow();
  EXPECT_GT(old, 0.1 * fresh);
  EXPECT_LT(old, 0.9 * fresh);
  for (test::Stage* stage : {&plain, &printed}) stage->tick(450);
  EXPECT_EQ(printsNow(), 0);
}

// A herd that comes makes the drawing of all anew; the prints stay.
TEST_P(FootprintTest, stayAsHerdsCome) {
  const Scene scene = walker(2);
  test::Stage stage(device(), scene, kSeenWidth, kSeenHeight, {.footprints = true});
  for (int i = 0; i < 90; ++i) {
    stage.tick(1);
    stage.draw(kAbove);
  }
  const test::Picture before = stage.draw(kAbove);
  Herd far = scene.herds[0];
  far.spawn.centre = {-25, -25};
  stage.crowd.addHerd(far);
  EXPECT_EQ(test::differing(before, stage.draw(kAbove)), 0u);
}

}  // namespace
}  // namespace skitter::render
