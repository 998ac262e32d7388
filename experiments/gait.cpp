#include "experiments/gait.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "experiments/grounds.h"
#include "experiments/walk.h"

namespace skitter::experiments {
namespace {

constexpr double together = 0.02;  // of a cycle: what a tick or two leave of "at once"

double wrapped(double phase) { return phase - std::floor(phase); }
// To the nearer side: -0.5 to 0.5.
double difference(double a, double b) { return wrapped(a - b + 0.5) - 0.5; }

// What one run of a herd was, tick by tick.
struct Record {
  std::vector<std::vector<AgentState>> ticks;

  std::vector<double> lifts(size_t agent, size_t leg) const {
    std::vector<double> at;
    for (size_t t = 1; t < ticks.size(); ++t)
      if (ticks[t - 1][agent].legs[leg].stance && !ticks[t][agent].legs[leg].stance)
        at.push_back(static_cast<double>(t));
    return at;
  }
};

// Mean phases by the circle: 0.99 and 0.01 make 0, not 0.5.
struct Circle {
  std::complex<double> sum{0, 0};
  double count = 0;
  void add(double phase) { sum += std::polar(1.0, 2 * std::numbers::pi * phase), ++count; }
  double phase() const { return count > 0 ? wrapped(std::arg(sum) / (2 * std::numbers::pi)) : 0; }
  double steadiness() const { return count > 0 ? std::abs(sum) / count : 0; }
};

void addPhases(const Record& record, double dt, GaitRow& row) {
  const size_t legs = record.ticks.front().front().legs.size();
  std::vector<Circle> circles(legs);
  double cycleTicks = 0;
  for (size_t agent = 0; agent < record.ticks.front().size(); ++agent) {
    const std::vector<double> first = record.lifts(agent, 0);
    for (size_t leg = 0; leg < legs; ++leg) {
      const std::vector<double> lifts = record.lifts(agent, leg);
      for (size_t c = 0; c + 1 < first.size(); ++c)
        for (const double t : lifts)
          if (t >= first[c] && t < first[c + 1]) circles[leg].add((t - first[c]) / (first[c + 1] - first[c]));
    }
    if (first.size() > 1) {
      cycleTicks += first.back() - first.front();
      row.cycles += static_cast<double>(first.size() - 1);
    }
  }
  if (row.cycles == 0) return;
  row.frequency = row.cycles / (cycleTicks * dt);
  row.stride = row.speed / row.frequency;
  for (const Circle& circle : circles) {
    row.phases.push_back(circle.phase());
    row.steadiness.push_back(circle.steadiness());
  }
}

void addGroups(const std::vector<int>& groups, GaitRow& row) {
  if (row.phases.empty()) return;
  const int count = *std::max_element(groups.begin(), groups.end()) + 1;
  std::vector<Circle> middle(static_cast<size_t>(count));
  for (size_t l = 0; l < groups.size(); ++l) middle[static_cast<size_t>(groups[l])].add(row.phases[l]);
  for (int g = 0; g < count; ++g) {
    double least = 0, most = 0;
    for (size_t l = 0; l < groups.size(); ++l) {
      if (groups[l] != g) continue;
      const double off = difference(row.phases[l], middle[static_cast<size_t>(g)].phase());
      least = std::min(least, off);
      most = std::max(most, off);
    }
    row.lag += (most - least) / count;
  }
  if (count > 1) row.groupsApart = std::fabs(difference(middle[1].phase(), middle[0].phase()));
}

GaitRow judge(const Record& record, const GaitStudy& study, double legLength) {
  GaitRow row;
  const auto agents = record.ticks.front().size();
  double stances = 0, all = 0, way = 0;
  for (size_t a = 0; a < agents; ++a) {
    double lowest = 1e9, highest = -1e9;
    for (size_t t = 0; t < record.ticks.size(); ++t) {
      const AgentState& agent = record.ticks[t][a];
      lowest = std::min(lowest, agent.position.y);
      highest = std::max(highest, agent.position.y);
      for (const LegState& leg : agent.legs) stances += leg.stance ? 1 : 0, ++all;
      if (t == 0) continue;
      const glm::dvec3 step = agent.position - record.ticks[t - 1][a].position;
      way += std::hypot(step.x, step.z);
    }
    row.bounce += (highest - lowest) / legLength / static_cast<double>(agents);
  }
  row.duty = stances / all;
  const double seconds = static_cast<double>(record.ticks.size() - 1) * study.dt;
  if (seconds > 0) row.speed = way / seconds / legLength / static_cast<double>(agents);
  addPhases(record, study.dt, row);
  addGroups(study.groups, row);
  return row;
}

}  // namespace

GaitStudy measureGait(Device& device, const Settings& settings, Course& course) {
  const Heightfield ground = flatGround();
  GaitStudy study;
  study.dt = settings.dt;
  double done = 0;
  for (const Subject& subject : subjects) {
    for (const double speed : settings.gaitSpeeds) {
      course.at(done++ / static_cast<double>(subjects.size() * settings.gaitSpeeds.size()));
      Walk walk(device, ground, crossing(subject.controller, settings.gaitAgents, speed, settings.seed),
                settings.dt);
      if (study.legs.empty()) {
        for (const Leg& leg : walk.rig().legs) {
          study.legs.push_back(leg.name);
          study.groups.push_back(leg.group);
        }
      }
      walk.ticks(settings.settleTicks);
      Record record;
      for (uint32_t t = 0; t < std::max(2u, settings.gaitTicks); ++t) {
        walk.tick();
        record.ticks.push_back(walk.agents());
      }
      GaitRow row = judge(record, study, walk.rig().legLength);
      row.controller = subject.controller;
      row.commanded = speed;
      study.rows.push_back(std::move(row));
      if (subject.controller == Controller::adaptive && speed == 1) {
        for (const std::vector<AgentState>& tick : record.ticks) {
          std::vector<bool>& stances = study.footfalls.emplace_back();
          for (const LegState& leg : tick.front().legs) stances.push_back(leg.stance);
        }
      }
    }
  }
  return study;
}

const GaitRow* GaitStudy::find(Controller controller, double commanded) const {
  for (const GaitRow& row : rows)
    if (row.controller == controller && row.commanded == commanded) return &row;
  return nullptr;
}

std::string GaitStudy::order(const GaitRow& row, char side) const {
  struct Lift {
    std::string number;
    double after;  // leg 4 of the side
  };
  std::vector<Lift> lifts;
  double hindmost = 0;
  for (size_t l = 0; l < legs.size() && !row.phases.empty(); ++l)
    if (legs[l] == std::string(1, side) + "4") hindmost = row.phases[l];
  for (size_t l = 0; l < legs.size() && !row.phases.empty(); ++l) {
    if (legs[l].empty() || legs[l][0] != side) continue;
    double after = wrapped(row.phases[l] - hindmost);
    if (after > 1 - together) after = 0;  // at once with it
    lifts.push_back({legs[l].substr(1), after});
  }
  std::sort(lifts.begin(), lifts.end(), [](const Lift& a, const Lift& b) {
    return std::fabs(a.after - b.after) < 1e-9 ? a.number > b.number : a.after < b.after;
  });
  std::string text;
  for (size_t i = 0; i < lifts.size(); ++i) {
    if (i > 0) text += lifts[i].after - lifts[i - 1].after < together ? "=" : "-";
    text += lifts[i].number;
  }
  return text;
}

GaitStudy::Line GaitStudy::dutyLine(Controller controller) const {
  Line line;
  double x = 0, y = 0, xx = 0, xy = 0, yy = 0;
  for (const GaitRow& row : rows) {
    if (row.controller != controller || row.frequency == 0) continue;
    ++line.points;
    x += row.speed, y += row.duty;
    xx += row.speed * row.speed, xy += row.speed * row.duty, yy += row.duty * row.duty;
  }
  if (line.points < 3) return line;
  const double n = line.points, sx = xx - x * x / n, sy = yy - y * y / n, s = xy - x * y / n;
  if (sx > 0) line.slope = s / sx;
  if (sx > 0 && sy > 0) line.correlation = s / std::sqrt(sx * sy);
  return line;
}

Table GaitStudy::table() const {
  Table table{{"controller", "commanded", "speed", "duty", "cycles_a_second", "stride", "bounce", "lag",
               "groups_apart", "cycles"}};
  for (const std::string& leg : legs) table.head.push_back("phase_" + leg);
  for (const GaitRow& row : rows) {
    std::vector<std::string> cells = {nameOf(row.controller)};
    for (const double value : {row.commanded, row.speed, row.duty, row.frequency, row.stride, row.bounce,
                               row.lag, row.groupsApart, row.cycles})
      cells.push_back(fmt::format("{:.5g}", value));
    for (size_t l = 0; l < legs.size(); ++l)
      cells.push_back(row.phases.empty() ? "" : fmt::format("{:.4f}", row.phases[l]));
    table.rows.push_back(std::move(cells));
  }
  return table;
}

}  // namespace skitter::experiments
