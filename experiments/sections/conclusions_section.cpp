#include "experiments/sections/sections.h"

namespace skitter::experiments {

void showConclusions(const std::vector<Conclusion>& conclusions, Report& report) {
  Page& page = report.page;
  page.section("conclusions", "What holds and what does not");
  page.paragraph(
      "Each verdict is computed from the figures below by the criterion beside it, and from nothing else. It "
      "is "
      "about this machine and this implementation.");
  const Table table = tableOf(conclusions);
  page.table(table);
  report.raw("conclusions.csv", table.csv());
}

void showSetup(const Setup& setup, Report& report) {
  Page& page = report.page;
  page.section("setup", "Set-up");
  if (!setup.warning.empty()) page.warning(setup.warning);
  page.facts(setup.facts);
  page.paragraph(
      "Lengths are shares of the leg length where they have no unit. Times are by the wall clock unless "
      "told: on a "
      "machine that others use too they include waiting for them, so CPU times of all threads stand beside "
      "them "
      "in the raw figures.");
  Table table{{"name", "value"}};
  for (const auto& [name, value] : setup.facts) table.rows.push_back({name, value});
  report.raw("setup.csv", table.csv());
}

}  // namespace skitter::experiments
