#include "bench/ik/dissertation_figures.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <optional>

#include "bench/ik/measured_batch.h"
#include "skitter/error.h"

namespace skitter::bench {
namespace {

constexpr int kJoints = 10;
constexpr uint32_t kFixedIterations = 100;  // where the accuracy alone is altered
constexpr float kFixedTolerance = 9e-4f;    // where the iterations alone are

// A solver with its chains and targets. "anywhere": targets in all directions, of which a chain with limits
// reaches some; otherwise every target can be reached.
struct Series {
  const char* name;
  const char* title;
  ik::Solver solver;
  const char* limits;
  bool anywhere;
};
constexpr Series allSeries[] = {
    {"fabrik", "FABRIK without limits", ik::Solver::fabrik, "none", false},
    {"keep", "keep rule, cones of 60 degrees", ik::Solver::dissertationKeep, "cone60", false},
    {"edge", "edge rule, cones of 60 degrees", ik::Solver::dissertationEdge, "cone60", false},
    {"edge-anywhere", "edge rule, targets anywhere", ik::Solver::dissertationEdge, "cone60", true},
};

struct Point {
  uint32_t iterations;
  float tolerance;
};

// What is altered, in one of the readings.
struct Sweep {
  const char* name;
  std::vector<Point> points;
};

std::vector<Sweep> allSweeps(const FigureSizes& sizes) {
  std::vector<Sweep> sweeps = {{"iterations-steps", {}}, {"iterations-factors", {}}, {"accuracy-steps", {}},
                               {"accuracy-factors", {}}, {"both-steps", {}},         {"both-factors", {}}};
  for (uint32_t i = 1; i <= sizes.steps; ++i) {
    const float accuracy = 1.0f / float(100 * i);
    sweeps[0].points.push_back({100 * i, kFixedTolerance});
    sweeps[2].points.push_back({kFixedIterations, accuracy});
    sweeps[4].points.push_back({100 * i, accuracy});
  }
  uint32_t iterations = 1;
  for (int i = 0; i <= sizes.iterationPower; ++i, iterations *= 100) {
    sweeps[1].points.push_back({iterations, kFixedTolerance});
    sweeps[5].points.push_back({iterations, float(std::pow(100.0, -i))});
  }
  for (int i = 0; i <= sizes.accuracyPower; ++i)
    sweeps[3].points.push_back({kFixedIterations, float(std::pow(100.0, -i))});
  return sweeps;
}

std::vector<glm::vec3> targetsOf(const Series& series, uint32_t chains) {
  const baseline::Chain asked = chainWith(series.anywhere ? "none" : series.limits, kJoints);
  return Targets({baseline::coldTargets(asked, chains, 1)}, chains).vectors[0];
}

MeasuredBatch measure(Device& device, const Series& series, const Point& point,
                      const std::vector<glm::vec3>& targets, int repetitions) {
  ik::Options options;
  options.solver = series.solver;
  options.iterations = point.iterations;
  options.tolerance = point.tolerance;
  return measureBatch(device, chainWith(series.limits, kJoints), targets, options, repetitions);
}

// The next point's time, if those that the cap ended go on as they did.
double foreseen(const MeasuredBatch& last, const Point& from, const Point& to) {
  const bool goesOn = last.quality.stopShare(ik::Stop::cap) > 0;
  return last.seconds * (goesOn ? double(to.iterations) / double(from.iterations) : 1);
}

SolvePoint pointOf(const Series& series, const Point& point, const MeasuredBatch& batch, uint32_t chains) {
  const Quality& quality = batch.quality;
  SolvePoint made{series.name,
                  point.iterations,
                  point.tolerance,
                  1e6 * batch.seconds / chains,
                  quality.meanIterations(),
                  quality.meanError(),
                  {},
                  1e6 * batch.leastSeconds / chains,
                  1e6 * batch.mostSeconds / chains};
  for (size_t i = 0; i < made.stops.size(); ++i) made.stops[i] = quality.stopShare(ik::Stop(i));
  return made;
}

SolveSweep measureSweep(Device& device, const Sweep& sweep, const FigureSizes& sizes,
                        const std::function<void()>& done) {
  SolveSweep made{sweep.name, {}, {}};
  for (const Series& series : allSeries) {
    const std::vector<glm::vec3> targets = targetsOf(series, sizes.chains);
    std::optional<MeasuredBatch> last;
    Point from{};
    for (const Point& point : sweep.points) {
      if (last && foreseen(*last, from, point) > sizes.longestSeconds) {
        made.leftOut.push_back(fmt::format("{}: {} iterations are left out, they would take {:.0f} s",
                                           series.name, point.iterations, foreseen(*last, from, point)));
        break;
      }
      last = measure(device, series, point, targets, sizes.repetitions);
      from = point;
      made.points.push_back(pointOf(series, point, *last, sizes.chains));
      done();
    }
  }
  return made;
}

// 1, 2, 5, 10, 20, 50 ... `most`.
std::vector<uint32_t> spread(uint32_t most) {
  std::vector<uint32_t> values;
  for (uint32_t decade = 1; decade <= most; decade *= 10) {
    for (const uint32_t factor : {1u, 2u, 5u})
      if (decade * factor <= most) values.push_back(decade * factor);
  }
  return values;
}

// Counts points and tells what share of them is done.
class Count {
 public:
  Count(size_t total, const FigureProgress& progress) : total_(total), progress_(progress) {}
  void operator()() {
    ++done_;
    if (progress_) progress_(double(done_) / double(total_));
  }

 private:
  size_t total_, done_ = 0;
  const FigureProgress& progress_;
};

void writeCsv(const std::filesystem::path& folder, const std::string& name, const std::string& text) {
  const std::filesystem::path file = folder / (name + ".csv");
  std::ofstream out(file);
  if (!(out << text) || !out.flush()) throw inputError(fmt::format("{}: cannot be written", file.string()));
  fmt::print("{}\n", file.string());
  std::fflush(stdout);
}

}  // namespace

const char* seriesTitle(const std::string& name) {
  for (const Series& series : allSeries)
    if (name == series.name) return series.title;
  return "";
}

std::vector<SolveSweep> measureSweeps(Device& device, const FigureSizes& sizes,
                                      const FigureProgress& progress) {
  const std::vector<Sweep> sweeps = allSweeps(sizes);
  size_t points = 0;
  for (const Sweep& sweep : sweeps) points += sweep.points.size() * std::size(allSeries);
  Count count(points, progress);
  std::vector<SolveSweep> made;
  for (const Sweep& sweep : sweeps) made.push_back(measureSweep(device, sweep, sizes, [&] { count(); }));
  return made;
}

std::vector<InstancePoint> measureInstances(Device& device, const FigureSizes& sizes,
                                            const FigureProgress& progress) {
  const std::vector<uint32_t> instances = spread(sizes.mostInstances),
                              iterations = spread(sizes.mostIterations);
  Count count((instances.size() + iterations.size()) * std::size(allSeries), progress);
  std::vector<InstancePoint> made;
  for (const Series& series : allSeries) {
    const auto add = [&](const char* altered, const Point& point, const std::vector<glm::vec3>& targets) {
      const MeasuredBatch batch = measure(device, series, point, targets, sizes.repetitions);
      made.push_back({series.name, altered, uint32_t(targets.size()), point.iterations, 1e3 * batch.seconds,
                      1e3 * batch.wallSeconds});
      count();
    };
    const std::vector<glm::vec3> targets = targetsOf(series, std::max(sizes.mostInstances, sizes.instances));
    for (const uint32_t n : instances)
      add("instances", {kFixedIterations, kFixedTolerance}, {targets.begin(), targets.begin() + n});
    for (const uint32_t n : iterations)
      add("iterations", {n, kFixedTolerance}, {targets.begin(), targets.begin() + sizes.instances});
  }
  return made;
}

std::string csvOf(const SolveSweep& sweep) {
  std::string text =
      "series,iterations,tolerance,us_a_solve,mean_iterations,mean_error,"
      "stop_tolerance,stop_cap,stop_stall,stop_unreachable,us_least,us_most\n";
  for (const SolvePoint& point : sweep.points) {
    text += fmt::format("{},{},{:g},{:.4f},{:.3f},{:.3e},{:.5f},{:.5f},{:.5f},{:.5f},{:.4f},{:.4f}\n",
                        point.series, point.iterations, point.tolerance, point.microseconds,
                        point.meanIterations, point.meanError, point.stops[0], point.stops[1], point.stops[2],
                        point.stops[3], point.leastMicroseconds, point.mostMicroseconds);
  }
  for (const std::string& line : sweep.leftOut) text += "# " + line + "\n";
  return text;
}

std::string csvOf(const std::vector<InstancePoint>& points) {
  std::string text = "series,altered,instances,iterations,milliseconds,wall_milliseconds\n";
  for (const InstancePoint& point : points) {
    text += fmt::format("{},{},{},{},{:.5f},{:.5f}\n", point.series, point.altered, point.instances,
                        point.iterations, point.milliseconds, point.wallMilliseconds);
  }
  return text;
}

void writeDissertationFigures(Device& device, const std::filesystem::path& folder, bool quick) {
  std::error_code fault;
  std::filesystem::create_directories(folder, fault);
  if (fault) throw inputError(fmt::format("--figures {}: {}", folder.string(), fault.message()));
  const FigureSizes sizes = quick ? FigureSizes::quick() : FigureSizes{};
  for (const SolveSweep& sweep : measureSweeps(device, sizes)) writeCsv(folder, sweep.name, csvOf(sweep));
  writeCsv(folder, "instances", csvOf(measureInstances(device, sizes)));
}

}  // namespace skitter::bench
