#include <fmt/format.h>

#include "experiments/page/svg.h"
#include "experiments/sections/sections.h"

namespace skitter::experiments {
namespace {

constexpr double side = 310;

glm::dvec2 place(const glm::dvec3& p) { return {30 + 270 * (p.x + 0.05), 250 - 270 * (p.y + 0.12)}; }

void drawChain(Svg& svg, const std::vector<glm::dvec3>& joints, const char* colour, bool faint) {
  std::vector<glm::dvec2> path;
  for (const glm::dvec3& joint : joints) path.push_back(place(joint));
  svg.polyline(path, colour, faint ? 1.5 : 3, faint ? "4 4" : "");
  for (size_t i = 0; i < path.size(); ++i) {
    svg.disc(path[i], faint ? 2.5 : 4.5, faint ? colour : "#ffffff", colour);
    if (!faint) svg.text(path[i] + glm::dvec2(8, -7), fmt::format("p{}", i), Svg::Anchor::start, 12);
  }
}

std::string panel(const FabrikIteration& it, const char* title, const std::vector<glm::dvec3>& joints,
                  const std::vector<glm::dvec3>* earlier, const char* colour) {
  Svg svg(side, 290, title);
  svg.text({12, 20}, title, Svg::Anchor::start, 13);
  const glm::dvec2 base = place({0, 0, 0}), target = place(it.target);
  svg.line(base + glm::dvec2(-14, 8), base + glm::dvec2(14, 8), colour::ink, 2);
  svg.line(target + glm::dvec2(-8, -8), target + glm::dvec2(8, 8), colour::ink, 2);
  svg.line(target + glm::dvec2(-8, 8), target + glm::dvec2(8, -8), colour::ink, 2);
  svg.text(target + glm::dvec2(4, 24), "target", Svg::Anchor::middle, 12);
  if (earlier) drawChain(svg, *earlier, colour::faint, true);
  drawChain(svg, joints, colour, false);
  return svg.str();
}

}  // namespace

void showIteration(const FabrikIteration& it, Report& report) {
  Page& page = report.page;
  page.section("figure-1", "Figure 1: an iteration of FABRIK");
  page.drawings(
      {panel(it, "before", it.before, nullptr, colour::ink),
       panel(it, "backward pass: from the target to the base", it.backward, &it.before, colour::red),
       panel(it, "forward pass: from the base to the tip", it.forward, &it.backward, colour::blue)},
      fmt::format("Figure 1. Joints as the reference computes them, four bones without limits. Dashed: the "
                  "pass before. The iteration takes the tip from {:.1f} % of the chain's length off its "
                  "target to {:.1f} %.",
                  100 * it.errorBefore(), 100 * it.errorAfter()));
  report.raw("figure1.csv", it.table().csv());
}

}  // namespace skitter::experiments
