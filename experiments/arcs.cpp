#include "experiments/arcs.h"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/walk.h"

namespace skitter::experiments {
namespace {

FootArcs measure(Device& device, const Heightfield& ground, const Settings& settings,
                 const Subject& subject) {
  Walk walk(device, ground, crossing(subject.controller, 1, 1, settings.seed), settings.dt);
  walk.ticks(settings.settleTicks);
  FootArcs made;
  made.controller = subject.controller;
  made.legLength = walk.rig().legLength;
  for (const Leg& leg : walk.rig().legs) made.legs.push_back(leg.name);
  int lifts = 0;  // of the first leg, which begin and end a cycle
  bool stood = false;
  for (uint32_t i = 0; i < settings.arcTicks && lifts < 3; ++i) {
    walk.tick();
    AgentState agent = walk.agents().front();
    const bool stands = agent.legs.front().stance;
    if (stood && !stands) ++lifts;
    stood = stands;
    if (lifts == 0 && i + 1 < settings.arcTicks / 2) continue;  // where it never lifts, half of it must do
    std::vector<double>& below = made.ground.emplace_back();
    for (const LegState& leg : agent.legs)
      below.push_back(ground.at(static_cast<float>(leg.foot.x), static_cast<float>(leg.foot.z)));
    made.ticks.push_back(std::move(agent));
  }
  return made;
}

// Mean over the legs and ticks that count.
template <class Value, class Counts>
double meanOf(const FootArcs& arcs, const Value& value, const Counts& counts) {
  double sum = 0;
  size_t count = 0;
  for (size_t t = 0; t < arcs.ticks.size(); ++t) {
    for (size_t l = 0; l < arcs.legs.size(); ++l) {
      const LegState& leg = arcs.ticks[t].legs[l];
      if (!counts(leg)) continue;
      sum += std::max(0.0, value(leg.foot.y - arcs.ground[t][l]));
      ++count;
    }
  }
  return count > 0 ? sum / static_cast<double>(count) / arcs.legLength : 0;
}

}  // namespace

double FootArcs::depth() const {
  return meanOf(
      *this, [](double above) { return -above; }, [](const LegState&) { return true; });
}
double FootArcs::height() const {
  return meanOf(
      *this, [](double above) { return above; }, [](const LegState& leg) { return leg.stance; });
}

std::vector<FootArcs> measureArcs(Device& device, const Heightfield& ground, const Settings& settings,
                                  Course& course) {
  std::vector<FootArcs> made;
  for (const Subject& subject : subjects) {
    course.at(static_cast<double>(made.size()) / subjects.size());
    made.push_back(measure(device, ground, settings, subject));
  }
  return made;
}

Table tableOf(const std::vector<FootArcs>& all) {
  Table table{{"controller", "tick", "leg", "x", "y", "z", "ground", "stance"}};
  for (const FootArcs& arcs : all) {
    for (size_t t = 0; t < arcs.ticks.size(); ++t) {
      for (size_t l = 0; l < arcs.legs.size(); ++l) {
        const LegState& leg = arcs.ticks[t].legs[l];
        table.rows.push_back({nameOf(arcs.controller), fmt::format("{}", t), arcs.legs[l],
                              fmt::format("{:.4f}", leg.foot.x), fmt::format("{:.4f}", leg.foot.y),
                              fmt::format("{:.4f}", leg.foot.z), fmt::format("{:.4f}", arcs.ground[t][l]),
                              leg.stance ? "1" : "0"});
      }
    }
  }
  return table;
}

}  // namespace skitter::experiments
