#include <fmt/format.h>

#include <algorithm>

#include "experiments/page/plot.h"
#include "experiments/sections/sections.h"

namespace skitter::experiments {
namespace {

const std::vector<std::string> stopParts = {"accuracy", "iterations", "stall", "out of reach"};
const std::vector<std::string> stopColours = {colour::blue, colour::red, colour::orange, colour::faint};

// What a sweep alters along x, and how that is written.
struct Altered {
  const char* sweep;  // without its reading
  const char* label;
  bool accuracy;  // x is the accuracy, not the iterations
};
constexpr Altered figures[] = {{"iterations", "iterations allowed", false},
                               {"accuracy", "accuracy asked for: 1 / share of the chain's length", true},
                               {"both", "iterations allowed, accuracy as many times finer", false}};

double amount(const Altered& altered, const bench::SolvePoint& point) {
  return altered.accuracy ? 1.0 / static_cast<double>(point.tolerance) : point.iterations;
}

std::vector<std::string> seriesOf(const bench::SolveSweep& sweep) {
  std::vector<std::string> names;
  for (const bench::SolvePoint& point : sweep.points)
    if (std::find(names.begin(), names.end(), point.series) == names.end()) names.push_back(point.series);
  return names;
}

std::string timePlot(const Altered& altered, const bench::SolveSweep& sweep, bool factors) {
  Plot plot;
  plot.title = factors ? "by factors of 100" : "in steps of 100";
  plot.x = {.label = altered.label, .log = factors};
  plot.y = {.label = "time a solve, microseconds", .log = true};
  for (const std::string& name : seriesOf(sweep)) {
    Series series{bench::seriesTitle(name), {}};
    for (const bench::SolvePoint& point : sweep.points) {
      if (point.series != name) continue;
      series.points.emplace_back(amount(altered, point), point.microseconds);
      series.spreads.emplace_back(point.leastMicroseconds, point.mostMicroseconds);
    }
    plot.series.push_back(std::move(series));
  }
  return draw(plot);
}

std::string stopBars(const Altered& altered, const bench::SolveSweep& sweep, const std::string& name) {
  Bars bars;
  bars.title = fmt::format("why solves ended: {}", bench::seriesTitle(name));
  bars.xLabel = altered.label;
  bars.parts = stopParts;
  bars.colours = stopColours;
  for (const bench::SolvePoint& point : sweep.points) {
    if (point.series != name) continue;
    bars.places.push_back(fmt::format("{:.4g}", amount(altered, point)));
    bars.shares.emplace_back(point.stops.begin(), point.stops.end());
  }
  return draw(bars);
}

const bench::SolveSweep* find(const std::vector<bench::SolveSweep>& sweeps, const std::string& name) {
  for (const bench::SolveSweep& sweep : sweeps)
    if (sweep.name == name) return &sweep;
  return nullptr;
}

std::string instancePlot(const std::vector<bench::InstancePoint>& points, const std::string& altered,
                         const char* label) {
  Plot plot;
  plot.title = altered == "instances" ? "more chains, at most 100 iterations" : "more iterations allowed";
  plot.x = {.label = label, .log = true};
  plot.y = {.label = "time of the batch, milliseconds", .log = true};
  for (const bench::InstancePoint& point : points) {
    if (point.altered != altered) continue;
    if (plot.series.empty() || plot.series.back().name != bench::seriesTitle(point.series))
      plot.series.push_back({bench::seriesTitle(point.series), {}});
    plot.series.back().points.emplace_back(altered == "instances" ? point.instances : point.iterations,
                                           point.milliseconds);
  }
  return draw(plot);
}

}  // namespace

void showSolves(const std::vector<bench::SolveSweep>& sweeps,
                const std::vector<bench::InstancePoint>& instances, const Settings& settings,
                Report& report) {
  Page& page = report.page;
  page.section("figures-3-5", "Figures 3 to 5: time against iterations, accuracy and both");
  page.paragraph(
      fmt::format("\"Altered in multiples of 100\" is read both ways: in steps of 100 and by factors of 100. "
                  "{} chains of 10 "
                  "joints from rest; FABRIK without limits, and the dissertation's two rules for a joint "
                  "outside its cone. Altered "
                  "alone, iterations go with an accuracy of 9e-4 of the chain's length, the accuracy with "
                  "100 iterations. Times "
                  "are CPU time of all threads on a software device, else by the wall clock.",
                  settings.solves.chains));
  int number = 3;
  for (const Altered& altered : figures) {
    page.heading(fmt::format("Figure {}: time against {}", number,
                             number == 5 ? "both" : (altered.accuracy ? "the accuracy" : "the iterations")));
    const bench::SolveSweep *steps = find(sweeps, fmt::format("{}-steps", altered.sweep)),
                            *factors = find(sweeps, fmt::format("{}-factors", altered.sweep));
    if (steps && factors) {
      page.drawings({timePlot(altered, *steps, false), timePlot(altered, *factors, true)},
                    fmt::format("Figure {}. Time of one solve: the median of {} repetitions, and a bar from "
                                "the quickest to the slowest.",
                                number, settings.solves.repetitions));
      std::vector<std::string> bars;
      for (const std::string& name : seriesOf(*steps)) {
        bars.push_back(stopBars(altered, *steps, name));
        bars.push_back(stopBars(altered, *factors, name));
      }
      page.drawings(
          bars, fmt::format("Figure {}, stop reasons. Shares of the solves that the accuracy, the iterations "
                            "allowed or a stall ended, or the reach test: in steps of 100 on the left, "
                            "by factors of 100 on the right. A stall is ours: an iteration that gains next "
                            "to nothing ends the solve.",
                            number));
      for (const bench::SolveSweep* sweep : {steps, factors}) {
        for (const std::string& line : sweep->leftOut) page.paragraph(line + ".");
        report.raw(fmt::format("figure{}-{}.csv", number, sweep->name), bench::csvOf(*sweep));
      }
    }
    ++number;
  }
  page.heading("More iterations beside more instances");
  page.drawings(
      {instancePlot(instances, "instances", "chains"),
       instancePlot(instances, "iterations", "iterations allowed")},
      fmt::format("Time of a batch against its chains, and of {} chains against the iterations allowed.",
                  settings.solves.instances));
  report.raw("instances.csv", bench::csvOf(instances));
}

}  // namespace skitter::experiments
