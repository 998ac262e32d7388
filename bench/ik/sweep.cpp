#include "bench/ik/sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "base/clock.h"
#include "bench/ik/contestant.h"
#include "bench/ik/machine.h"
#include "validation/convert_ik.h"

namespace skitter::bench {
namespace {

constexpr int kTicks = 24;           // sets of targets of a tracking row, there and back again
constexpr int kSettle = 32;          // ticks before anything is judged or timed
constexpr int kJudged = 4;           // ticks judged
constexpr double kLimitSlip = 5e-4;  // radians
constexpr const char* kStarts[] = {"cold", "tracking"};

struct Row {
  const Entry* entry;
  std::string limits;
  int joints;
  ik::Start start;

  bool tracks() const { return start == ik::Start::previous; }
  std::string name() const {
    return fmt::format("{}/J{}/{}/{}", entry->name, joints, kStarts[tracks()], limits);
  }
};

bool holdsOneOf(const std::string& name, const std::string& alternatives) {
  std::istringstream parts(alternatives);
  for (std::string part; std::getline(parts, part, ',');) {
    if (name.find(part) != std::string::npos) return true;
  }
  return false;
}

bool matches(const std::string& name, const std::string& filter) {
  std::istringstream words(filter);
  for (std::string word; words >> word;) {
    if (!holdsOneOf(name, word)) return false;
  }
  return true;
}

bool isQuick(const Row& row) {
  return row.joints == 5 && (row.limits == "none" || row.limits == "cone60" || row.limits == "hinge");
}

// Those of a chain with the same targets stand together, and share them.
std::vector<Row> rowsOf(const SweepOptions& options) {
  std::vector<Row> rows;
  for (const std::string& limits : allLimits()) {
    for (const int joints : {3, 5, 10, 16}) {
      if (limits == "caliko" && joints != 10) continue;
      for (const ik::Start start : {ik::Start::rest, ik::Start::previous}) {
        for (const Entry& entry : allEntries()) {
          const Row row{&entry, limits, joints, start};
          if (!takes(entry, limits, joints) || !matches(row.name(), options.filter)) continue;
          if (!options.quick || isQuick(row)) rows.push_back(row);
        }
      }
    }
  }
  return rows;
}

// What rows of one chain and start share.
struct Ground {
  std::string limits;
  int joints;
  ik::Start start;
  baseline::Chain chain;
  baseline::Model model;
  validation::IkJudge judge;
  Targets targets;

  // A chain that turns freely about its base reaches what a free one does, and caliko's is asked that.
  Ground(const Row& row, uint32_t chains)
      : limits(row.limits),
        joints(row.joints),
        start(row.start),
        chain(chainWith(limits, joints)),
        model(chain),
        judge(validation::judgeOf(deviceChain(chain))),
        targets(made(chainWith(limits == "caliko" ? "none" : limits, joints), chains), chains) {}

  bool serves(const Row& row) const {
    return limits == row.limits && joints == row.joints && start == row.start;
  }

 private:
  std::vector<baseline::Rows> made(const baseline::Chain& asked, uint32_t chains) const {
    if (start == ik::Start::previous) return baseline::trackedTargets(asked, chains, kTicks, 2);
    return {baseline::coldTargets(asked, chains, 1)};
  }
};

// A contestant with what was measured of it so far.
class Run {
 public:
  Run(std::string name, std::unique_ptr<Contestant> contestant, const Ground& ground, bool wall)
      : name_(std::move(name)), contestant_(std::move(contestant)), ground_(ground), wall_(wall) {}

  const std::string& name() const { return name_; }
  const Quality& quality() const { return quality_; }

  // Compiles, warms up and judges.
  void prepare() {
    contestant_->aim(0);
    contestant_->solve();
    if (ground_.targets.rows.size() == 1) return judge();
    for (int i = 0; i < kSettle; ++i) advance();
    for (int i = 0; i < kJudged; ++i) {
      advance();
      judge();
    }
  }
  void calibrate(double leastSeconds) {
    solves_ = int(std::clamp(std::ceil(leastSeconds / std::max(counted(advance()), 1e-6)), 1.0, 1000.0));
  }
  void measure() {
    base::Seconds spent;
    for (int i = 0; i < solves_; ++i) spent += advance();
    samples_.push_back(counted(spent) / solves_);
    wallSamples_.push_back(spent.wall / solves_);
  }

  double seconds() const { return median(samples_); }  // a batch
  double wallSeconds() const { return median(wallSamples_); }
  double spread() const {  // half of the range, share of the median
    const auto [least, most] = std::minmax_element(samples_.begin(), samples_.end());
    return (*most - *least) / 2 / seconds();
  }

 private:
  static double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
  }
  double counted(const base::Seconds& spent) const { return wall_ ? spent.wall : spent.cpu; }

  void judge() {
    quality_.add(ground_.judge, ground_.targets.vectors[set_], ik::Options{}.tolerance,
                 contestant_->results());
  }
  base::Seconds advance() {
    const size_t sets = ground_.targets.rows.size();
    if (sets > 1) {
      if ((set_ == 0 && step_ < 0) || (set_ + 1 == sets && step_ > 0)) step_ = -step_;
      set_ = size_t(int(set_) + step_);
      contestant_->aim(set_);
    }
    return base::timed([&] { contestant_->solve(); });
  }

  std::string name_;
  std::unique_ptr<Contestant> contestant_;
  const Ground& ground_;
  bool wall_;
  size_t set_ = 0;
  int step_ = 1, solves_ = 1;
  Quality quality_;
  std::vector<double> samples_, wallSamples_;
};

// Empty if the results are what the solver claims.
std::string faultOf(const Entry& entry, const Quality& quality) {
  if (quality.worstReport > Quality::kSlip)
    return fmt::format("reports errors wrong by {:.2g}", quality.worstReport);
  if (keepsLengths(entry) && quality.worstLength > Quality::kSlip)
    return fmt::format("bones off by {:.2g}", quality.worstLength);
  if (keepsLimits(entry) && quality.worstLimit > kLimitSlip)
    return fmt::format("limits broken by {:.2g} rad", quality.worstLimit);
  if (quality.wrongStops > 0) return fmt::format("{} stops contradict the error", quality.wrongStops);
  return {};
}

nlohmann::ordered_json describe(const Run& run, uint32_t chains, bool timed) {
  const Quality& quality = run.quality();
  nlohmann::ordered_json stops;
  for (size_t i = 0; i < ik::stopNames.size(); ++i) stops[ik::stopNames[i]] = quality.stopShare(ik::Stop(i));
  nlohmann::ordered_json made = {{"solvedShare", quality.solvedShare()},
                                 {"meanIterations", quality.meanIterations()},
                                 {"p99Iterations", quality.p99Iterations()},
                                 {"meanError", quality.meanError()},
                                 {"worstLimitViolation", quality.worstLimit},
                                 {"worstBoneLengthError", quality.worstLength},
                                 {"stops", stops}};
  if (!timed) return made;
  made["solvesPerCoreSecond"] = chains / run.seconds();
  made["solvesPerWallSecond"] = chains / run.wallSeconds();
  made["spread"] = run.spread();
  return made;
}

void printHead() {
  fmt::print("{:<42}{:>24}   {:>15}{:>10}{:>16}{:>10}   {}\n", "", "M solves/core-second", "device/",
             "solved", "iterations", "limit", "stops on the device, %");
  fmt::print("{:<42}{:>8}{:>8}{:>8}   {:>8}{:>7}{:>10}{:>10}{:>6}{:>10}   {}\n", "row", "device", "scalar",
             "SIMD", "scalar", "SIMD", "%", "mean", "p99", "rad", "tolerance / cap / stall / unreachable");
}

void printRow(const std::string& name, const std::vector<Run>& runs, uint32_t chains) {
  const auto rate = [&](size_t i) {
    return i < runs.size() ? fmt::format("{:.3f}", chains / runs[i].seconds() / 1e6) : "-";
  };
  const auto ratio = [&](size_t i) {
    return i < runs.size() ? fmt::format("{:.2f}", runs[i].seconds() / runs[0].seconds()) : "-";
  };
  const Quality& quality = runs[0].quality();
  const auto stop = [&](ik::Stop which) { return 100 * quality.stopShare(which); };
  fmt::print(
      "{:<42}{:>8}{:>8}{:>8}   {:>8}{:>7}{:>10.3f}{:>10.2f}{:>6}{:>10.1e}   {:.1f} / {:.1f} / {:.1f} / "
      "{:.1f}\n",
      name, rate(0), rate(1), rate(2), ratio(1), ratio(2), 100 * quality.solvedShare(),
      quality.meanIterations(), quality.p99Iterations(), quality.worstLimit, stop(ik::Stop::tolerance),
      stop(ik::Stop::cap), stop(ik::Stop::stall), stop(ik::Stop::unreachable));
  std::fflush(stdout);
}

std::vector<Run> runsOf(Device& device, const Row& row, const Ground& ground, uint32_t chains) {
  const Task task{ground.chain, ground.model, ground.targets, chains, row.start};
  std::vector<Run> runs;
  runs.emplace_back("device", onDevice(device, task, *row.entry), ground, !isCpu(device.report()));
  if (row.entry->cpu) {
    runs.emplace_back("scalar", onCpu(task, *row.entry, false), ground, false);
    runs.emplace_back("simd", onCpu(task, *row.entry, true), ground, false);
  }
  return runs;
}

// False where a contestant's results do not hold.
bool runRow(Device& device, const Row& row, const Ground& ground, const SweepOptions& options,
            nlohmann::ordered_json& made) {
  std::vector<Run> runs = runsOf(device, row, ground, options.chains);
  std::string fault;
  for (Run& run : runs) {
    run.prepare();
    const std::string found = faultOf(*row.entry, run.quality());
    if (!found.empty()) fault = fmt::format("{}: {}", run.name(), found);
  }
  const bool holds = fault.empty();
  if (holds) {
    for (Run& run : runs) run.calibrate(options.leastSeconds);
    for (int i = 0; i < options.repetitions; ++i) {
      for (Run& run : runs) run.measure();
    }
    printRow(row.name(), runs, options.chains);
  } else {
    fmt::print("{:<40} NOT TIMED: {}\n", row.name(), fault);
    made["fault"] = fault;
  }
  for (const Run& run : runs) made[run.name()] = describe(run, options.chains, holds);
  if (holds && runs.size() == 3) {
    made["deviceOverScalar"] = runs[1].seconds() / runs[0].seconds();
    made["deviceOverSimd"] = runs[2].seconds() / runs[0].seconds();
  }
  return holds;
}

}  // namespace

Sweep runSweep(Device& device, const SweepOptions& options) {
  Sweep sweep;
  std::unique_ptr<Ground> ground;
  printHead();
  for (const Row& row : rowsOf(options)) {
    if (!ground || !ground->serves(row)) ground = std::make_unique<Ground>(row, options.chains);
    nlohmann::ordered_json made = {{"row", row.name()},
                                   {"solver", row.entry->name},
                                   {"joints", row.joints},
                                   {"start", kStarts[row.tracks()]},
                                   {"limits", row.limits}};
    if (!runRow(device, row, *ground, options, made)) ++sweep.failed;
    sweep.rows.push_back(std::move(made));
  }
  return sweep;
}

}  // namespace skitter::bench
