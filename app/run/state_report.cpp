#include "app/run/state_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "app/common/manifest.h"
#include "app/run/run_note.h"

namespace skitter::app {
namespace {

constexpr size_t mostHerds = 8;  // that people want to see

}  // namespace

void printState(const std::string& file) {
  const State state = loadState(file);
  const RunNote note = RunNote::of(state, file);
  fmt::print("{}\n", file);
  fmt::print("  state   tick {}, {:.6g} s after the start; {} agents, seed {}\n", state.tick,
             static_cast<double>(state.tick) * note.dt, state.scene.agentCount(), state.scene.seed);
  const auto& herds = state.scene.herds;
  for (size_t h = 0; h < std::min(herds.size(), mostHerds); ++h)
    fmt::print("  herd    {} {}, {}\n", herds[h].agents, herds[h].rig, nameOf(herds[h].controller));
  if (herds.size() > mostHerds) fmt::print("          and {} more herds\n", herds.size() - mostHerds);
  fmt::print("  terrain {}\n", describe(state.terrain));
  if (const std::optional<Levels>& levels = state.options.levels)
    fmt::print("  levels  of rate to {} m, of at most {} agents\n", fmt::join(levels->distances, ", "),
               fmt::join(levels->most, ", "));
  if (!note.manifest.is_null())
    fmt::print("  saved   by version {}: {}\n", note.manifest.value("version", "?"),
               note.manifest.value("command", "?"));
  fmt::print("  goes on with: skitter run --resume {} --frames N\n", file);
}

nlohmann::ordered_json describeState(const std::string& file) {
  const State state = loadState(file);
  const RunNote note = RunNote::of(state, file);
  nlohmann::ordered_json levels;
  if (state.options.levels)
    levels = {{"distances", state.options.levels->distances}, {"most", state.options.levels->most}};
  return {{"file", file},
          {"tick", state.tick},
          {"dt", note.dt},
          {"agents", state.scene.agentCount()},
          {"sleep", state.options.sleep},
          {"measure", state.options.measure},
          {"levels", levels},
          {"obstacle", !note.obstacle.is_null()},
          {"scene", nlohmann::ordered_json::parse(sceneJson(state.scene))},
          {"terrain", describe(state.terrain)},
          {"saved", note.manifest}};
}

}  // namespace skitter::app
