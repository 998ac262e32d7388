#include <fmt/format.h>

#include "experiments/sections/projection.h"
#include "experiments/sections/sections.h"

namespace skitter::experiments {
namespace {

constexpr double below = 0.01;  // leg lengths under the ground from which a foot is drawn as sunk

std::string drawing(const FootArcs& arcs) {
  const std::string title = fmt::format("{}: feet over two cycles", nameOf(arcs.controller));
  Svg svg(930, 300, title);
  svg.text({12, 20}, title, Svg::Anchor::start, 13);
  if (arcs.ticks.empty()) return svg.str();
  // From the left of the agent, so that it walks to the right... seen from its right side.
  const glm::dvec2 heading = arcs.ticks.front().heading;
  Projection project(glm::dvec2(heading.y, -heading.x), 0.28);
  const auto at = [&](size_t t, size_t l, bool ground) {
    glm::dvec3 p = arcs.ticks[t].legs[l].foot;
    if (ground) p.y = arcs.ground[t][l];
    return p;
  };
  for (size_t t = 0; t < arcs.ticks.size(); ++t) {
    project.include(arcs.ticks[t].position);
    for (size_t l = 0; l < arcs.legs.size(); ++l)
      project.include(at(t, l, false)), project.include(at(t, l, true));
  }
  project.fit({30, 36}, {870, 225});

  std::vector<glm::dvec2> body;
  for (const AgentState& tick : arcs.ticks) body.push_back(project(tick.position));
  svg.polyline(body, colour::faint, 1, "2 3");
  for (size_t l = 0; l < arcs.legs.size(); ++l) {
    std::vector<glm::dvec2> ground, foot;
    for (size_t t = 0; t < arcs.ticks.size(); ++t) {
      ground.push_back(project(at(t, l, true)));
      foot.push_back(project(at(t, l, false)));
    }
    svg.polyline(ground, colour::ground, 1);
    svg.polyline(foot, seriesColour(l / 2), 1.8);
    for (size_t t = 0; t < arcs.ticks.size(); ++t) {
      const bool sunk = arcs.ground[t][l] - arcs.ticks[t].legs[l].foot.y > below * arcs.legLength;
      if (sunk)
        svg.disc(foot[t], 2.2, "#c00000");
      else if (arcs.ticks[t].legs[l].stance)
        svg.disc(foot[t], 2, colour::ink);
    }
    svg.text(foot.back() + glm::dvec2(5, 4), arcs.legs[l], Svg::Anchor::start, 10);
  }
  drawScale(
      svg, project, 0.5 * arcs.legLength,
      "0.5 leg lengths    brown: ground below each foot, black dots: stance, red dots: under the ground");
  return svg.str();
}

}  // namespace

void showArcs(const std::vector<FootArcs>& all, Report& report) {
  Page& page = report.page;
  page.section("figures-9-11", "Figures 9 to 11: the arcs of the feet");
  page.paragraph(
      "One agent of each kind on rolling ground at a leg length a second, from its side and a little above, "
      "without "
      "perspective: where its feet are, tick by tick, over two cycles of its first leg, above or in the "
      "ground.");
  const char* numbers[] = {"Figure 9", "Beside figure 9", "Beside figure 9", "Figure 10", "Figure 11"};
  for (size_t i = 0; i < all.size(); ++i) {
    page.drawings(
        {drawing(all[i])},
        fmt::format("{}. {}: feet {:.2f} % of the leg length deep in the ground in the mean (all feet, all "
                    "ticks), planted ones {:.2f} % above it.",
                    numbers[std::min<size_t>(i, 4)], nameOf(all[i].controller), 100 * all[i].depth(),
                    100 * all[i].height()));
  }
  report.raw("figures9-11.csv", tableOf(all).csv());
}

}  // namespace skitter::experiments
