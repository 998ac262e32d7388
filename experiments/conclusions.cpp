#include "experiments/conclusions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/agents.h"
#include "experiments/settings.h"

namespace skitter::experiments {
namespace {

constexpr double frameBudget = 16.7;
constexpr const char* notMeasured = "not measured";

// The most agents of the dissertation's three kinds within the budget, by the wall clock or by CPU time.
struct Fits {
  double clip = 0, loop = 0, adaptive = 0;
};
struct AgentCounts {
  bool measured = false;  // all three were searched,
  bool exact = false;     // and none was given up at as many as were tried
  Fits wall;
  std::optional<Fits> cpu;  // of a software device

  explicit AgentCounts(const Results& results) {
    const auto limit = [&](Controller controller) {
      return results.simulated.limit(controller, false, frameBudget);
    };
    const AgentLimit *clip = limit(Controller::clip), *loop = limit(Controller::loop),
                     *adaptive = limit(Controller::adaptive);
    measured = clip && loop && adaptive;
    if (!measured) return;
    exact = clip->next > 0 && loop->next > 0 && adaptive->next > 0;
    wall = {double(clip->agents), double(loop->agents), double(adaptive->agents)};
    if (clip->byCpu > 0 && loop->byCpu > 0 && adaptive->byCpu > 0)
      cpu = {clip->byCpu, loop->byCpu, adaptive->byCpu};
  }

  // What holds by the wall clock and by CPU time: where other users of the machine turn it, nothing is
  // settled.
  template <class Claim>
  std::optional<bool> settled(const Claim& claim) const {
    if (!exact) return {};
    const bool held = claim(wall);
    if (cpu && claim(*cpu) != held) return {};
    return held;
  }
  std::string words() const {
    if (!measured) return notMeasured;
    const auto list = [](const Fits& f) {
      return fmt::format("clip {:.0f}, loop {:.0f}, adaptive {:.0f}", f.clip, f.loop, f.adaptive);
    };
    std::string text = list(wall);
    if (!exact) text += ", of which some were as many as were tried";
    if (exact && cpu) text += "; by CPU time " + list(*cpu);
    return text;
  }
};

Conclusion handful(const Results& results) {
  const AgentCounts counts(results);
  const auto few = [](const Fits& f) { return f.clip <= 20 && f.loop <= 9 && f.adaptive <= 4; };
  Conclusion made{
      "No more than 20 pre-animated, 9 procedural and 4 adaptive agents run before performance "
      "suffers visibly",
      "Figures 6 to 8", "no more agents of any kind fit 16.7 ms of simulation", counts.words(),
      counts.settled(few)};
  // As many as were tried are enough to tell that there may be more.
  if (!few(counts.wall)) made.holds = false;
  return made;
}

Conclusion order(const Results& results) {
  const AgentCounts counts(results);
  return {
      "Pre-animated agents are the cheapest, adaptive ones the dearest", "Figures 6 to 8",
      "more clip agents than loop, more loop than adaptive fit 16.7 ms, by the wall clock and by CPU time",
      counts.words(), counts.settled([](const Fits& f) { return f.clip > f.loop && f.loop > f.adaptive; })};
}

Conclusion fivefold(const Results& results) {
  const AgentCounts counts(results);
  const auto ratio = [](const Fits& f) { return f.clip / std::max(1.0, f.adaptive); };
  std::string words = counts.words();
  if (counts.exact) {
    words = fmt::format("{:.2f} times as many", ratio(counts.wall));
    if (counts.cpu) words += fmt::format("; by CPU time {:.2f}", ratio(*counts.cpu));
  }
  return {"An adaptive agent costs five times a pre-animated one (20 to 4)", "Figures 6 and 8",
          "at least five times as many clip agents as adaptive ones fit 16.7 ms, by the wall clock and by "
          "CPU time",
          words, counts.settled([&](const Fits& f) { return ratio(f) >= 5; })};
}

// The mean share of solves that the accuracy ends, over the points of one reading's sweeps.
std::optional<double> accuracyShare(const Results& results, const char* reading) {
  double sum = 0, count = 0;
  for (const bench::SolveSweep& sweep : results.sweeps) {
    if (!sweep.name.ends_with(reading)) continue;
    for (const bench::SolvePoint& point : sweep.points) sum += point.stops[0], ++count;
  }
  if (count == 0) return {};
  return sum / count;
}

Conclusion accuracy(const Results& results) {
  const auto steps = accuracyShare(results, "steps"), factors = accuracyShare(results, "factors");
  Conclusion made{"The accuracy threshold is rarely what ends a solve",
                  "Figures 3 to 5",
                  "it ends less than half of the solves, in both readings of the figures",
                  notMeasured,
                  {}};
  if (!steps || !factors) return made;
  made.measured = fmt::format("it ends {:.1f} % of them in steps of 100, {:.1f} % by factors of 100",
                              100 * *steps, 100 * *factors);
  made.holds = *steps < 0.5 && *factors < 0.5;
  return made;
}

// The exponent of time against what is altered, fitted over all series.
std::optional<double> exponent(const Results& results, const std::string& altered) {
  const auto amount = [&](const bench::InstancePoint& p) -> double {
    return altered == "instances" ? p.instances : p.iterations;
  };
  double sum = 0;
  int count = 0;
  for (const bench::InstancePoint& first : results.instances) {
    if (first.altered != altered) continue;
    const bench::InstancePoint* last = &first;
    bool begins = true;
    for (const bench::InstancePoint& other : results.instances) {
      if (other.altered != altered || other.series != first.series) continue;
      if (amount(other) < amount(first)) begins = false;
      if (amount(other) > amount(*last)) last = &other;
    }
    if (!begins || last == &first) continue;
    sum += std::log(last->milliseconds / first.milliseconds) / std::log(amount(*last) / amount(first));
    ++count;
  }
  if (count == 0) return {};
  return sum / count;
}

Conclusion instances(const Results& results) {
  const auto chains = exponent(results, "instances"), iterations = exponent(results, "iterations");
  Conclusion made{
      "More iterations cost as more instances do",
      "Figures 3 to 5, and time against chains",
      "over the ranges measured, time grows with the iterations allowed to a power within 0.2 of that with "
      "which it grows with instances",
      notMeasured,
      {}};
  if (!chains || !iterations) return made;
  made.measured = fmt::format("powers: instances {:.2f}, iterations {:.2f}", *chains, *iterations);
  made.holds = std::fabs(*chains - *iterations) <= 0.2;
  return made;
}

Conclusion collectionOne(const Results& results) {
  Conclusion made{"Collecting the points of one leg takes a noticeable part of a frame (0.83 ms)",
                  "point collection",
                  "it takes 0.83 ms or more, by its own rule, on the device and on the CPU",
                  notMeasured,
                  {}};
  const CollectionTime* one = results.collection.find("nearest", 1);
  if (!one) return made;
  made.measured = fmt::format("{:.4f} ms on the device, {:.5f} ms on the CPU", one->deviceMilliseconds,
                              one->cpuMilliseconds);
  made.holds = one->deviceMilliseconds >= 0.83 && one->cpuMilliseconds >= 0.83;
  return made;
}

Conclusion collectionFour(const Results& results) {
  Conclusion made{"Four legs take about three times as long as one (2.63 to 0.83 ms: 3.2)",
                  "point collection",
                  "the ratio is between 2.4 and 4, on the device",
                  notMeasured,
                  {}};
  const CollectionTime *one = results.collection.find("nearest", 1),
                       *four = results.collection.find("nearest", 4);
  if (!one || !four) return made;
  const double device = four->deviceMilliseconds / one->deviceMilliseconds,
               cpu = four->cpuMilliseconds / one->cpuMilliseconds;
  made.measured = fmt::format("{:.2f} on the device, {:.2f} on the CPU", device, cpu);
  made.holds = device >= 2.4 && device <= 4;
  return made;
}

std::string percent(double value) { return value < 0.001 ? "under 0.001 %" : fmt::format("{:.2g} %", value); }

// Compares penetration and float together, on uneven ground.
Conclusion fidelity(const Results& results) {
  bool better = true, any = false;
  std::string measured;
  for (const FidelityRow& row : results.fidelity.rows) {
    if (row.controller != Controller::adaptive || row.ground == "flat") continue;
    const FidelityRow *clip = results.fidelity.find(row.ground, Controller::clip),
                      *loop = results.fidelity.find(row.ground, Controller::loop);
    if (!clip || !loop) continue;
    const auto off = [](const FidelityRow& r) { return 100 * (r.depthSeen + r.heightSeen); };
    any = true;
    better = better && off(row) < off(*clip) && off(row) < off(*loop);
    measured += fmt::format("{}{}: adaptive {}, clip {}, loop {}", measured.empty() ? "" : "; ", row.ground,
                            percent(off(row)), percent(off(*clip)), percent(off(*loop)));
  }
  Conclusion made{
      "Adaptive animation increases visual fidelity",
      "Figures 9 to 14 and the table of fidelity",
      "on every uneven ground its feet are off the ground (penetration plus float, seen) by less than "
      "those of clip and loop",
      measured.empty() ? notMeasured : measured,
      {}};
  if (any) made.holds = better;
  return made;
}

Conclusion limits(const Results& results) {
  double violation = 0, error = 0;
  bool any = false;
  for (const FidelityRow& row : results.fidelity.rows) {
    if (row.controller != Controller::adaptive) continue;
    any = true;
    violation = std::max(violation, row.fidelity.limitViolation.value_or(0));
    error = std::max(error, row.fidelity.reachErrorP99);
  }
  Conclusion made{
      "Joint constraints cannot be had without giving up what the solver reaches",
      "the table of fidelity",
      "on some ground adaptive agents break a limit by over 1e-3 rad, or miss by over 0.5 % of the leg "
      "length (99th percentile)",
      notMeasured,
      {}};
  if (!any) return made;
  made.measured =
      fmt::format("limits broken by at most {:.2g} rad, missed by at most {:.3g} %", violation, 100 * error);
  made.holds = violation > 1e-3 || error > 0.005;
  return made;
}

}  // namespace

std::vector<Conclusion> conclusionsOf(const Results& results) {
  return {handful(results),        order(results),     fivefold(results),
          accuracy(results),       instances(results), collectionOne(results),
          collectionFour(results), fidelity(results),  limits(results)};
}

std::string verdictOf(const Conclusion& c) {
  if (c.holds) return *c.holds ? "holds" : "does not hold";
  return c.measured == notMeasured ? notMeasured : "not settled";
}

Table tableOf(const std::vector<Conclusion>& conclusions) {
  Table table{{"The dissertation concludes", "verdict", "measured here", "it would hold if", "rests on"}};
  for (const Conclusion& c : conclusions)
    table.rows.push_back({c.claim, verdictOf(c), c.measured, c.criterion, c.rests});
  return table;
}

}  // namespace skitter::experiments
