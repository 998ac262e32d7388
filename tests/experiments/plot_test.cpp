#include "experiments/page/plot.h"

#include <gtest/gtest.h>

#include <cmath>

namespace skitter::experiments {
namespace {

size_t count(const std::string& text, const std::string& part) {
  size_t found = 0;
  for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

TEST(Plot, HasALineASeriesItsNameAndItsLabels) {
  Plot plot;
  plot.title = "time < memory";
  plot.x = {.label = "agents"};
  plot.y = {.label = "milliseconds"};
  plot.series = {{"first", {{0, 1}, {1, 2}}}, {"second", {{0, 3}, {1, 4}}}};
  const std::string svg = draw(plot);
  for (const char* words : {">first<", ">second<", ">agents<", ">milliseconds<", "time &lt; memory"})
    EXPECT_NE(svg.find(words), std::string::npos) << words;
  EXPECT_EQ(count(svg, "<circle"), 6u);  // a marker a point, and one a name
  EXPECT_TRUE(svg.starts_with("<svg") && svg.ends_with("</svg>\n"));
}

TEST(Plot, SpreadsAreBarsThatTheAxisHolds) {
  Plot plot;
  plot.series = {{"measured", {{0, 2}, {1, 3}}}};
  const std::string without = draw(plot);
  plot.series[0].spreads = {{1, 40}, {2.5, std::nan("")}};
  const std::string with = draw(plot);
  EXPECT_EQ(without.find(">40<"), std::string::npos);
  EXPECT_NE(with.find(">40<"), std::string::npos);
  EXPECT_EQ(count(with, seriesColour(0)), count(without, seriesColour(0)) + 1);
}

TEST(Plot, LeavesOutWhatIsNotFinite) {
  Plot plot;
  plot.y.log = true;
  plot.series = {{"holes", {{0, 1}, {1, std::nan("")}, {2, 0}, {3, HUGE_VAL}, {4, 10}}}};
  const std::string svg = draw(plot);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
  EXPECT_EQ(count(svg, "<circle"), 3u);
}

TEST(Plot, WithoutPointsIsStillAPlot) {
  const std::string svg = draw(Plot{});
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_NE(svg.find("<polyline"), std::string::npos);
}

TEST(Plot, BarsStandOnEachOther) {
  Bars bars;
  bars.places = {"100", "200"};
  bars.parts = {"a", "b"};
  bars.colours = {"#111111", "#eeeeee"};
  bars.shares = {{0.25, 0.75}, {1, 0}};
  EXPECT_EQ(count(draw(bars), "fill=\"#111111\""), 3u);  // two bars and the name's
}

}  // namespace
}  // namespace skitter::experiments
