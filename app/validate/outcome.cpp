#include "app/validate/outcome.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/common/signals.h"
#include "validation/replay.h"

namespace skitter::app {
namespace {

using nlohmann::ordered_json;
using validation::StageResult;

ordered_json jsonOf(const Outcome& outcome) {
  ordered_json stages = ordered_json::array();
  for (const StageResult& result : outcome.stages) {
    stages.push_back({{"name", result.name},
                      {"samples", result.samples},
                      {"kept", result.kept},
                      {"maxError", result.maxError},
                      {"tolerance", result.tolerance},
                      {"ties", result.ties},
                      {"worst", result.worst},
                      {"pass", result.pass},
                      {"why", result.why}});
  }
  ordered_json json = {{"device", outcome.device.empty() ? ordered_json() : ordered_json(outcome.device)},
                       {"ticks", outcome.ticks},
                       {"ticksWanted", outcome.wanted},
                       {"interrupted", !outcome.isWhole()},
                       {"timedOut", !outcome.isWhole() && timedOut()},
                       {"stages", stages}};
  if (outcome.edits) json["edits"] = *outcome.edits;
  if (outcome.freeShare) json["freeRunShare"] = *outcome.freeShare;
  json["pass"] = outcome.passes();
  return json;
}

}  // namespace

std::string Outcome::failed() const {
  std::string names;
  for (const StageResult& stage : stages)
    if (!stage.pass) names += (names.empty() ? "" : ", ") + stage.name;
  return names;
}

void print(const Outcome& outcome, const Scene& scene) {
  fmt::print("{}: {} agents, {} ticks, seed {}\n", outcome.device, scene.agentCount(), outcome.ticks,
             scene.seed);
  fmt::print("{}", validation::table(outcome.stages));
  const auto closest = std::ranges::max_element(outcome.stages, {}, &StageResult::ratio);
  if (closest != outcome.stages.end() && closest->pass && closest->samples > 0)
    fmt::print("closest to its tolerance: {}: {}\n", closest->name, closest->worst);
  if (outcome.edits) fmt::print("edits of the ground: {}\n", *outcome.edits);
  if (outcome.freeShare)
    fmt::print(
        "free run: {:.1f} % of the agents within {:g} % of leg length of where the reference alone has "
        "them\n",
        100 * *outcome.freeShare, 100 * freeRunTolerance);
}

ordered_json jsonOf(std::span<const Outcome> outcomes, bool several) {
  if (!several) return jsonOf(outcomes.front());
  ordered_json devices = ordered_json::array();
  for (const Outcome& outcome : outcomes) devices.push_back(jsonOf(outcome));
  return {{"devices", devices}, {"pass", std::ranges::all_of(outcomes, &Outcome::passes)}};
}

}  // namespace skitter::app
