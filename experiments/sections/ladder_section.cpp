#include <fmt/format.h>

#include "experiments/sections/projection.h"
#include "experiments/sections/sections.h"

namespace skitter::experiments {
namespace {

std::string drawing(const Ladder& ladder, const char* title, double rise) {
  glm::dvec2 along(ladder.target.x - ladder.root.x, ladder.target.z - ladder.root.z);
  along = glm::length(along) > 1e-9 ? glm::normalize(along) : glm::dvec2(0, 1);
  // Seen from the side, so that the ladder runs to the right.
  Projection project(glm::dvec2(along.y, -along.x), rise);
  for (const auto& row : ladder.ground)
    for (const glm::dvec3& p : row) project.include(p);
  project.include(ladder.root);
  project.include(ladder.target);
  Svg svg(470, 380, title);
  project.fit({20, 40}, {430, 280});
  svg.text({12, 20}, title, Svg::Anchor::start, 13);

  const auto path = [&](const std::vector<glm::dvec3>& points) {
    std::vector<glm::dvec2> made;
    for (const glm::dvec3& p : points) made.push_back(project(p));
    return made;
  };
  for (const auto& row : ladder.ground) svg.polyline(path(row), colour::grid, 1);
  for (size_t i = 0; !ladder.ground.empty() && i < ladder.ground.front().size(); ++i) {
    std::vector<glm::dvec3> column;
    for (const auto& row : ladder.ground) column.push_back(row[i]);
    svg.polyline(path(column), colour::grid, 1);
  }

  size_t at = 0;
  for (int rung = 1; rung <= 4; ++rung) {
    const size_t count = static_cast<size_t>(2 * rung + 1);
    svg.polyline(path({ladder.points.begin() + static_cast<long>(at),
                       ladder.points.begin() + static_cast<long>(at + count)}),
                 colour::ground, 2);
    at += count;
  }
  svg.line(project(ladder.root), project(ladder.target), colour::ink, 1, "5 4");
  for (size_t i = 0; i < ladder.points.size(); ++i) {
    const bool chosen = static_cast<int>(i) == ladder.result.chosen;
    const bool fits = ladder.result.candidates[i].fits;
    svg.disc(project(ladder.points[i]), chosen ? 7 : 4,
             chosen ? colour::red : (fits ? colour::blue : "#ffffff"),
             chosen ? colour::ink : (fits ? colour::blue : colour::faint));
  }
  const glm::dvec2 root = project(ladder.root), target = project(ladder.target);
  const auto cross = [&](const glm::dvec2& centre) {
    svg.line(centre + glm::dvec2(-6, -6), centre + glm::dvec2(6, 6), colour::ink, 2);
    svg.line(centre + glm::dvec2(-6, 6), centre + glm::dvec2(6, -6), colour::ink, 2);
  };
  svg.disc(root, 5, colour::ink);
  cross(target);
  // Names beside the marks would run into each other where these are close.
  const double names = 340;
  svg.disc({22, names}, 5, colour::ink);
  svg.text({33, names + 4}, "leg's root at touchdown");
  cross({190, names});
  svg.text({202, names + 4}, "predicted landing");
  svg.disc({326, names}, 7, colour::red, colour::ink);
  svg.text({339, names + 4}, "chosen");
  drawScale(svg, project, 0.2 * ladder.legLength, "0.2 leg lengths");
  return svg.str();
}

}  // namespace

void showLadder(const Ladder& ladder, Report& report) {
  Page& page = report.page;
  page.section("figure-2", "Figure 2: the ladder of point collection");
  if (!ladder.found) {
    page.paragraph("No leg lifted in the ticks that were looked at.");
    report.raw("figure2.csv", ladder.table().csv());
    return;
  }
  size_t fits = 0;
  for (const reference::Candidate& candidate : ladder.result.candidates) fits += candidate.fits ? 1 : 0;
  page.drawings(
      {drawing(ladder, "from the side and above", 0.45), drawing(ladder, "from above", 1.5)},
      fmt::format(
          "Figure 2. The ladder of {} as it lifts on steep ground: four rungs of 3, 5, 7 and 9 candidates "
          "dropped on the terrain, from the root towards where the leg should land. Blue: fits (reach and "
          "slope), {} of {}; hollow: does not; red: chosen. The device chose the point {:.2g} mm from the "
          "reference's.",
          ladder.leg, fits, ladder.points.size(), 1e3 * ladder.apart));
  page.paragraph(
      "The dissertation takes the point nearest to its target. What ships adds a cost for ground that slopes "
      "away "
      "from the body's up and for legs that would be stretched; point collection, below, times both rules.");
  report.raw("figure2.csv", ladder.table().csv());
}

}  // namespace skitter::experiments
