#include "experiments/fidelity.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bench/statistics.h"
#include "experiments/walk.h"

namespace skitter::experiments {
namespace {

constexpr double speed = 1;         // metres a second commanded: a leg length a second of the built-in spider
constexpr uint32_t lookEvery = 30;  // ticks between two looks at where agents are

FidelityRow measure(Device& device, const Heightfield& ground, const Settings& settings,
                    const Subject& subject, const std::function<void(double)>& progress) {
  Walk walk(device, ground, crossing(subject.controller, settings.fidelityAgents, speed, settings.seed),
            settings.dt);
  const double length = walk.rig().legLength;
  FidelityRow row;
  row.controller = subject.controller;
  std::vector<double> rough, travelled, depths, heights;
  std::vector<AgentState> last;
  for (uint32_t i = 1; i <= settings.fidelityTicks; ++i) {
    walk.tick();
    if (i % lookEvery != 0) continue;
    progress(static_cast<double>(i) / settings.fidelityTicks);
    std::vector<AgentState> agents = walk.agents();
    for (size_t a = 0; a < agents.size(); ++a) {
      rough.push_back(roughnessAt(ground, walk.rig(), agents[a].position, agents[a].heading) / length);
      for (const LegState& leg : agents[a].legs) {
        const double above =
            leg.foot.y - ground.at(static_cast<float>(leg.foot.x), static_cast<float>(leg.foot.z));
        depths.push_back(std::max(0.0, -above) / length);
        if (leg.stance) heights.push_back(std::max(0.0, above) / length);
      }
      // The first second, in which they start, is left out.
      if (last.empty() || (i <= 2 * lookEvery && settings.fidelityTicks > 2 * lookEvery)) continue;
      const glm::dvec3 way = agents[a].position - last[a].position;
      travelled.push_back(std::hypot(way.x, way.z) / (lookEvery * settings.dt));
    }
    last = std::move(agents);
  }
  row.roughness = bench::mean(rough);
  row.speed = bench::mean(travelled) / speed;
  row.depthSeen = bench::mean(depths);
  row.heightSeen = bench::mean(heights);
  row.fidelity = walk.crowd().fidelity();
  return row;
}

}  // namespace

const std::vector<FidelityColumn>& fidelityColumns() {
  // A field of Fidelity is a line here.
  static const std::vector<FidelityColumn> columns = {
      {"slip", "slip a stance, %", 100, [](const Fidelity& f) { return f.slip; }},
      {"skating", "skating, % of stance", 100, [](const Fidelity& f) { return f.skating; }},
      {"penetration", "penetration, %", 100, [](const Fidelity& f) { return f.penetration; }},
      {"float", "float, %", 100, [](const Fidelity& f) { return f.floating; }},
      {"segment_penetration", "legs below ground, %", 100,
       [](const Fidelity& f) { return f.segmentPenetration; }},
      {"crossing", "legs crossing, % of time", 100, [](const Fidelity& f) { return f.crossing; }},
      {"reach_error_p99", "reach error p99, %", 100, [](const Fidelity& f) { return f.reachErrorP99; }},
      {"limit_violation", "limit violation, rad", 1, [](const Fidelity& f) { return f.limitViolation; }},
      {"foot_jerk", "foot jerk", 1, [](const Fidelity& f) { return f.footJerk; }},
      {"body_jerk", "body jerk", 1, [](const Fidelity& f) { return f.bodyJerk; }},
      {"margin_least", "least stability margin, %", 100, [](const Fidelity& f) { return f.marginLeast; }},
      {"unstable", "unstable, % of time", 100, [](const Fidelity& f) { return f.unstable; }},
      {"last_resorts", "last resorts", 1,
       [](const Fidelity& f) { return static_cast<double>(f.lastResorts); }},
  };
  return columns;
}

FidelityStudy measureFidelity(Device& device, const std::vector<Ground>& grounds, const Settings& settings,
                              Course& course) {
  FidelityStudy study;
  double done = 0;
  const auto all = static_cast<double>(grounds.size() * subjects.size());
  for (const Ground& ground : grounds) {
    study.grounds.push_back(fmt::format("{}: {}", ground.name, ground.what));
    for (const Subject& subject : subjects) {
      study.rows.push_back(measure(device, ground.field, settings, subject,
                                   [&](double share) { course.at((done + share) / all); }));
      study.rows.back().ground = ground.name;
      course.at(++done / all);
    }
  }
  return study;
}

const FidelityRow* FidelityStudy::find(const std::string& ground, Controller controller) const {
  for (const FidelityRow& row : rows)
    if (row.ground == ground && row.controller == controller) return &row;
  return nullptr;
}

Table FidelityStudy::csv() const {
  Table table{{"ground", "roughness", "controller", "speed", "penetration_seen", "float_seen"}};
  for (const FidelityColumn& column : fidelityColumns()) table.head.push_back(column.name);
  for (const FidelityRow& row : rows) {
    std::vector<std::string> cells = {row.ground,
                                      fmt::format("{:.6f}", row.roughness),
                                      nameOf(row.controller),
                                      fmt::format("{:.5f}", row.speed),
                                      fmt::format("{:.6g}", row.depthSeen),
                                      fmt::format("{:.6g}", row.heightSeen)};
    for (const FidelityColumn& column : fidelityColumns()) {
      const std::optional<double> value = column.value(row.fidelity);
      cells.push_back(value ? fmt::format("{:.6g}", *value) : "");
    }
    table.rows.push_back(std::move(cells));
  }
  return table;
}

}  // namespace skitter::experiments
