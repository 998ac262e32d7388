#include "bench/ik/contestant.h"

namespace skitter::bench {
namespace {

ik::Options deviceOptions(const Task& task, const Entry& entry) {
  ik::Options options;
  options.solver = entry.device;
  options.start = task.start;
  options.restarts = entry.restarts;
  return options;
}

class OnDevice : public Contestant {
 public:
  OnDevice(Device& device, const Task& task, const Entry& entry)
      : task_(task), batch_(device, deviceChain(task.chain), task.chains, deviceOptions(task, entry)) {}

  void aim(size_t set) override { batch_.setTargets(task_.targets.vectors[set]); }
  void solve() override { batch_.solve(); }
  Results results() const override { return {batch_.downloadJoints(), batch_.downloadReports()}; }

 private:
  Task task_;
  ik::Batch batch_;
};

ik::Stop stopOf(baseline::Stop stop) {
  switch (stop) {
    case baseline::Stop::tolerance:
      return ik::Stop::tolerance;
    case baseline::Stop::cap:
      return ik::Stop::cap;
    case baseline::Stop::stall:
      return ik::Stop::stall;
    case baseline::Stop::unreachable:
      return ik::Stop::unreachable;
    case baseline::Stop::skipped:
      return ik::Stop::skipped;
  }
  return ik::Stop::skipped;
}

class OnCpu : public Contestant {
 public:
  OnCpu(const Task& task, const Entry& entry, bool simd)
      : task_(task), simd_(simd), batch_(task.model, task.chains) {
    // The same iterations at most, and the same tolerance, as the engine has unless told.
    const ik::Options shipped = deviceOptions(task, entry);
    options_.solver = *entry.cpu;
    options_.tolerance = shipped.tolerance;
    options_.iterations = int(ik::defaultIterations(deviceChain(task.chain), shipped));
    options_.restPull = ik::restPullOf(deviceChain(task.chain), shipped);
  }

  void aim(size_t set) override { batch_.target = task_.targets.rows[set]; }
  void solve() override {
    simd_ ? baseline::solveSimd(task_.model, options_, batch_)
          : baseline::solveScalar(task_.model, options_, batch_);
    // The first solve begins at rest, as the device's does.
    if (task_.start == ik::Start::previous) options_.start = baseline::Start::previous;
  }
  Results results() const override {
    Results made;
    for (size_t c = 0; c < batch_.chains; ++c) {
      made.joints.emplace_back(0.0f);
      for (int i = 0; i < task_.model.bones; ++i) {
        made.joints.emplace_back(batch_.joints.at(3 * i, c), batch_.joints.at(3 * i + 1, c),
                                 batch_.joints.at(3 * i + 2, c));
      }
      made.reports.push_back({batch_.error(c), uint32_t(batch_.iterations(c)), stopOf(batch_.stop(c))});
    }
    return made;
  }

 private:
  Task task_;
  bool simd_;
  baseline::Options options_;
  baseline::Batch batch_;
};

}  // namespace

std::unique_ptr<Contestant> onDevice(Device& device, const Task& task, const Entry& entry) {
  return std::make_unique<OnDevice>(device, task, entry);
}

std::unique_ptr<Contestant> onCpu(const Task& task, const Entry& entry, bool simd) {
  return std::make_unique<OnCpu>(task, entry, simd);
}

}  // namespace skitter::bench
