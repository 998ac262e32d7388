#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <vector>

#include "app/fields/colours.h"
#include "app/fields/field_map.h"
#include "app/fields/stroke_font.h"
#include "process.h"
#include "read_png.h"

namespace skitter::test {
namespace {

using Fields = AppTest;
using app::Drawing;

constexpr const char* walledScene = R"({
  "terrain": {"kind": "noise", "columns": 65, "rows": 65, "amplitude": 1},
  "obstacles": [{"capsule": {"from": [-20, 0], "to": [6, 0], "radius": 0.3}}, {"disc": {"centre": [8, 8], "radius": 2}}],
  "herds": [
    {"agents": 9, "ways": {}, "spawn": {"kind": "grid", "centre": [0, -8], "spacing": 1},
     "goal": {"kind": "point", "target": [0, 7], "speed": 2}},
    {"agents": 4, "ways": {}, "spawn": {"kind": "grid", "centre": [4, -8], "spacing": 1},
     "goal": {"kind": "point", "target": [8, 8]}},
    {"agents": 3, "ways": {}, "sizes": [0.5, 2]},
    {"agents": 5}
  ]})";

TEST_F(Fields, AreDrawnForEachKindAndGoal) {
  write("walled.json", walledScene);
  const Result result = skitter({"fields", file("walled.json"), "--out", file("out")});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  // Herds 0 and 1 are of one kind, and herd 2 is of two; who crosses has no field.
  EXPECT_EQ(files(), (std::vector<std::string>{"out/.skitter-files", "out/fields.json", "out/herd0_cost.png",
                                               "out/herd0_goal0.png", "out/herd0_goal1.png",
                                               "out/herd2_size0_cost.png", "out/herd2_size1_cost.png",
                                               "out/index.html", "walled.json"}));
  const nlohmann::json fields = json("out/fields.json");
  EXPECT_EQ(fields.at("manifest").at("version"), "0.1.0");
  const nlohmann::json& grid = fields.at("grids").at(0);
  EXPECT_EQ(grid.at("herds"), (std::vector<int>{0, 1}));
  EXPECT_EQ(fields.at("grids").size(), 3u);
  EXPECT_GT(grid.at("passable"), 0.5);
  EXPECT_LT(grid.at("passable"), 1);
  const nlohmann::json &open = grid.at("goals").at(0), &walled = grid.at("goals").at(1);
  EXPECT_EQ(open.at("target"), (std::vector<double>{0, 7}));
  EXPECT_EQ(open.at("stop"), open.at("target"));
  EXPECT_EQ(open.at("agents"), 9);
  EXPECT_EQ(open.at("cannotReach"), 0);
  EXPECT_EQ(walled.at("agents"), 4);
  EXPECT_EQ(walled.at("cannotReach"), 4) << "the goal is in a disc";
  EXPECT_NE(walled.at("stop"), walled.at("target"));
  // Round the wall it is longer than straight.
  EXPECT_GT(open.at("timeMost"), 20);

  // 32 m are 1,040 pixels, and the map begins at (36, 92).
  const std::array<int, 3> goal = Png(file("out/herd0_goal0.png")).at(36 + 520, 92 + 747);
  EXPECT_GT(goal[0], 200);
  EXPECT_LT(goal[1], 80);
  // The legend, right of the map, has the crossed mark of a stop where that is not the goal.
  const auto redInLegend = [&](const char* picture) {
    const Png png(file(picture));
    int count = 0;
    for (size_t y = 92; y < png.image.height; ++y)
      for (size_t x = 1080; x < png.image.width; ++x) {
        const std::array<int, 3> c = png.at(x, y);
        count += c[0] > c[1] + 90 && c[0] > c[2] + 90;
      }
    return count;
  };
  EXPECT_GT(redInLegend("out/herd0_goal0.png"), 100);
  EXPECT_GT(redInLegend("out/herd0_goal1.png"), redInLegend("out/herd0_goal0.png") + 40);
  const std::string page = [&] {
    std::ifstream in(file("out/index.html"));
    std::stringstream all;
    all << in.rdbuf();
    return all.str();
  }();
  for (const char* part : {"herd0_cost.png", "herd0_goal1.png", "herd2_size1_cost.png", "cannot reach it"})
    EXPECT_NE(page.find(part), std::string::npos) << part;
}

// Twenty who carry food over 7 m of level ground, and a herd that comes after 2 s.
constexpr const char* foragingScene = R"({
  "terrain": {"kind": "noise", "columns": 65, "rows": 65, "amplitude": 0},
  "obstacles": [{"disc": {"centre": [8, 8], "radius": 2}}],
  "herds": [
    {"agents": 20, "spawn": {"kind": "grid", "centre": [0, -4], "spacing": 0.6}, "goal": {"speed": 3},
     "forage": {"nest": {"centre": [0, -4], "radius": 1.5}, "food": [{"centre": [0, 3], "radius": 3}],
                "cell": 1, "rest": 0.5}}
  ],
  "events": [{"at": 2, "addHerd": {"agents": 3, "ways": {}, "spawn": {"kind": "grid", "centre": [-8, -8]},
                                   "goal": {"kind": "point", "target": [-8, 8]}}}]})";

TEST_F(Fields, HavePheromoneAtATime) {
  write("foraging.json", foragingScene);
  const auto drawnAt = [&](const char* seconds) {
    const Result result =
        skitter({"fields", file("foraging.json"), "--out", file("out"), "--at", seconds, "--quiet"});
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(result.err, "");
    return json("out/fields.json");
  };
  const nlohmann::json begun = drawnAt("0");
  EXPECT_EQ(files(), (std::vector<std::string>{"foraging.json", "out/.skitter-files", "out/fields.json",
                                               "out/herd0_trail.png", "out/index.html"}));
  EXPECT_EQ(begun.at("tick"), 0);
  EXPECT_TRUE(begun.at("grids").empty());
  ASSERT_EQ(begun.at("trails").size(), 1u);
  EXPECT_EQ(begun.at("trails")[0].at("unitsMost"), 0);
  EXPECT_EQ(begun.at("trails")[0].at("agents"), 20);

  const nlohmann::json later = drawnAt("12");
  EXPECT_EQ(files(), (std::vector<std::string>{"foraging.json", "out/.skitter-files", "out/fields.json",
                                               "out/herd0_trail.png", "out/herd1_cost.png",
                                               "out/herd1_goal0.png", "out/index.html"}));
  EXPECT_EQ(later.at("tick"), 720);
  EXPECT_NEAR(later.at("seconds").get<double>(), 12, 1e-9);
  EXPECT_EQ(later.at("grids").at(0).at("goals").at(0).at("agents"), 3);
  EXPECT_TRUE(later.at("grids")[0].at("goals")[0].at("scouts").is_null()) << "nobody asked for them";
  const nlohmann::json& trail = later.at("trails").at(0);
  EXPECT_EQ(trail.at("herds"), std::vector<int>{0});
  EXPECT_GT(trail.at("taken").at(0), 0);
  EXPECT_GT(trail.at("marked"), 0);
  EXPECT_LT(trail.at("marked"), 0.5);
  // A load's worth in a cell, less what has evaporated.
  EXPECT_GT(trail.at("unitsMost"), 9);
  EXPECT_GE(trail.at("unitsSum"), trail.at("unitsMost"));
  // 32 m are 1,040 pixels, and the map begins at (36, 92): the nest's ring at (1.5, -4).
  const std::array<int, 3> nest = Png(file("out/herd0_trail.png")).at(36 + 569, 92 + 390);
  EXPECT_GT(nest[0], 200);
  EXPECT_LT(nest[1], 100);
}

TEST_F(Fields, HaveTheTrailsOfScouts) {
  write("walled.json", walledScene);
  const Result result = skitter({"fields", file("walled.json"), "--out", file("out"), "--scouts", "20"});
  ASSERT_EQ(result.code, 0) << result.err;
  const nlohmann::json goals = json("out/fields.json").at("grids").at(0).at("goals");
  const nlohmann::json &open = goals.at(0).at("scouts"), &walled = goals.at(1).at("scouts");
  EXPECT_EQ(open.at("iterations"), 20);
  EXPECT_EQ(open.at("picture"), "herd0_goal0_scouts.png");
  // From (-1, -9) round the end of the wall at (6, 0), 0.3 m wide, to (0, 7): not straight, and not much
  // longer than the shortest way, of 11.4 and 9.2 m and what the slopes add.
  EXPECT_GT(open.at("length"), 11.4 + 9.2);
  EXPECT_LT(open.at("length"), 1.8 * (11.4 + 9.2));
  EXPECT_GE(open.at("iteration"), 1);
  EXPECT_LE(open.at("iteration"), 20);
  EXPECT_TRUE(std::filesystem::exists(file("out/herd0_goal0_scouts.png")));
  // They go to the stop beside the disc.
  EXPECT_EQ(walled.at("picture"), "herd0_goal1_scouts.png");
}

TEST_F(Fields, RefuseWhatHasNone) {
  expectRefusal(skitter({"fields", "--out", file("out")}), 2, {"no herd has ways", "\"ways\": {}"});
  expectRefusal(skitter({"fields", "--out", file("out"), "--at", "-1"}), 2, {"--at", "-1"});
  expectRefusal(skitter({"fields", "--out", file("out"), "--scouts", "0"}), 2, {"--scouts", "0"});
  write("walled.json", walledScene);
  std::filesystem::create_directory(file("out"));
  write("out/mine.txt", "the user's");
  expectRefusal(skitter({"fields", file("walled.json"), "--out", file("out")}), 2, {"--out", "--force"});
  EXPECT_EQ(files(), (std::vector<std::string>{"out/mine.txt", "walled.json"}));
}

TEST(FieldColours, GoFromLightToDark) {
  const auto lightness = [](const glm::vec3& c) { return glm::dot(c, {0.30f, 0.59f, 0.11f}); };
  for (const auto colourOf : {app::costColour, app::timeColour, app::trailColour})
    for (int i = 0; i < 100; ++i) {
      const glm::vec3 lighter = colourOf(0.01f * static_cast<float>(i)),
                      darker = colourOf(0.01f * static_cast<float>(i + 1));
      EXPECT_GT(lightness(lighter), lightness(darker)) << i;
    }
}

TEST(FieldText, HasEveryCharacter) {
  for (char c = '!'; c <= '~'; ++c) {
    const app::Glyph glyph = app::glyphOf(c);
    EXPECT_FALSE(glyph.strokes.front().empty()) << c;
    for (const auto& stroke : glyph.strokes)
      for (const glm::vec2& point : stroke) {
        EXPECT_GE(point.x, 0) << c;
        EXPECT_LE(point.x, 4) << c;
        EXPECT_GE(point.y, -2) << c;
        EXPECT_LE(point.y, app::glyphHeight) << c;
      }
  }
  EXPECT_TRUE(app::glyphOf(' ').strokes.front().empty());
  EXPECT_GT(Drawing::textWidth(10, "wide"), Drawing::textWidth(10, "w"));
}

TEST(FieldMap, StepsAreRound) {
  for (const auto& [value, step] :
       {std::pair(1.0, 1.0), {1.9, 1.0}, {2.0, 2.0}, {4.99, 2.0}, {73.0, 50.0}, {0.03, 0.02}})
    EXPECT_NEAR(app::niceBelow(value), step, 1e-12) << value;
}

// Shapes reach as far as they say, and no further than they may.
TEST(FieldMap, ShapesAreConfined) {
  const glm::vec3 white(1), black(0);
  Drawing drawing(40, 30, white);
  drawing.confine(10, 5, 20, 20);
  drawing.disc({20, 15}, 8, black);
  EXPECT_EQ(drawing.at(20, 15), black);
  EXPECT_EQ(drawing.at(20, 8), black);
  EXPECT_EQ(drawing.at(20, 6), white);
  drawing.line({0, 10}, {40, 10}, 3, black);
  EXPECT_EQ(drawing.at(9, 10), white);
  EXPECT_EQ(drawing.at(10, 10), black);
  EXPECT_EQ(drawing.at(29, 10), black);
  EXPECT_EQ(drawing.at(30, 10), white);
  EXPECT_EQ(drawing.rgba().size(), 40u * 30 * 4);
}

// The grid has 20 x 20 passable cells.
std::vector<glm::vec4> aroundOf(std::span<const float> times) {
  std::vector<glm::vec4> around;
  for (size_t at = 0; at < times.size(); ++at) {
    const size_t right = at % 20 < 19 ? 1 : 0, above = at < 380 ? 20 : 0;
    around.emplace_back(times[at], times[at + right], times[at + above], times[at + above + right]);
  }
  return around;
}

// Times that fall toward +x lead straight there.
TEST(FieldMap, AWayGoesDownTheTimes) {
  const Heightfield flat{
      .name = "flat", .columns = 2, .rows = 2, .spacingX = 20, .spacingZ = 20, .heights = {0, 0, 0, 0}};
  CostGrid grid{
      .columns = 20, .rows = 20, .cell = 1, .origin = {-10, -10}, .cost = std::vector<float>(400, 1)};
  std::vector<float> times(400);
  for (size_t i = 0; i < times.size(); ++i) times[i] = 30 - static_cast<float>(i % 20);
  const app::MapGround ground{flat, {}, grid, "", ""};
  const std::vector<glm::vec4> around = aroundOf(times);
  const app::MapGoal goal{{8, 2}, {8, 2}, around, std::vector<bool>(400, true), {}};
  const std::vector<glm::vec2> way = app::wayFrom(ground, goal, {-5, 2});
  EXPECT_EQ(way.back(), goal.stop);
  for (const glm::vec2& place : way) EXPECT_NEAR(place.y, 2, 1e-4);
  // Elsewhere it ends where times no longer fall, at the edge.
  EXPECT_NE(app::wayFrom(ground, goal, {-5, -5}).back(), goal.stop);
}

// Times are those of the middles of cells: between two rows of them that are equal, nothing leads aside.
TEST(FieldMap, TimesAreOfTheMiddlesOfCells) {
  const Heightfield flat{
      .name = "flat", .columns = 2, .rows = 2, .spacingX = 20, .spacingZ = 20, .heights = {0, 0, 0, 0}};
  CostGrid grid{
      .columns = 20, .rows = 20, .cell = 1, .origin = {-10, -10}, .cost = std::vector<float>(400, 1)};
  const glm::vec2 corner(0);
  std::vector<float> times;
  for (int cell = 0; cell < 400; ++cell)
    times.push_back(glm::distance(grid.origin + glm::vec2(cell % 20, cell / 20) + 0.5f, corner));
  const app::MapGround ground{flat, {}, grid, "", ""};
  const std::vector<glm::vec4> around = aroundOf(times);
  const app::MapGoal goal{corner, corner, around, std::vector<bool>(400, true), {}};
  const std::vector<glm::vec2> way = app::wayFrom(ground, goal, {-7.5f, 0});
  EXPECT_EQ(way.back(), corner);
  for (const glm::vec2& place : way) EXPECT_NEAR(place.y, 0, 1e-3);
}

// A cell of 20 is 52 pixels wide, and the map begins at (36, 92).
TEST(FieldMap, TrailsAreDarkWhereMostIs) {
  const Heightfield flat{
      .name = "flat", .columns = 2, .rows = 2, .spacingX = 20, .spacingZ = 20, .heights = {0, 0, 0, 0}};
  CostGrid grid{
      .columns = 20, .rows = 20, .cell = 1, .origin = {-10, -10}, .cost = std::vector<float>(400, 1)};
  grid.cost[3] = INFINITY;
  std::vector<float> units(400, 0);
  units[7 * 20 + 12] = 80;
  units[9 * 20 + 2] = 20;
  const app::MapGround ground{flat, {}, grid, "", ""};
  const app::MapTrail trail{.what = "units", .values = units, .nests = {{.centre = {0, 0}, .radius = 1}}};
  const Drawing drawing = app::drawTrail(ground, trail);
  const auto expectAt = [&](uint32_t column, uint32_t row, const glm::vec3& colour) {
    const glm::vec3 found = drawing.at(36 + 52 * column + 26, 92 + 52 * row + 26);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(found[i], colour[i], 1e-5) << column << ", " << row;
  };
  expectAt(12, 7, app::trailColour(1));
  expectAt(2, 9, app::trailColour(0.5f));  // the root of a quarter
  expectAt(15, 15, app::trailColour(0));
  EXPECT_NE(drawing.at(36 + 52 * 3 + 26, 92 + 26), drawing.at(36 + 52 * 4 + 26, 92 + 26));
  // 1 m right of the middle.
  EXPECT_GT(drawing.at(36 + 520 + 52, 92 + 520).x, 0.8f);
  EXPECT_LT(drawing.at(36 + 520 + 52, 92 + 520).y, 0.3f);
  const app::TrailFigures figures = app::figuresOf(ground, trail);
  EXPECT_EQ(figures.most, 80);
  EXPECT_EQ(figures.sum, 100);
  EXPECT_NEAR(figures.marked, 2.0 / 399, 1e-12);
}

// Arrows are 34 pixels apart on a map that begins at (36, 92). Their heads are where times fall.
TEST(FieldMap, ArrowsPointDownTheTimes) {
  const Heightfield flat{
      .name = "flat", .columns = 2, .rows = 2, .spacingX = 20, .spacingZ = 20, .heights = {0, 0, 0, 0}};
  CostGrid grid{
      .columns = 20, .rows = 20, .cell = 1, .origin = {-10, -10}, .cost = std::vector<float>(400, 1)};
  for (const float fall : {-1.0f, 1.0f}) {
    std::vector<float> times(400);
    for (size_t i = 0; i < times.size(); ++i) times[i] = 30 - fall * static_cast<float>(i % 20);
    const app::MapGround ground{flat, {}, grid, "", ""};
    const std::vector<glm::vec4> around = aroundOf(times);
    const app::MapGoal goal{{9 * fall, 9}, {9 * fall, 9}, around, std::vector<bool>(400, true), {}};
    const Drawing drawing = app::drawTimes(ground, goal);
    const auto brightBeside = [&](uint32_t x, uint32_t y) {
      int count = 0;
      for (uint32_t off = 2; off <= 4; ++off)
        for (const uint32_t row : {y - off, y + off}) {
          const glm::vec3 colour = drawing.at(x, row);
          count += std::min({colour.x, colour.y, colour.z}) > 0.8f;
        }
      return count;
    };
    int left = 0, right = 0;
    for (uint32_t k = 2; k < 10; ++k)
      for (uint32_t away = 2; away <= 6; ++away) {
        left += brightBeside(36 + 17 + 34 * k - away, 92 + 17 + 34 * 4);
        right += brightBeside(36 + 17 + 34 * k + away, 92 + 17 + 34 * 4);
      }
    EXPECT_GT((right - left) * fall, 16) << left << " and " << right;
  }
}

}  // namespace
}  // namespace skitter::test
