#include "bench/ik/dissertation_figures.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>

#include "bench/ik/measured_batch.h"
#include "skitter/error.h"

namespace skitter::bench {
namespace {

constexpr int kJoints = 10;
constexpr uint32_t kFixedIterations = 100;  // where the accuracy alone is altered
constexpr float kFixedTolerance = 9e-4f;    // where the iterations alone are
constexpr double kLongestSeconds = 100;     // of one batch; what is foreseen to take longer is left out

// A solver with its chains and targets. "anywhere": targets in all directions, of which a chain with limits
// reaches some; otherwise every target can be reached.
struct Series {
  const char* name;
  ik::Solver solver;
  const char* limits;
  bool anywhere;
};
constexpr Series allSeries[] = {
    {"fabrik", ik::Solver::fabrik, "none", false},
    {"keep", ik::Solver::dissertationKeep, "cone60", false},
    {"edge", ik::Solver::dissertationEdge, "cone60", false},
    {"edge-anywhere", ik::Solver::dissertationEdge, "cone60", true},
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

std::vector<Sweep> allSweeps(bool quick) {
  std::vector<Sweep> sweeps = {{"iterations-steps", {}}, {"iterations-factors", {}}, {"accuracy-steps", {}},
                               {"accuracy-factors", {}}, {"both-steps", {}},         {"both-factors", {}}};
  const uint32_t steps = quick ? 2 : 20;
  for (uint32_t i = 1; i <= steps; ++i) {
    const float accuracy = 1.0f / float(100 * i);
    sweeps[0].points.push_back({100 * i, kFixedTolerance});
    sweeps[2].points.push_back({kFixedIterations, accuracy});
    sweeps[4].points.push_back({100 * i, accuracy});
  }
  // 100^4 is the last power of 100 that 32 bits hold; 100^-18 the last that a normal float does.
  uint32_t iterations = 1;
  for (int i = 0; i <= (quick ? 1 : 4); ++i, iterations *= 100) {
    sweeps[1].points.push_back({iterations, kFixedTolerance});
    sweeps[5].points.push_back({iterations, float(std::pow(100.0, -i))});
  }
  for (int i = 0; i <= (quick ? 1 : 18); ++i)
    sweeps[3].points.push_back({kFixedIterations, float(std::pow(100.0, -i))});
  return sweeps;
}

std::vector<glm::vec3> targetsOf(const Series& series, uint32_t chains) {
  const baseline::Chain asked = chainWith(series.anywhere ? "none" : series.limits, kJoints);
  return Targets({baseline::coldTargets(asked, chains, 1)}, chains).vectors[0];
}

MeasuredBatch measure(Device& device, const Series& series, const Point& point,
                      const std::vector<glm::vec3>& targets) {
  ik::Options options;
  options.solver = series.solver;
  options.iterations = point.iterations;
  options.tolerance = point.tolerance;
  return measureBatch(device, chainWith(series.limits, kJoints), targets, options);
}

std::ofstream openCsv(const std::filesystem::path& folder, const std::string& name, const char* head) {
  const std::filesystem::path file = folder / (name + ".csv");
  std::ofstream out(file);
  if (!(out << head << "\n")) throw inputError(fmt::format("{}: cannot be written", file.string()));
  return out;
}

// The next point's time, if those that the cap ended go on as they did.
double foreseen(const MeasuredBatch& last, const Point& from, const Point& to) {
  const bool goesOn = last.quality.stopShare(ik::Stop::cap) > 0;
  return last.seconds * (goesOn ? double(to.iterations) / double(from.iterations) : 1);
}

void writeSweep(Device& device, const Sweep& sweep, const std::filesystem::path& folder, uint32_t chains) {
  std::ofstream csv = openCsv(folder, sweep.name,
                              "series,iterations,tolerance,us_a_solve,mean_iterations,mean_error,"
                              "stop_tolerance,stop_cap,stop_stall,stop_unreachable");
  for (const Series& series : allSeries) {
    const std::vector<glm::vec3> targets = targetsOf(series, chains);
    std::optional<MeasuredBatch> last;
    Point from{};
    for (const Point& point : sweep.points) {
      if (last && foreseen(*last, from, point) > kLongestSeconds) {
        csv << fmt::format("# {}: {} iterations are left out, they would take {:.0f} s\n", series.name,
                           point.iterations, foreseen(*last, from, point));
        break;
      }
      last = measure(device, series, point, targets);
      from = point;
      const Quality& quality = last->quality;
      csv << fmt::format("{},{},{:g},{:.4f},{:.3f},{:.3e},{:.5f},{:.5f},{:.5f},{:.5f}\n", series.name,
                         point.iterations, point.tolerance, 1e6 * last->seconds / chains,
                         quality.meanIterations(), quality.meanError(),
                         quality.stopShare(ik::Stop::tolerance), quality.stopShare(ik::Stop::cap),
                         quality.stopShare(ik::Stop::stall), quality.stopShare(ik::Stop::unreachable))
          << std::flush;
    }
  }
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

void writeInstances(Device& device, const std::filesystem::path& folder, bool quick) {
  std::ofstream csv =
      openCsv(folder, "instances", "series,altered,instances,iterations,milliseconds,wall_milliseconds");
  const uint32_t mostInstances = quick ? 20 : 100000, mostIterations = quick ? 5 : 1000,
                 instances = quick ? 20 : 1000;
  for (const Series& series : allSeries) {
    const auto write = [&](const char* altered, const Point& point, const std::vector<glm::vec3>& targets) {
      const MeasuredBatch batch = measure(device, series, point, targets);
      csv << fmt::format("{},{},{},{},{:.5f},{:.5f}\n", series.name, altered, targets.size(),
                         point.iterations, 1e3 * batch.seconds, 1e3 * batch.wallSeconds)
          << std::flush;
    };
    const std::vector<glm::vec3> targets = targetsOf(series, mostInstances);
    for (const uint32_t count : spread(mostInstances))
      write("instances", {kFixedIterations, kFixedTolerance}, {targets.begin(), targets.begin() + count});
    for (const uint32_t iterations : spread(mostIterations))
      write("iterations", {iterations, kFixedTolerance}, {targets.begin(), targets.begin() + instances});
  }
}

}  // namespace

void writeDissertationFigures(Device& device, const std::filesystem::path& folder, bool quick) {
  std::error_code fault;
  std::filesystem::create_directories(folder, fault);
  if (fault) throw inputError(fmt::format("--figures {}: {}", folder.string(), fault.message()));
  const uint32_t chains = quick ? 64 : 2048;
  for (const Sweep& sweep : allSweeps(quick)) {
    fmt::print("{}\n", (folder / sweep.name).string() + ".csv");
    std::fflush(stdout);
    writeSweep(device, sweep, folder, chains);
  }
  fmt::print("{}\n", (folder / "instances.csv").string());
  std::fflush(stdout);
  writeInstances(device, folder, quick);
}

}  // namespace skitter::bench
