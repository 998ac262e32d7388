#pragma once

#include <algorithm>
#include <fstream>
#include <string>
#include <vector>

// The tables of docs/stages.md, against which tests hold the stages of each controller.
namespace skitter::test {

// The rows of the table under a heading, with its head, as cells without the spaces and backticks around
// them. None where the page has no such table.
inline std::vector<std::vector<std::string>> rowsUnder(const std::string& heading) {
  std::ifstream page(SKITTER_ROOT "/docs/stages.md");
  std::vector<std::vector<std::string>> rows;
  bool inside = false;
  for (std::string line; std::getline(page, line);) {
    if (line.starts_with("#")) inside = line == heading;
    if (!inside || !line.starts_with("| ")) continue;
    std::vector<std::string>& cells = rows.emplace_back();
    for (size_t from = 1, to; (to = line.find('|', from)) != line.npos; from = to + 1) {
      const size_t first = line.find_first_not_of(" `", from), last = line.find_last_not_of(" `", to - 1);
      cells.push_back(first < to ? line.substr(first, last + 1 - first) : "");
    }
  }
  return rows;
}

// The stages that any of these controllers has, in the order of a tick, with wake.
inline std::vector<std::string> stagesOnThePage(const std::vector<std::string>& controllers) {
  const auto rows = rowsUnder("## Controllers");
  const auto has = [&](const std::string& controller, const std::string& stage) {
    for (const std::vector<std::string>& row : rows)
      for (size_t column = 0; row.front() == controller; ++column) {
        if (column == row.size()) return true;  // a stage without a column is one of every controller
        if (rows.front()[column] == stage) return !row[column].empty();
      }
    return false;
  };
  std::vector<std::string> stages;
  for (const std::vector<std::string>& row : rowsUnder("## The order of the stages")) {
    const std::string& stage = row.front();
    if (stage == "stage" || stage == "cull, draw") continue;
    if (std::ranges::any_of(controllers, [&](const auto& controller) { return has(controller, stage); }))
      stages.push_back(stage);
  }
  return stages;
}

// Those that are replayed: wake decides nothing; avoid, adapt and react are only of herds that ask for them.
inline std::vector<std::string> replayedOnThePage(const std::vector<std::string>& controllers,
                                                  bool avoids = false) {
  std::vector<std::string> stages = stagesOnThePage(controllers);
  std::erase(stages, "wake");
  std::erase(stages, "adapt");
  std::erase(stages, "react");
  if (!avoids) std::erase(stages, "avoid");
  return stages;
}

}  // namespace skitter::test
