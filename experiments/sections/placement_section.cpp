#include <fmt/format.h>

#include "experiments/sections/sections.h"
#include "render/png.h"

namespace skitter::experiments {

void showPlacement(const std::vector<PlacementPicture>& pictures, Report& report) {
  Page& page = report.page;
  page.section("figures-12-14", "Figures 12 to 14: feet on uneven ground");
  page.paragraph(
      "The same agent of the same herd on steep ground after the same number of ticks, under each "
      "controller, where "
      "the adaptive one stands the roughest.");
  const char* numbers[] = {"Figure 12", "Beside figure 12", "Beside figure 12", "Figure 13", "Figure 14"};
  Table table{{"controller", "roughness", "deepest", "highest"}};
  for (size_t i = 0; i < pictures.size(); ++i) {
    const PlacementPicture& picture = pictures[i];
    const std::string png =
        render::pngOf(picture.width, picture.height, picture.rgba, render::PngEffort::small);
    page.picture(
        std::as_bytes(std::span(png)),
        fmt::format("a spider on uneven ground, {}", nameOf(picture.controller)),
        fmt::format(
            "{}. {}: the ground under its feet is {:.1f} % of a leg length rough; its deepest foot is "
            "{:.1f} % in the ground, its highest planted one {:.1f} % above it.",
            numbers[std::min<size_t>(i, 4)], nameOf(picture.controller), 100 * picture.roughness,
            100 * picture.penetration, 100 * picture.floating));
    report.files.push_back({fmt::format("placement-{}.png", nameOf(picture.controller)), png});
    table.rows.push_back({nameOf(picture.controller), fmt::format("{:.5f}", picture.roughness),
                          fmt::format("{:.5f}", picture.penetration),
                          fmt::format("{:.5f}", picture.floating)});
  }
  report.raw("figures12-14.csv", table.csv());
}

}  // namespace skitter::experiments
