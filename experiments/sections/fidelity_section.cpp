#include <fmt/format.h>

#include "experiments/sections/sections.h"

namespace skitter::experiments {

void showFidelity(const FidelityStudy& study, const Settings& settings, Report& report) {
  Page& page = report.page;
  page.section("fidelity", "Fidelity on flat, rolling and steep ground");
  page.paragraph(fmt::format(
      "{} agents at a leg length a second for {} ticks. Lengths are shares of the leg length. Seen: from the "
      "places of "
      "the feet at a look every half second; the rest is what the device measures, as docs/stages/measure.md "
      "defines it. Roughness: the ground under the feet of a standing agent, root of the mean square from "
      "the plane "
      "that fits it best, mean over where the agents were. Speed achieved leaves the first second out.",
      settings.fidelityAgents, settings.fidelityTicks));
  Table table{
      {"ground", "roughness, %", "controller", "speed achieved, %", "penetration seen, %", "float seen, %"}};
  for (const FidelityColumn& column : fidelityColumns()) table.head.push_back(column.title);
  for (const FidelityRow& row : study.rows) {
    std::vector<std::string> cells = {row.ground,
                                      figure(100 * row.roughness, 2),
                                      nameOf(row.controller),
                                      figure(100 * row.speed),
                                      figure(100 * row.depthSeen, 2),
                                      figure(100 * row.heightSeen, 2)};
    for (const FidelityColumn& column : fidelityColumns()) {
      const std::optional<double> value = column.value(row.fidelity);
      cells.push_back(value ? figure(column.scale * *value, 2) : "not judged");
    }
    table.rows.push_back(std::move(cells));
  }
  page.table(table);
  for (const std::string& ground : study.grounds) page.paragraph(ground + ".");
  report.raw("fidelity.csv", study.csv().csv());
}

}  // namespace skitter::experiments
