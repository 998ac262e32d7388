#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>

#include "clock.h"
#include "commands.h"
#include "footfall_log.h"
#include "gpu/submit.h"
#include "obstacle.h"
#include "part_file.h"
#include "pictures.h"
#include "progress.h"
#include "scene_options.h"
#include "signals.h"
#include "simulate.h"
#include "skitter/crowd.h"
#include "skitter/error.h"
#include "skitter/renderer.h"
#include "summary.h"
#include "trace.h"
#include "values.h"
#include "window.h"

namespace skitter::app {
namespace {

constexpr uint64_t headlessFrames = 300;
constexpr uint64_t maxFrames = 100000000, maxTicksPerFrame = 1000, maxWatchEvery = 1000000;

struct RunOptions {
  SceneOptions scene;
  std::optional<uint64_t> frames;
  uint64_t ticksPerFrame = 1;
  uint32_t watchEvery = 0;
  Size size{1280, 720};
  std::string view, out, json, trace, footfalls;
  bool poses = false, unmeasured = false;
  bool headless = false, force = false, obstacle = false, timings = false, validation = false, quiet = false,
       sleep = false;
};

Camera cameraOf(const RunOptions& options, Camera camera) {
  if (options.view.empty()) return camera;
  camera.kind = Camera::Kind::follow;
  camera.distance = options.view == "close" ? 3.5f : (options.view == "crowd" ? 9.0f : 30.0f);
  return camera;
}

// Simulates, and draws where pictures are wanted, without a window.
class Offscreen {
 public:
  Offscreen(const RunOptions& options, const OutTarget& target, const Scene& scene, Device& device,
            Crowd& crowd)
      : options_(options), target_(target), scene_(scene), crowd_(crowd), ring_(device.context()) {
    if (target.kind == OutTarget::Kind::none) return;
    renderer_.emplace(device, crowd, options.size.width, options.size.height);
    pictures_.emplace(target, options.size.width, options.size.height,
                      1.0 / (options.scene.dt * static_cast<double>(options.ticksPerFrame)));
  }

  void run(uint64_t ticks, const std::function<void()>& afterTick, Summary& summary) {
    Progress progress("ticks", ticks, options_.quiet);
    while (crowd_.tick() < ticks && !stopRequested()) {
      runTick(ring_, crowd_, static_cast<float>(options_.scene.dt), summary.times);
      afterTick();
      if (target_.isEveryFrame() && crowd_.tick() % options_.ticksPerFrame == 0) draw(summary);
      progress.update(crowd_.tick());
    }
    if (target_.kind == OutTarget::Kind::picture) draw(summary);
  }

  std::vector<std::string> finish() { return pictures_ ? pictures_->finish() : std::vector<std::string>{}; }

 private:
  void draw(Summary& summary) {
    const double seconds = static_cast<double>(crowd_.tick()) * options_.scene.dt;
    renderer_->record(ring_.begin(), viewOf(scene_, crowd_, seconds));
    ring_.wait(ring_.submit());
    pictures_->add(renderer_->download());
    ++summary.frames;
  }

  const RunOptions& options_;
  const OutTarget& target_;
  const Scene& scene_;
  Crowd& crowd_;
  gpu::CommandRing ring_;
  std::optional<Renderer> renderer_;
  std::optional<Pictures> pictures_;
};

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

int run(const RunOptions& options) {
  const auto began = std::chrono::steady_clock::now();
  const OutTarget target = parseOut(options.out);
  if (!options.json.empty()) checkFileTarget("--json", options.json);
  if (!options.trace.empty()) checkFolderTarget("--trace", options.trace);
  if (!options.footfalls.empty()) checkFileTarget("--footfalls", options.footfalls);
  const bool windowed = !options.headless && target.kind == OutTarget::Kind::none && hasDisplay();
  if (target.kind == OutTarget::Kind::video && options.frames == 0u) {
    throw inputError(fmt::format("--out {}: a video needs at least one frame, --frames is 0", options.out));
  }
  if (windowed && !options.trace.empty() && !options.frames) {
    throw inputError("--trace needs --frames where a window runs until it is closed");
  }
  Scene scene = options.scene.load();
  scene.camera = cameraOf(options, scene.camera);
  const Heightfield terrain = scene.loadTerrain();

  DeviceRequest request;
  request.device = options.scene.device;
  request.validation = options.validation;
  std::optional<Window> window;
  if (windowed) {
    window.emplace(options.size);
    request.presentation = true;
    request.instanceExtensions = window->instanceExtensions();
  }
  Device device = Device::create(request);
  CrowdOptions crowdOptions;
  crowdOptions.timestamps = options.timings;
  crowdOptions.measure = !options.unmeasured;
  crowdOptions.watchEvery = options.watchEvery;
  crowdOptions.sleep = options.sleep;
  crowdOptions.feet = !options.trace.empty();
  if (!options.footfalls.empty()) crowdOptions.footfalls = UINT32_MAX;  // all that can be
  crowdOptions.pose =
      options.poses || windowed || target.kind != OutTarget::Kind::none || !options.trace.empty();
  Crowd crowd(device, terrain, scene, crowdOptions);

  const uint64_t ticks = windowed && !options.frames
                             ? UINT64_MAX
                             : options.frames.value_or(headlessFrames) * options.ticksPerFrame;
  std::optional<Trace> trace;
  if (!options.trace.empty())
    trace.emplace(options.trace, crowd, scene, static_cast<float>(options.scene.dt), ticks, options.force);
  std::optional<Obstacle> obstacle;
  if (options.obstacle && !scene.herds.empty()) obstacle.emplace(crowd);
  std::optional<FootfallLog> footfalls;
  if (!options.footfalls.empty()) footfalls.emplace(options.footfalls);
  const auto afterTick = [&] {
    if (trace) trace->append(crowd);
    if (footfalls) footfalls->append(crowd);
    if (obstacle) obstacle->move(crowd, static_cast<double>(crowd.tick()) * options.scene.dt);
  };

  Summary summary;
  summary.startSeconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  summary.startCpuSeconds = processSeconds();
  summary.device = device.report().name;
  summary.terrain = fmt::format("{}, {} x {} samples, {:.6g} x {:.6g} m", terrain.name, terrain.columns,
                                terrain.rows, terrain.extentX(), terrain.extentZ());
  summary.filledVoids = terrain.filledVoids;
  summary.agents = crowd.agentCount();
  summary.seed = scene.seed;
  summary.cpuTold = !windowed && !target.isEveryFrame();
  if (windowed) {
    const WindowRun windowRun{
        device, crowd, scene, static_cast<float>(options.scene.dt), ticks, options.ticksPerFrame, afterTick};
    summary.frames = runInWindow(*window, windowRun, summary.times);
  } else {
    Offscreen offscreen(options, target, scene, device, crowd);
    offscreen.run(ticks, afterTick, summary);
    summary.files = offscreen.finish();
    summary.wantedTicks = ticks;
  }
  summary.ticks = crowd.tick();
  summary.watchEvery = crowd.watchEvery();
  summary.fidelity = crowd.fidelity();
  for (uint32_t h = 0; h < crowd.herdCount(); ++h)
    summary.herds.push_back({crowd.rig(h).name, scene.herds[h].agents, crowd.fidelity(h)});
  if (options.sleep) summary.sleeping = crowd.sleeping();
  summary.stateHash = crowd.stateHash();
  summary.memory = memoryOf(crowd);
  if (trace) {
    trace->finish(crowd, terrain);
    summary.files.push_back(
        fmt::format("{}: {} ticks of {} herds", options.trace, summary.ticks, crowd.herdCount()));
  }
  if (footfalls) {
    footfalls->finish();
    summary.files.push_back(fmt::format("{}: {} footfalls", options.footfalls, footfalls->count()));
  }
  if (!options.json.empty()) {
    writeText(options.json, summary.json().dump(2) + "\n");
    summary.files.push_back(options.json);
  }
  summary.print();
  failOnValidation(device);
  return 0;
}

void addNumbers(CLI::App& command, RunOptions& options) {
  command
      .add_option_function<std::string>(
          "--frames",
          [&options](const std::string& text) {
            options.frames = parseWhole("--frames", text, 0, maxFrames);
          },
          fmt::format("frames to run [{}; a window runs until it is closed]", headlessFrames))
      ->type_name("N");
  command
      .add_option_function<std::string>(
          "--ticks-per-frame",
          [&options](const std::string& text) {
            options.ticksPerFrame = parseWhole("--ticks-per-frame", text, 1, maxTicksPerFrame);
          },
          "simulation steps from one frame to the next [1]")
      ->type_name("N");
  command
      .add_option_function<std::string>(
          "--watch-every",
          [&options](const std::string& text) {
            options.watchEvery = static_cast<uint32_t>(parseWhole("--watch-every", text, 1, maxWatchEvery));
          },
          "measure one agent of every N at a time [1 up to 256 agents, else 64]")
      ->type_name("N");
  command
      .add_option_function<std::string>(
          "--size", [&options](const std::string& text) { options.size = parseSize("--size", text); },
          "of the window or the pictures, in pixels [1280x720]")
      ->type_name("WxH");
}

}  // namespace

void addRun(CLI::App& app, Command& chosen) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* command = app.add_subcommand(
      "run",
      "Simulate a scene: in a window where there is a display, into pictures with --out, or just measured");
  options->scene.addTo(*command, "the scene's");
  addNumbers(*command, *options);
  command->add_option("--view", options->view, "follow the crowd from here instead of the scene's camera")
      ->check(CLI::IsMember({"close", "crowd", "far"}));
  command->add_flag("--headless", options->headless, "no window; without --out nothing is drawn at all");
  command
      ->add_option("--out", options->out,
                   "DIR: a PNG a frame (an earlier run's are removed) and skitter.mp4; FILE.mp4: a video; "
                   "FILE.png: the "
                   "last frame")
      ->type_name("DIR|FILE.mp4|FILE.png");
  command->add_option("--json", options->json, "write the summary to a file")->type_name("FILE");
  command
      ->add_option("--trace", options->trace,
                   "write joints, rotations, stances and bodies of every tick (docs/trace.md)")
      ->type_name("DIR");
  command
      ->add_option("--footfalls", options->footfalls,
                   "write every touchdown: herd, agent, leg, tick, seconds, place, speed of the foot")
      ->type_name("FILE.csv");
  command->add_flag("--obstacle", options->obstacle,
                    "a mound wanders across the crowd's way: the terrain is edited in every tick");
  command->add_flag("--force", options->force, "allow a trace of more than 4 GiB");
  command->add_flag(
      "--sleep", options->sleep,
      "pass over agents that have stood still for seconds, until their goal or the ground moves");
  command->add_flag("--timings", options->timings,
                    "time every stage on the device's clock (software devices may lie)");
  command->add_flag("--poses", options->poses,
                    "pose every agent though nobody draws it, for what that costs");
  command->add_flag("--no-measure", options->unmeasured,
                    "leave the fidelity figures out, for what they cost");
  command->add_flag("--validation", options->validation,
                    "run under Vulkan's validation layer; a complaint fails");
  command->add_flag("--quiet", options->quiet, "no progress on stderr");
  command->footer(
      "The first Ctrl-C ends the run and completes its files; a second one kills it.\n"
      "\n"
      "Examples:\n"
      "  skitter run\n"
      "  skitter run --headless --agents 10000 --frames 600 --json figures.json\n"
      "  skitter run --terrain everest.png --spacing 0.5 --heights 0,40 --out walk.mp4\n"
      "  skitter run scene.json --frames 120 --out frames --trace trace");
  command->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

}  // namespace skitter::app
