#include "app/validate/outcome.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/common/law_watch.h"
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
  ordered_json laws = ordered_json::array();
  for (const laws::Figure& figure : outcome.laws)
    laws.push_back({{"name", laws::nameOf(figure.law)},
                    {"herd", figure.herd},
                    {"unit", laws::infoOf(figure.law).unit},
                    {"least", figure.bound.least == -laws::unbounded ? ordered_json()
                                                                     : ordered_json(figure.bound.least)},
                    {"most", figure.bound.most},
                    {"value", figure.value},
                    {"worst", figure.worst},
                    {"samples", figure.samples},
                    {"judged", figure.judged},
                    {"agents", figure.agents},
                    {"firstTick", figure.agents > 0 ? ordered_json(figure.firstTick) : ordered_json()},
                    {"pass", figure.isKept},
                    {"why", figure.text}});
  json["laws"] = laws;
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

std::string Outcome::brokenLaws() const { return namesOf(brokenOf(laws)); }

void print(const Outcome& outcome, const Scene& scene) {
  fmt::print("{}: {} agents, {} ticks, seed {}\n", outcome.device, scene.agentCount(), outcome.ticks,
             scene.seed);
  fmt::print("{}", validation::table(outcome.stages));
  const auto closest = std::ranges::max_element(outcome.stages, {}, &StageResult::ratio);
  if (closest != outcome.stages.end() && closest->pass && closest->samples > 0)
    fmt::print("closest to its tolerance: {}: {}\n", closest->name, closest->worst);
  fmt::print("law         herd  agents    samples       value       worst  expected\n");
  for (const laws::Figure& f : outcome.laws) {
    const bool isTwoSided = f.bound.least != -laws::unbounded;
    fmt::print("{:<10} {:>5} {:>7} {:>10}  {:>10.3g}  {:>10.3g}  {}{}\n", laws::nameOf(f.law), f.herd,
               f.judged, f.samples, f.value, f.worst,
               isTwoSided ? fmt::format("{:g} to {:g}", f.bound.least, f.bound.most)
                          : fmt::format("at most {:g}", f.bound.most),
               f.isKept ? "" : "  BROKEN");
    if (!f.isKept) fmt::print("           {}\n", f.text);
  }
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
