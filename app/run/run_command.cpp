#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <exception>
#include <memory>
#include <optional>
#include <set>
#include <utility>

#include "app/commands.h"
#include "app/common/law_watch.h"
#include "app/common/manifest.h"
#include "app/common/scene_options.h"
#include "app/common/signals.h"
#include "app/common/warnings.h"
#include "app/run/damage_watch.h"
#include "app/run/forage_log.h"
#include "app/run/obstacle.h"
#include "app/run/offscreen.h"
#include "app/run/run_note.h"
#include "app/run/run_options.h"
#include "app/run/run_outputs.h"
#include "app/run/summary.h"
#include "app/viewer/viewer.h"
#include "app/viewer/window.h"
#include "base/clock.h"
#include "crowd/herd.h"
#include "skitter/crowd.h"
#include "skitter/error.h"
#include "skitter/state.h"

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

// The number of the first event by which herds come or go.
std::optional<size_t> firstHerdEvent(const Scene& scene) {
  for (size_t e = 0; e < scene.events.size(); ++e) {
    const auto& what = scene.events[e].what;
    if (std::holds_alternative<HerdAddition>(what) || std::holds_alternative<HerdRemoval>(what)) return e;
  }
  return {};
}

void refuseTraceOfComers(const RunOptions& options, const Scene& scene) {
  if (options.trace.empty()) return;
  if (const std::optional<size_t> event = firstHerdEvent(scene))
    throw inputError(
        fmt::format("--trace {}: events[{}] of {} adds or removes a herd, expected the same herds from the "
                    "first tick to the last",
                    options.trace, *event, scene.name));
}

// From the options to the files: start, simulate, finish.
class Run {
 public:
  // Reads and checks what needs no device.
  explicit Run(RunOptions options);

  void start();
  void simulate();
  void finish();

 private:
  using Clock = std::chrono::steady_clock;

  void raiseObstacle();
  void watchCrowding();
  void watchDamage();
  void watchLaws();
  bool watchesDamage() const { return !options_.json.empty() && DamageWatch::isOf(scene_); }
  CrowdOptions crowdOptions() const;
  void tellWhoCannotReach(uint32_t herd, uint32_t count);
  void afterTick();
  void save();
  void restart(std::optional<Controller> controller);
  void runWindow();
  std::string stopped() const;
  nlohmann::ordered_json unfinished() const;

  const Clock::time_point began_ = Clock::now();
  RunOptions options_;
  const OutTarget target_;
  const bool windowed_;
  Scene scene_;
  Files files_;
  std::optional<uint64_t> ticks_;  // none where a window runs until it is closed
  Summary summary_;
  // Declared before and gone after what they are written from: a deadline may find them until the end.
  RunOutputs outputs_;
  ForageLog foraging_;
  std::atomic<uint64_t> done_ = 0;     // ticks
  std::atomic<int64_t> savedAt_ = -1;  // the tick of the state that lies in its file; -1: none does
  std::optional<State> state_;         // that the run goes on from
  RunNote note_;                       // its note
  Manifest manifest_;
  Heightfield terrain_;
  std::optional<Window> window_;
  std::optional<Device> device_;
  std::optional<Crowd> crowd_;
  StopDeadline::Leave leave_;  // completes the files
  std::optional<Obstacle> obstacle_;
  std::optional<CrowdingWatch> crowdingWatch_;
  std::set<uint32_t> toldOf_;  // herds of which it was said that somebody cannot reach the goal
  std::optional<DamageWatch> damageWatch_;
  std::optional<LawWatch> lawWatch_;
};

Run::Run(RunOptions options)
    : options_(std::move(options)),
      target_(parseOut(options_.out)),
      windowed_(options_.windowed(target_)),
      outputs_(options_) {
  if (!options_.resume.empty()) {
    state_ = loadState(options_.resume);
    note_ = RunNote::of(*state_, options_.resume);
    options_.adopt(*state_, note_, windowed_);
    summary_.resumedAt = state_->tick;
  }
  options_.check(target_, windowed_);
  scene_ = options_.load(state_ ? &note_.sceneOf(*state_) : nullptr);
  refuseTraceOfComers(options_, scene_);
  files_ = options_.files(target_, scene_);
  files_.check();
  if (!windowed_ || options_.frames) ticks_ = options_.framesWithoutWindow() * options_.ticksPerFrame;
  summary_.seed = scene_.seed;
  summary_.wantedTicks = ticks_;
  summary_.agents = scene_.agentCount();
  manifest_ = {.scene = &scene_, .dt = options_.scene.dt};
  // Events have edited the terrain that the state has.
  if (state_ && note_.manifest.contains("sceneHash") && note_.manifest.at("sceneHash").is_string())
    manifest_.sceneHashBefore = note_.manifest.at("sceneHash").get<std::string>();
}

std::string Run::stopped() const {
  const std::string text = ticks_ ? interruptedAfter(done_, *ticks_, "ticks")
                                  : fmt::format("interrupted after {} ticks", done_.load());
  const auto saved = savedAt_.load();
  if (options_.save.empty() || saved == static_cast<int64_t>(done_.load())) return text;
  return text + (saved < 0 ? "; no state is saved" : fmt::format("; the state is of tick {}", saved));
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
  const ModelWarnings warnings;
  terrain_ = state_ ? state_->terrain : scene_.loadTerrain();
  DeviceRequest request = options_.deviceRequest();
  if (windowed_) {
    window_.emplace(options_.size);
    request.presentation = true;
    request.instanceExtensions = window_->instanceExtensions();
  }
  device_ = Device::create(request);
  if (state_) {
    state_->options = crowdOptions();
    state_->scene.camera = scene_.camera;
    state_->scene.light = scene_.light;
    crowd_.emplace(*device_, *state_);
    done_ = state_->tick;
    state_->source.reset();  // which keeps the file open
    if (options_.obstacle) obstacle_.emplace(*crowd_, note_.obstacle);
    if (obstacle_) terrain_ = obstacle_->groundWithout();
  } else {
    crowd_.emplace(*device_, terrain_, scene_, crowdOptions());
    raiseObstacle();
  }
  for (uint32_t h = 0; h < crowd_->herdCount(); ++h) tellWhoCannotReach(h, crowd_->cannotReach(h));
  foraging_ = ForageLog(*crowd_);
  watchCrowding();
  watchDamage();
  watchLaws();
  starting.reset();
  manifest_.terrain = &terrain_;
  manifest_.add(device_->report());

  outputs_.expect(files_, target_, *crowd_, terrain_, ticks_);
  outputs_.open(target_, *crowd_, manifest_);
  leave_ = [this] {
    outputs_.finish(*crowd_, terrain_, done_, unfinished(), manifest_);
    return stopped();
  };

  summary_.startSeconds = std::chrono::duration<double>(Clock::now() - began_).count();
  summary_.startCpuSeconds = base::processSeconds();
  summary_.device = device_->report().name;
  summary_.terrain = app::describe(terrain_);
  summary_.filledVoids = terrain_.filledVoids;
  summary_.cpuTold = !windowed_ && !target_.isEveryFrame();
}

void Run::raiseObstacle() {
  if (options_.obstacle && !scene_.herds.empty()) obstacle_.emplace(*crowd_);
}

void Run::watchCrowding() {
  if (options_.crowding) crowdingWatch_.emplace(*crowd_, options_.scene.dt);
}

void Run::watchLaws() {
  lawWatch_.reset();
  if (!options_.unjudged) lawWatch_.emplace(*crowd_, scene_, options_.scene.dt);
}

CrowdOptions Run::crowdOptions() const {
  CrowdOptions asked = options_.crowdOptions(target_, scene_, windowed_);
  if (watchesDamage()) asked.feet = true;
  return asked;
}

void Run::watchDamage() {
  damageWatch_.reset();
  if (!watchesDamage()) return;
  if (summary_.resumedAt)
    damageWatch_.emplace(*device_, scene_, options_.scene.dt);
  else
    damageWatch_.emplace(*device_, terrain_, scene_, crowdOptions(), options_.scene.dt, obstacle_);
}

// Once for each herd: as the run begins or, where it is so only then, as it ends.
void Run::tellWhoCannotReach(uint32_t herd, uint32_t count) {
  if (count == 0 || !toldOf_.insert(herd).second) return;
  fmt::print(stderr,
             "skitter: herd {}: no way leads {} of {} agents to their goals; they stop at the nearest places "
             "that one leads to\n",
             herd, count, crowd_->agentCount(herd));
}

void Run::afterTick() {
  outputs_.append(*crowd_);
  foraging_.append(*crowd_, options_.scene.dt);
  if (crowdingWatch_) crowdingWatch_->look(*crowd_);
  if (damageWatch_) damageWatch_->look(*crowd_);
  if (lawWatch_) lawWatch_->look(*crowd_);
  if (obstacle_) obstacle_->move(*crowd_, static_cast<double>(crowd_->tick()) * options_.scene.dt);
  done_ = crowd_->tick();
  if (options_.saveEvery && crowd_->tick() % (*options_.saveEvery * options_.ticksPerFrame) == 0) save();
}

// Saves the crowd as it is between two ticks. The obstacle is already where the next one finds it.
void Run::save() {
  const auto tick = static_cast<int64_t>(crowd_->tick());
  if (options_.save.empty() || savedAt_ == tick) return;
  RunNote note;
  note.dt = options_.scene.dt;
  note.ticksPerFrame = options_.ticksPerFrame;
  note.manifest = manifest_.json();
  if (firstHerdEvent(scene_)) note.scene = scene_;
  if (ticks_) note.frames = *ticks_ / options_.ticksPerFrame;
  if (obstacle_) note.obstacle = obstacle_->json();
  crowd_->save(options_.save, note.text());
  savedAt_ = tick;
}

void Run::restart(std::optional<Controller> controller) {
  Scene next = scene_;
  for (Herd* herd : herdsOf(next))
    if (controller) herd->controller = *controller;
  *crowd_ = Crowd(*device_, terrain_, next, crowdOptions());
  scene_ = std::move(next);
  manifest_.sceneHashBefore.clear();
  savedAt_ = -1;
  summary_.resumedAt.reset();
  raiseObstacle();
  foraging_ = ForageLog(*crowd_);
  watchCrowding();
  watchDamage();
  watchLaws();
}

void Run::runWindow() {
  const WindowRun run{.device = *device_,
                      .crowd = *crowd_,
                      .scene = scene_,
                      .dt = static_cast<float>(options_.scene.dt),
                      .ticks = ticks_.value_or(UINT64_MAX),
                      .ticksPerFrame = options_.ticksPerFrame,
                      .drawing = options_.drawing,
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
  // First, and without a deadline: a state is worth the wait. Where it fails, the other files are still
  // written.
  std::exception_ptr fault;
  try {
    save();
  } catch (const Error&) {
    fault = std::current_exception();
  }
  {
    const StopDeadline deadline(leave_);
    summary_.ticks = crowd_->tick();
    summary_.interrupted = stopRequested() && (!ticks_ || summary_.ticks < *ticks_);
    summary_.watchEvery = crowd_->watchEvery();
    summary_.fidelity = crowd_->fidelity();
    for (uint32_t h = 0; h < crowd_->herdCount(); ++h)
      if (const crowd::Herd& herd = implOf(*crowd_).herds[h]; !herd.isGone()) {
        const uint32_t cannotReach = crowd_->cannotReach(h);
        tellWhoCannotReach(h, cannotReach);
        summary_.herds.push_back(
            {h, crowd_->rig(h).name, herd.from.agents, cannotReach, crowd_->fidelity(h)});
      }
    summary_.crowding = crowd_->crowding();
    summary_.foraging = foraging_.figures(*crowd_, options_.scene.dt);
    summary_.reactions = reactionFigures(*crowd_);
    summary_.searches = searchFigures(*crowd_);
    if (crowdingWatch_) summary_.jams = crowdingWatch_->jams();
    if (damageWatch_) summary_.damage = damageWatch_->figures();
    if (lawWatch_) {
      summary_.warnings = brokenOf(lawWatch_->figures());
      if (options_.timings) summary_.lawSeconds = lawWatch_->cpuSeconds();
    }
    summary_.levels = crowd_->levels();
    if (options_.sleep) summary_.sleeping = crowd_->sleeping();
    summary_.stateHash = crowd_->stateHash();
    summary_.memory = memoryOf(*crowd_);
  }
  summary_.files = outputs_.finish(*crowd_, terrain_, summary_.ticks, summary_.json(), manifest_);
  if (savedAt_ >= 0)
    summary_.files.push_back(fmt::format("{}: the state at tick {}", options_.save, savedAt_.load()));
  summary_.print();
  if (summary_.warnings) warnOf(*summary_.warnings);
  if (fault) std::rethrow_exception(fault);
  failOnValidation(*device_);
  if (summary_.interrupted) throw Interrupted(stopped());
  if (options_.strict) refuseBroken(*summary_.warnings);
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
