#include "bench/crowd/contestant.h"

#include <fmt/format.h>

#include <algorithm>

#include "bench/cpu_crowd/crowd.h"
#include "crowd/readback.h"
#include "shared/ik_batch.h"
#include "validation/herd_facts.h"

namespace skitter::bench {
namespace {

class DeviceContestant : public Contestant {
 public:
  DeviceContestant(Device& device, Crowd& crowd, float dt)
      : crowd_(crowd), ring_(device.context()), dt_(dt) {}

  std::string name() const override { return "device"; }
  int threads() const override { return 0; }
  void tick() override {
    crowd_.record(ring_.begin(), dt_);
    ring_.submit();
    if (!timed_) return;
    finish();
    for (const StageTime& time : crowd_.stageTimes()) add(times_, time.stage, time.milliseconds);
  }
  HerdState state(uint32_t run, const AgentSample& sample) const override {
    return crowd::download(implOf(crowd_), *crowd::allRuns(implOf(crowd_))[run].run, sample);
  }
  void finish() override { ring_.waitAll(); }
  void timeStages(bool on) override {
    finish();
    crowd_.timeStages(on);
    timed_ = on;
  }
  std::vector<StageTime> stageTimes() const override { return times_; }

 private:
  Crowd& crowd_;
  bool timed_ = true;
  gpu::CommandRing ring_;
  float dt_;
  std::vector<StageTime> times_;
};

class CpuContestant : public Contestant {
 public:
  CpuContestant(const Crowd& crowd, const cpu_crowd::Options& options)
      : options_(options), tick_(crowd.tick()) {
    const Crowd::Impl& impl = implOf(crowd);
    for (const crowd::HerdRun& of : crowd::allRuns(impl))
      runs_.push_back(std::make_unique<cpu_crowd::CpuCrowd>(validation::herdFacts(impl, of),
                                                            crowd::download(impl, *of.run), options));
  }

  std::string name() const override {
    return fmt::format("CPU {}, {} thread{}", options_.width == cpu_crowd::Width::simd ? "SIMD" : "scalar",
                       options_.threads, options_.threads == 1 ? "" : "s");
  }
  int threads() const override { return options_.threads; }
  void tick() override {
    ++tick_;
    for (const auto& run : runs_) run->tick(tick_);
  }
  HerdState state(uint32_t run, const AgentSample& sample) const override {
    return validation::sampled(runs_[run]->state(), sample);
  }
  void timeStages(bool on) override {
    for (const auto& run : runs_) run->timeStages(on);
  }
  std::vector<StageTime> stageTimes() const override {
    std::vector<StageTime> times;
    for (const auto& run : runs_)
      for (const cpu_crowd::StageSeconds& stage : run->stageSeconds())
        add(times, stage.stage, 1e3 * stage.seconds);
    return times;
  }

 private:
  cpu_crowd::Options options_;
  uint64_t tick_;
  std::vector<std::unique_ptr<cpu_crowd::CpuCrowd>> runs_;
};

}  // namespace

std::unique_ptr<Contestant> deviceContestant(Device& device, Crowd& crowd, float dt) {
  return std::make_unique<DeviceContestant>(device, crowd, dt);
}

std::unique_ptr<Contestant> cpuContestant(const Crowd& crowd, bool scalar, int threads, bool poses) {
  cpu_crowd::Options options;
  options.width = scalar ? cpu_crowd::Width::scalar : cpu_crowd::Width::simd;
  options.threads = threads;
  options.poses = poses;
  return std::make_unique<CpuContestant>(crowd, options);
}

std::string opponentBuild() { return cpu_crowd::buildDescription(); }

bool hasCpuContestant(const Crowd& crowd) {
  return std::all_of(implOf(crowd).kinds.begin(), implOf(crowd).kinds.end(), [](const crowd::Kind& kind) {
    return kind.controller == Controller::clip ||
           (kind.controller == Controller::adaptive && kind.ik.solver == shared::SOLVER_FABRIK &&
            kind.ik.polish > 0 && !kind.reachTriggered);
  });
}

}  // namespace skitter::bench
