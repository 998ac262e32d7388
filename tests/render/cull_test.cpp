// Who is drawn at which level and who casts shadows, held against docs/stages/pictures.md.
#include "render/cull.h"

#include <algorithm>
#include <random>

#include "gpu/submit.h"
#include "gpu/transfer.h"
#include "render/composition.h"
#include "render/sight.h"
#include "skitter/records.h"
#include "support/gpu_fixture.h"

namespace skitter::render {
namespace {

using test::Sight;
using Lists = std::vector<int>;  // ascending: 0 to 4 the camera's levels, 5 and 6 the near
                                 // cascade, 7 the far one, 8 contacts, 9 splats, 10 who fades
                                 // into them, 11 and 12 whose near and far shadow does, 13 who is
                                 // interpolated

constexpr uint32_t kWidth = 640, kHeight = 360;
constexpr float kRadius = 0.8f;

class CullTest : public test::GpuLoadTest {
 protected:
  // The lists that each agent is on.
  std::vector<Lists> cull(const shared::Picture& picture, const std::vector<glm::dvec3>& places,
                          bool splats = false, float detail = 1, bool listsShown = false) {
    std::vector<float> bodies(places.size() * shared::BODY_STRIDE * 4);
    for (size_t i = 0; i < places.size(); ++i) {
      const glm::dvec3 tile = glm::floor(places[i] / double(shared::TILE_SIZE));
      float* body = &bodies[i * shared::BODY_STRIDE * 4];
      body[0] = float(places[i].x - tile.x * double(shared::TILE_SIZE));
      body[1] = float(places[i].y);
      body[2] = float(places[i].z - tile.z * double(shared::TILE_SIZE));
      body[3] = shared::packedTile(float(tile.x), float(tile.z));
    }
    const auto agents = uint32_t(places.size());
    const gpu::Buffer block(context(), sizeof picture, "picture", gpu::BufferUse::uniform);
    const gpu::Buffer records(context(), bodies.size() * sizeof(float), "bodies");
    gpu::upload(context(), block, std::span(&picture, 1));
    gpu::upload(context(), records, bodies);
    const Cull cull(context(), detail);
    const CulledPage page = cull.makePage(context(), block, records, agents, listsShown);
    gpu::clear(context(), page.commands);
    gpu::submitAndWait(context(), [&](vk::CommandBuffer cmd) { cull.record(cmd, page, kRadius, splats); });

    const auto draws = gpu::download<VkDrawIndexedIndirectCommand>(context(), page.commands);
    const auto instances = gpu::download<uint32_t>(context(), page.instances);
    groups_ = draws.at(shared::SPLATS).firstIndex;
    shownGroups_ = draws.at(shared::SHOWN).firstIndex;
    std::vector<Lists> found(agents);
    steps_.assign(agents, {});
    for (int list = 0; list < shared::INSTANCE_LISTS; ++list)
      for (uint32_t i = 0; i < draws.at(size_t(list)).instanceCount; ++i) {
        const uint32_t entry = instances.at(size_t(list) * agents + i), agent = entry & 0xFFFFFF;
        found.at(agent).push_back(list);
        if (list >= shared::FADING && list < shared::SHOWN) steps_.at(agent).push_back(entry >> 24);
      }
    return found;
  }

  uint32_t groups_ = 0;                       // that splats were dispatched over
  uint32_t shownGroups_ = 0;                  // that those who are interpolated were
  std::vector<std::vector<uint32_t>> steps_;  // how far each agent has faded, on each list of those
};
INSTANTIATE_TEST_SUITE_P(Loads, CullTest, test::bothLoadPaths(), test::loadPathName);

// Far from the world's origin, in no axis' direction; 20 m to its target, so drawing ends after 210 m.
const View kView{.eye = {-203, 12, 517}, .target = {-191, 4.0f, 530.8564f}, .fieldOfView = 0.9f};
constexpr double kEnd = 210;
constexpr std::array kThresholds{150.0, 75.0, 25.0, 10.0};
constexpr double kContactThreshold = 40;

bool isShadow(int list) { return list >= 5 && list <= 7; }

shared::Picture picture() {
  const Heightfield field{
      .name = "flat", .columns = 2, .rows = 2, .spacingX = 9, .spacingZ = 9, .heights = {0, 0, 0, 0}};
  return compose(kView, lightModel({}), field, 0, 0, kWidth, kHeight, 1024).block;
}

// A sphere that touches the pyramid is drawn; up to four radii outside it casts.
TEST_P(CullTest, thePyramidsSidesDecide) {
  const Sight s(kView, kWidth, kHeight);
  std::vector<glm::dvec3> places;
  std::vector<std::pair<bool, bool>> expected;  // drawn, casts
  const auto expect = [&](const glm::dvec3& bound, const glm::dvec3& outward) {
    for (const double radii : {0.99, 1.01, 3.99, 4.01}) {
      places.push_back(bound + radii * double(kRadius) * glm::normalize(outward));
      expected.push_back({radii < 1, radii < 4});
    }
  };
  for (const glm::dvec2 side : {glm::dvec2(1, 0), {-1, 0}, {0, 1}, {0, -1}})
    expect(s.at(20, side.x, side.y),
           side.x * s.right + side.y * s.up - (side.x == 0 ? s.tanY : s.tanX) * s.forward);
  // Where drawing ends shadows have long faded.
  for (const double radii : {0.99, 1.01}) {
    places.push_back(s.at(kEnd, 0, 0) + radii * double(kRadius) * s.forward);
    expected.push_back({radii < 1, false});
  }
  // 1.9 times 4.5 distances to the target ahead they have.
  for (const double radii : {3.99, 4.01}) {
    places.push_back(s.at(1.9 * 4.5 * 20 + radii * double(kRadius), 0, 0));
    expected.push_back({true, radii < 4});
  }
  places.push_back(s.at(-10, 0, 0));
  expected.push_back({false, false});

  const std::vector<Lists> found = cull(picture(), places);
  for (size_t i = 0; i < places.size(); ++i) {
    EXPECT_EQ(!found[i].empty() && found[i].front() < 5, expected[i].first) << "agent " << i;
    EXPECT_EQ(std::ranges::any_of(found[i], isShadow), expected[i].second) << "agent " << i;
  }
}

// The radius in pixels as seen from the eye chooses the level, in the middle and at the picture's edge.
TEST_P(CullTest, theRadiusInPixelsChoosesTheLevel) {
  const Sight s(kView, kWidth, kHeight);
  const double onePixel = double(kRadius) * kHeight / (2 * s.tanY);  // metres away
  std::vector<glm::dvec3> places;
  std::vector<int> expected;
  for (int level = 0; level < 4; ++level)
    for (const double share : {1.005, 0.995})
      for (const double x : {0.0, 0.9}) {
        const double away = onePixel / (kThresholds[size_t(level)] * share);
        places.push_back(s.eye + away * glm::normalize(s.at(1, x, -x) - s.eye));
        expected.push_back(share > 1 ? level : level + 1);
      }
  const std::vector<Lists> found = cull(picture(), places);
  for (size_t i = 0; i < places.size(); ++i) {
    ASSERT_FALSE(found[i].empty()) << "agent " << i;
    EXPECT_EQ(found[i].front(), expected[i]) << "agent " << i;
    EXPECT_TRUE(found[i].size() == 1 || found[i][1] > 4) << "agent " << i;
    // The near cascade draws who is small in the picture more coarsely.
    EXPECT_EQ(std::ranges::count(found[i], 5), expected[i] < 2) << "agent " << i;
    EXPECT_EQ(std::ranges::count(found[i], 6), expected[i] >= 2) << "agent " << i;
  }
}

// Where there are splats, who is small is on their list in place of a level's, and who is smaller still casts
// no shadow of triangles. There are as many groups as hold the list.
TEST_P(CullTest, theRadiusInPixelsChoosesSplats) {
  const Sight s(kView, kWidth, kHeight);
  const double onePixel = double(kRadius) * kHeight / (2 * s.tanY);
  std::vector<glm::dvec3> places;
  for (const double pixels : {25 * 1.005, 25 * 0.995, 12 * 1.005, 12 * 0.995})
    places.push_back(s.eye + onePixel / pixels * s.forward);
  const std::vector<Lists> found = cull(picture(), places, true), without = cull(picture(), places);
  for (size_t i = 0; i < places.size(); ++i) {
    EXPECT_EQ(std::ranges::count(found[i], 9), i > 0) << "agent " << i;
    EXPECT_EQ(std::ranges::any_of(found[i], [](int list) { return list < 5; }), i == 0) << "agent " << i;
    EXPECT_EQ(std::ranges::any_of(found[i], isShadow), i < 3) << "agent " << i;
    EXPECT_EQ(std::ranges::count(without[i], 9), 0) << "agent " << i;
    EXPECT_TRUE(std::ranges::any_of(without[i], isShadow)) << "agent " << i;
  }
  for (const uint32_t many : {1u, 128u, 129u, 1000u}) {
    cull(picture(), std::vector(many, places[3]), true);
    EXPECT_EQ(groups_, (many + 127) / 128) << many;
  }
}

// Sixteen steps lead to splats, over a tenth of the radius at which they begin, and likewise to their
// shadows.
TEST_P(CullTest, theRadiusInPixelsTellsHowFarAnAgentHasFaded) {
  const Sight s(kView, kWidth, kHeight);
  const double onePixel = double(kRadius) * kHeight / (2 * s.tanY);
  for (const double limit : {25.0, 12.0}) {
    std::vector<glm::dvec3> places{s.eye + onePixel / (1.005 * limit) * s.forward};
    for (int step = 0; step <= 16; ++step)
      places.push_back(s.eye + onePixel / (limit * (1 - 0.1 * (step + 0.5) / 16)) * s.forward);
    const std::vector<Lists> found = cull(picture(), places, true);
    for (size_t i = 0; i < places.size(); ++i) {
      const bool fades = i > 0 && i < 17;
      const auto isFading = [&](int list) { return limit == 25 ? list == 10 : list == 11 || list == 12; };
      EXPECT_EQ(std::ranges::any_of(found[i], isFading), fades) << "place " << i;
      EXPECT_EQ(std::ranges::count(found[i], shared::SPLATS), i > 0 || limit == 12) << "place " << i;
      EXPECT_EQ(steps_[i].empty(), !fades) << "place " << i;
      for (const uint32_t step : steps_[i]) EXPECT_EQ(step, i - 1) << "place " << i;
      // Its shadow goes over later than itself.
      EXPECT_EQ(std::ranges::any_of(found[i], isShadow), limit == 25 || i == 0) << "place " << i;
    }
  }
}

// An agent that is drawn in twice the detail is on the lists of one that is twice as large, and casts as it
// does.
TEST_P(CullTest, detailMovesEveryThreshold) {
  const Sight s(kView, kWidth, kHeight);
  const double onePixel = double(kRadius) * kHeight / (2 * s.tanY);
  for (const double threshold : {150.0, 75.0, 40.0, 25.0, 12.0, 10.0})
    for (const double share : {1.005, 0.995}) {
      const auto seen = [&](double pixels, bool splats, float detail) {
        Lists lists = cull(picture(), {s.eye + onePixel / pixels * s.forward}, splats, detail).front();
        // Which cascades hold it depends on where it is.
        const auto inCascade = [](int list) {
          return isShadow(list) || list == shared::NEAR_FADING || list == shared::FAR_FADING;
        };
        const bool casts = std::erase_if(lists, inCascade) > 0;
        if (casts) lists.push_back(-1);
        return lists;
      };
      for (const bool splats : {false, true}) {
        EXPECT_EQ(seen(threshold * share / 2, splats, 2), seen(threshold * share, splats, 1))
            << threshold * share;
        EXPECT_EQ(seen(threshold * share * 2, splats, 0.5f), seen(threshold * share, splats, 1))
            << threshold * share;
      }
    }
}

// Splats are of who lies well ahead of the eye, four radii at least and 3 km at most, however small the
// picture.
TEST_P(CullTest, theWayAheadBoundsSplats) {
  shared::Picture p{};
  for (glm::vec4& plane : p.planes) plane = {0, 0, 0, 1e6f};
  p.tile = {0, 0, 1e6f, 0};
  p.eye = {0, 0, 0, 1};  // one pixel a radian: all are less than a pixel large
  p.forward = {0, 0, 1, 1e6f};
  p.shadow = {1, 1, 0, 1024};
  const std::vector<glm::dvec3> places{{0, 0, -10},
                                       {0, 0, 3.99 * double(kRadius)},
                                       {50, 0, 3.99 * double(kRadius)},
                                       {50, 0, 4.01 * double(kRadius)},
                                       {0, 0, 2999},
                                       {0, 0, 3001}};
  const std::vector<Lists> found = cull(p, places, true);
  for (size_t i = 0; i < places.size(); ++i) {
    EXPECT_EQ(std::ranges::count(found[i], 9), i == 3 || i == 4) << "agent " << i;
    EXPECT_EQ(std::ranges::count_if(found[i], [](int list) { return list < 5; }), i != 3 && i != 4)
        << "agent " << i;
  }
}

// Who is not in the picture but casts a shadow into it has no splats, so its shadow is triangles.
TEST_P(CullTest, whoIsOutsideCastsTriangles) {
  const Sight s(kView, kWidth, kHeight);
  const glm::dvec3 outward = glm::normalize(s.right - s.tanX * s.forward);
  const double away = double(kRadius) * kHeight / (2 * s.tanY * 9);  // nine pixels
  std::vector<glm::dvec3> places;
  for (const double radii : {-2.0, 2.0})
    places.push_back(s.at(away, 1, 0) + radii * double(kRadius) * outward);
  const std::vector<Lists> found = cull(picture(), places, true);
  EXPECT_EQ(found[0], Lists{9});
  EXPECT_TRUE(std::ranges::any_of(found[1], isShadow));
  EXPECT_TRUE(std::ranges::all_of(found[1], isShadow));
}

// Whoever or whose shadow is drawn is interpolated where that is asked for, and nobody else.
TEST_P(CullTest, whoIsOnAListIsInterpolated) {
  const Sight s(kView, kWidth, kHeight);
  std::mt19937 random(6);
  std::uniform_real_distribution<double> any(-1.3, 1.3);
  std::vector<glm::dvec3> places;
  for (int i = 0; i < 1000; ++i) {
    const double away = 110 * (1 + any(random));
    places.push_back(s.at(away, any(random), any(random)));
  }
  const std::vector<Lists> without = cull(picture(), places, true);
  const std::vector<Lists> with = cull(picture(), places, true, 1, true);
  size_t shown = 0, shadowsAlone = 0;
  for (size_t i = 0; i < places.size(); ++i) {
    Lists expected = without[i];
    if (!expected.empty()) expected.push_back(shared::SHOWN);
    EXPECT_EQ(with[i], expected) << "agent " << i;
    shown += !without[i].empty();
    shadowsAlone += !without[i].empty() && std::ranges::all_of(without[i], isShadow);
  }
  EXPECT_EQ(shownGroups_, (shown + 127) / 128);
  EXPECT_GT(shown, 128u);
  EXPECT_GT(places.size() - shown, 128u);
  EXPECT_GT(shadowsAlone, 5u);
}

// Those near enough have contacts.
TEST_P(CullTest, theRadiusInPixelsChoosesContacts) {
  const Sight s(kView, kWidth, kHeight);
  const double onePixel = double(kRadius) * kHeight / (2 * s.tanY);
  std::vector<glm::dvec3> places;
  for (const double share : {1.005, 0.995}) {
    places.push_back(s.eye + onePixel / (kContactThreshold * share) * s.forward);
    places.push_back(s.eye - onePixel / (kContactThreshold * share) * s.forward);
  }
  const std::vector<Lists> found = cull(picture(), places);
  for (size_t i = 0; i < places.size(); ++i)
    EXPECT_EQ(std::ranges::count(found[i], 8), i == 0) << "agent " << i;
}

// Squares of 20 m and 90 m seen from straight above: who touches a square is on its list.
TEST_P(CullTest, cascadesListWhoTouchesThem) {
  shared::Picture p{};
  for (glm::vec4& plane : p.planes) plane = {0, 0, 0, 1e6f};
  p.tile = {0, 0, 1e6f, 0};
  p.eye = {0, 0, 0, 1};
  p.forward = {0, 0, 1, 1e6f};
  p.shadow = {20.0f / 1024, 90.0f / 1024, 0, 1024};
  const glm::dvec2 centres[2] = {{3, -4}, {-12, 8}};
  const double halves[2] = {10, 45};
  for (int i = 0; i < 2; ++i) {
    const glm::vec2 c = centres[i], h(float(halves[i]));
    p.clipFromPicture[1 + i] = glm::mat4(0);
    p.clipFromPicture[1 + i][0][0] = 1 / h.x;
    p.clipFromPicture[1 + i][2][1] = 1 / h.y;
    p.clipFromPicture[1 + i][3] = {-c.x / h.x, -c.y / h.y, 0.5f, 1};
  }
  std::vector<glm::dvec3> places;
  std::vector<Lists> expected;
  const auto touches = [&](int cascade, const glm::dvec3& at) {
    const glm::dvec2 d = glm::abs(glm::dvec2(at.x, at.z) - centres[cascade]);
    return std::max(d.x, d.y) < halves[cascade] + double(kRadius);
  };
  for (int cascade = 0; cascade < 2; ++cascade)
    for (const double past : {0.99, 1.01})
      for (const glm::dvec2 side : {glm::dvec2(1, 0), {-1, 0.3}, {0.4, 1}, {0, -1}, {1, -1}}) {
        const glm::dvec2 at = centres[cascade] + side * (halves[cascade] + past * double(kRadius));
        places.push_back({at.x, 1, at.y});
        Lists lists;
        for (int i = 0; i < 2; ++i)
          if (touches(i, places.back())) lists.push_back(6 + i);
        expected.push_back(lists);
      }
  // 11 texels of the far cascade within 0.98 of the near one's half side the far one is not looked up.
  const double alone = 9.8 - 11 * 90.0 / 1024 - double(kRadius);
  for (const double past : {-0.05, 0.05}) {
    places.push_back({centres[0].x + alone + past, 1, centres[0].y});
    expected.push_back(past < 0 ? Lists{6} : Lists{6, 7});
  }
  const std::vector<Lists> found = cull(p, places);
  for (size_t i = 0; i < places.size(); ++i) {
    Lists shadows;
    std::ranges::copy_if(found[i], std::back_inserter(shadows), isShadow);
    EXPECT_EQ(shadows, expected[i]) << "agent " << i;
  }
}

// More agents than a work group, and no multiple of one: each is drawn once at the level of its distance, or
// not at all. Those within 2 cm of a bound are left out, where float32 may fall on either side.
TEST_P(CullTest, everyAgentInSightIsDrawnOnce) {
  const Sight s(kView, kWidth, kHeight);
  const double onePixel = double(kRadius) * kHeight / (2 * s.tanY);
  const auto depthInside = [&](const glm::dvec3& place) {
    const glm::dvec3 to = place - s.eye;
    const double ahead = glm::dot(to, s.forward);
    const double x = (s.tanX * ahead - std::abs(glm::dot(to, s.right))) / std::hypot(1, s.tanX);
    const double y = (s.tanY * ahead - std::abs(glm::dot(to, s.up))) / std::hypot(1, s.tanY);
    return std::min({x, y, kEnd - glm::length(to)});
  };
  std::mt19937 random(7);
  std::uniform_real_distribution<double> across(-1.6, 1.6), away(0.5, 240);
  std::vector<glm::dvec3> places;
  std::vector<int> expected;
  while (places.size() < 1001) {
    const double depth = away(random) * (places.size() % 3 == 0 ? 0.1 : 1);
    const glm::dvec3 place = s.at(depth, across(random), across(random));
    const double inside = depthInside(place) + double(kRadius), distance = glm::distance(place, s.eye);
    std::array<double, 4> bounds{};
    std::ranges::transform(kThresholds, bounds.begin(), [&](double pixels) { return onePixel / pixels; });
    if (std::abs(inside) < 0.02 ||
        std::any_of(bounds.begin(), bounds.end(), [&](double b) { return std::abs(distance - b) < 0.02; }))
      continue;
    places.push_back(place);
    expected.push_back(inside < 0 ? -1 : int(std::count_if(bounds.begin(), bounds.end(), [&](double b) {
      return distance > b;
    })));
  }
  const std::vector<Lists> found = cull(picture(), places);
  std::array<int, 6> counts{};
  for (size_t i = 0; i < places.size(); ++i) {
    const auto drawn = std::count_if(found[i].begin(), found[i].end(), [](int list) { return list < 5; });
    ASSERT_EQ(drawn, expected[i] < 0 ? 0 : 1) << "agent " << i;
    if (drawn > 0) {
      ASSERT_EQ(found[i].front(), expected[i]) << "agent " << i;
    }
    ++counts[size_t(expected[i] + 1)];
  }
  for (const int count : counts) EXPECT_GT(count, 20);
}

}  // namespace
}  // namespace skitter::render
