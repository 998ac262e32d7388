#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>

#include "app/commands.h"
#include "app/common/manifest.h"
#include "app/common/signals.h"
#include "app/run/obstacle.h"
#include "app/run/offscreen.h"
#include "app/run/run_options.h"
#include "app/run/run_outputs.h"
#include "app/run/summary.h"
#include "app/viewer/viewer.h"
#include "app/viewer/window.h"
#include "base/clock.h"
#include "skitter/crowd.h"
#include "skitter/error.h"

namespace skitter::app {
namespace {

std::vector<MemoryUse> memoryOf(const Crowd& crowd) {
  std::vector<MemoryUse> sums;
  for (uint32_t h = 0; h < crowd.herdCount(); ++h)
    for (const MemoryUse& use : crowd.memoryUse(h)) {
      const auto same =
          std::find_if(sums.begin(), sums.end(), [&](const MemoryUse& s) { return s.name == use.name; });
      if (same == sums.end())
        sums.push_back(use);
      else
        same->bytes += use.bytes;
    }
  return sums;
}

void failOnValidation(const Device& device) {
  const std::vector<ValidationMessage> messages = device.validationMessages();
  if (messages.empty()) return;
  for (const ValidationMessage& message : messages)
    fmt::print(stderr, "{} x {}\n", message.count, message.text);
  throw Error(Error::Kind::check, fmt::format("the validation layer has {} complaints", messages.size()));
}

// From the options to the files: start, simulate, finish.
class Run {
 public:
  // Reads and checks what needs no device. The options must outlive it.
  explicit Run(const RunOptions& options);

  void start();
  void simulate();
  void finish();

 private:
  using Clock = std::chrono::steady_clock;

  void raiseObstacle();
  void afterTick();
  void restart(std::optional<Controller> controller);
  void runWindow();
  std::string stopped() const;
  nlohmann::ordered_json unfinished() const;

  const Clock::time_point began_ = Clock::now();
  const RunOptions& options_;
  const OutTarget target_;
  const bool windowed_;
  Scene scene_;
  Files files_;
  std::optional<uint64_t> ticks_;  // none where a window runs until it is closed
  Summary summary_;
  // Declared before and gone after what they are written from: a deadline may find them until the end.
  RunOutputs outputs_;
  std::atomic<uint64_t> done_ = 0;  // ticks
  Manifest manifest_;
  Heightfield terrain_;
  std::optional<Window> window_;
  std::optional<Device> device_;
  std::optional<Crowd> crowd_;
  StopDeadline::Leave leave_;  // completes the files
  std::optional<Obstacle> obstacle_;
};

Run::Run(const RunOptions& options)
    : options_(options),
      target_(parseOut(options.out)),
      windowed_(options.windowed(target_)),
      outputs_(options) {
  options.check(target_, windowed_);
  scene_ = options.load();
  files_ = options.files(target_, scene_);
  files_.check();
  if (!windowed_ || options.frames) ticks_ = options.framesWithoutWindow() * options.ticksPerFrame;
  summary_.seed = scene_.seed;
  summary_.wantedTicks = ticks_;
  summary_.agents = scene_.agentCount();
  manifest_ = {.scene = &scene_, .dt = options.scene.dt};
}

std::string Run::stopped() const {
  return ticks_ ? interruptedAfter(done_, *ticks_, "ticks")
                : fmt::format("interrupted after {} ticks", done_.load());
}

// Without figures: the device, which has them, is at work.
nlohmann::ordered_json Run::unfinished() const {
  return {{"agents", summary_.agents},
          {"ticks", done_.load()},
          {"ticksWanted", orNull(summary_.wantedTicks)},
          {"seed", summary_.seed},
          {"interrupted", true}};
}

void Run::start() {
  std::optional<StopDeadline> starting(std::in_place, [this, manifest = manifest_] {
    if (!options_.json.empty()) writeJson(options_.json, unfinished(), manifest);
    return stopped();
  });
  terrain_ = scene_.loadTerrain();
  DeviceRequest request = options_.deviceRequest();
  if (windowed_) {
    window_.emplace(options_.size);
    request.presentation = true;
    request.instanceExtensions = window_->instanceExtensions();
  }
  device_ = Device::create(request);
  crowd_.emplace(*device_, terrain_, scene_, options_.crowdOptions(target_, windowed_));
  starting.reset();
  manifest_.terrain = &terrain_;
  manifest_.add(device_->report());

  outputs_.expect(files_, target_, *crowd_, scene_, terrain_, ticks_);
  outputs_.open(target_, *crowd_, scene_);
  leave_ = [this] {
    outputs_.finish(*crowd_, terrain_, done_, unfinished(), manifest_);
    return stopped();
  };
  raiseObstacle();

  summary_.startSeconds = std::chrono::duration<double>(Clock::now() - began_).count();
  summary_.startCpuSeconds = base::processSeconds();
  summary_.device = device_->report().name;
  summary_.terrain = describe(terrain_);
  summary_.filledVoids = terrain_.filledVoids;
  summary_.cpuTold = !windowed_ && !target_.isEveryFrame();
}

void Run::raiseObstacle() {
  if (options_.obstacle && !scene_.herds.empty()) obstacle_.emplace(*crowd_);
}

void Run::afterTick() {
  outputs_.append(*crowd_);
  if (obstacle_) obstacle_->move(*crowd_, static_cast<double>(crowd_->tick()) * options_.scene.dt);
  done_ = crowd_->tick();
}

void Run::restart(std::optional<Controller> controller) {
  Scene next = scene_;
  for (Herd& herd : next.herds)
    if (controller) herd.controller = *controller;
  *crowd_ = Crowd(*device_, terrain_, next, options_.crowdOptions(target_, windowed_));
  scene_ = std::move(next);
  raiseObstacle();
}

void Run::runWindow() {
  const WindowRun run{.device = *device_,
                      .crowd = *crowd_,
                      .scene = scene_,
                      .dt = static_cast<float>(options_.scene.dt),
                      .ticks = ticks_.value_or(UINT64_MAX),
                      .ticksPerFrame = options_.ticksPerFrame,
                      .paused = options_.paused,
                      .timings = options_.timings,
                      .afterTick = [this] { afterTick(); },
                      .leave = leave_,
                      .restart = [this](std::optional<Controller> controller) { restart(controller); },
                      .unbroken = outputs_.unbroken()};
  summary_.frames = runInWindow(*window_, run, summary_.times);
}

void Run::simulate() {
  if (windowed_) return runWindow();
  Offscreen offscreen(options_, target_, scene_, *device_, *crowd_, outputs_.pictures(), leave_);
  offscreen.run(
      *ticks_, [this] { afterTick(); }, summary_);
}

void Run::finish() {
  {
    const StopDeadline deadline(leave_);
    summary_.ticks = crowd_->tick();
    summary_.interrupted = stopRequested() && (!ticks_ || summary_.ticks < *ticks_);
    summary_.watchEvery = crowd_->watchEvery();
    summary_.fidelity = crowd_->fidelity();
    for (uint32_t h = 0; h < crowd_->herdCount(); ++h)
      summary_.herds.push_back({crowd_->rig(h).name, scene_.herds[h].agents, crowd_->fidelity(h)});
    if (options_.sleep) summary_.sleeping = crowd_->sleeping();
    summary_.stateHash = crowd_->stateHash();
    summary_.memory = memoryOf(*crowd_);
  }
  summary_.files = outputs_.finish(*crowd_, terrain_, summary_.ticks, summary_.json(), manifest_);
  summary_.print();
  failOnValidation(*device_);
  if (summary_.interrupted) throw Interrupted(stopped());
}

int runScene(const RunOptions& options) {
  Run run(options);
  run.start();
  run.simulate();
  run.finish();
  return 0;
}

}  // namespace

void addRun(CLI::App& app, Command& chosen) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* command = app.add_subcommand(
      "run",
      "Simulate a scene: in a window where there is a display, into pictures with --out, or just measured");
  options->addTo(*command);
  command->callback([options, &chosen] { chosen = [options] { return runScene(*options); }; });
}

}  // namespace skitter::app
