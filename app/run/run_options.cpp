#include "app/run/run_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <utility>

#include "app/common/drawing_options.h"
#include "app/common/law_watch.h"
#include "app/run/trace.h"
#include "app/viewer/window.h"
#include "skitter/error.h"
#include "skitter/renderer.h"

namespace skitter::app {
namespace {

constexpr uint64_t maxFrames = 100000000, maxTicksPerFrame = 1000, maxWatchEvery = 1000000;
constexpr double mostFps = 240, leastSlow = 0.01, mostSlow = 100;

// Throws Error(input) where there is no video to play as asked for, or none with a frame.
void checkVideo(const RunOptions& options, const OutTarget& target) {
  if (!target.isEveryFrame()) {
    for (const auto& [name, given] : {std::pair{"--fps", options.fps}, {"--slow", options.slow}})
      if (given) throw inputError(fmt::format("{} is a video's, expected --out DIR or --out FILE.mp4", name));
    return;
  }
  if (options.frames == 0u)
    throw inputError(fmt::format("--out {}: a video needs at least one frame, --frames is 0", options.out));
  const double seconds =
      static_cast<double>(options.framesWithoutWindow()) * options.secondsAFrame() * options.slow.value_or(1);
  const double fps = options.videoFps();
  if (seconds * fps < 0.999)
    throw inputError(
        fmt::format("--out {}: a video of {:.3g} s has no frame at {:g} frames a second; "
                    "expected a longer run or --slow",
                    options.out, seconds, fps));
}

Camera cameraOf(const RunOptions& options, Camera camera) {
  if (options.view.empty()) return camera;
  camera.kind = Camera::Kind::follow;
  camera.distance = options.view == "close" ? 3.5f : (options.view == "crowd" ? 9.0f : 30.0f);
  return camera;
}

void addNumbers(CLI::App& command, RunOptions& options) {
  command
      .add_option_function<std::string>(
          "--frames",
          [&options](const std::string& text) {
            options.frames = parseWhole("--frames", text, 0, maxFrames);
          },
          fmt::format("frames to run [{}; a window runs until it is closed]", RunOptions::defaultFrames))
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
          "--fps",
          [&options](const std::string& text) { options.fps = parseNumber("--fps", text, 1, mostFps); },
          fmt::format("frames a second of a video, which plays in real time whatever --dt is [{}]",
                      RunOptions::defaultFps))
      ->type_name("N");
  command
      .add_option_function<std::string>(
          "--slow",
          [&options](const std::string& text) {
            options.slow = parseNumber("--slow", text, leastSlow, mostSlow);
          },
          "a video plays so many times slower than real time; a --dt as many times shorter keeps it smooth "
          "[1]")
      ->type_name("X");
  command
      .add_option_function<std::string>(
          "--size", [&options](const std::string& text) { options.size = parseSize("--size", text); },
          "of the window or the pictures, in pixels [1280x720]")
      ->type_name("WxH");
  command
      .add_option_function<std::string>(
          "--detail",
          [&options](const std::string& text) {
            options.drawing.detail = static_cast<float>(parseNumber(
                "--detail", text, double{RendererOptions::leastDetail}, double{RendererOptions::mostDetail}));
          },
          "draw agents as finely as if they were so many times larger; 0.5 is faster, 100000 full detail [1]")
      ->type_name("X");
  addDrawingOptions(command, options.drawing);
  command.add_flag("--footprints", options.drawing.footprints,
                   "feet of adaptive herds leave prints on the ground, which fade");
}

}  // namespace

bool RunOptions::windowed(const OutTarget& target) const {
  return !headless && target.kind == OutTarget::Kind::none && hasDisplay();
}

void RunOptions::check(const OutTarget& target, bool inWindow) const {
  checkVideo(*this, target);
  if (saveEvery && save.empty()) throw inputError("--save-every needs --save FILE");
  if (strict && unjudged) throw inputError("--strict with --no-laws, expected only one of them");
  if (inWindow && !trace.empty() && !frames)
    throw inputError("--trace needs --frames where a window runs until it is closed");
}

bool RunOptions::isGiven(const char* option) const { return command_ && command_->count(option) > 0; }

void RunOptions::adopt(const State& state, const RunNote& note, bool inWindow) {
  const auto decide = [&](const char* option, auto& value, const auto& saved, const std::string& text) {
    if (isGiven(option) && value != saved)
      throw inputError(fmt::format("{}: {} was saved {}", option, resume, text));
    value = saved;
  };
  scene.refuseOthersThan(note.sceneOf(state), resume);
  if (state.dt > 0 && isGiven("--dt") && static_cast<float>(scene.dt) == state.dt) scene.dt = note.dt;
  if (state.dt > 0) decide("--dt", scene.dt, note.dt, fmt::format("with --dt {}", note.dt));
  decide("--ticks-per-frame", ticksPerFrame, note.ticksPerFrame,
         fmt::format("with --ticks-per-frame {}", note.ticksPerFrame));
  decide("--watch-every", watchEvery, state.options.watchEvery,
         fmt::format("with --watch-every {}", state.options.watchEvery));
  decide("--sleep", sleep, state.options.sleep, "without it");
  if (isGiven("--levels") && loadLevels(levels) != state.options.levels)
    throw inputError(
        fmt::format("--levels: {} was saved with{} levels", resume, state.options.levels ? " other" : "out"));
  savedLevels_ = state.options.levels;
  decide("--no-measure", unmeasured, !state.options.measure, "without it");
  decide("--obstacle", obstacle, !note.obstacle.is_null(), "without it");
  if (inWindow && !frames) return;
  if (!frames) frames = note.frames;
  const uint64_t wanted = framesWithoutWindow() * ticksPerFrame;
  if (wanted < state.tick)
    throw inputError(
        fmt::format("--frames {}: {} is of frame {} already, and frames count from the run's start",
                    framesWithoutWindow(), resume, state.tick / ticksPerFrame));
}

Scene RunOptions::load(const Scene* saved) const {
  Scene loaded = saved ? *saved : scene.load();
  loaded.camera = cameraOf(*this, loaded.camera);
  if (light) loaded.light = {.sky = *light};
  return loaded;
}

Files RunOptions::files(const OutTarget& target, const Scene& of) const {
  Files all;
  scene.declare(all, of);
  if (target.kind == OutTarget::Kind::folder)
    all.fills("--out", target.path, isPicture, force);
  else
    all.writes("--out", target.path);
  all.fills("--trace", trace, Trace::claims, force);
  all.writes("--footfalls", footfalls);
  all.writes("--json", json);
  all.reads("--resume", resume);
  if (levels != "default") all.reads("--levels", levels);
  all.replaces("--save", save, resume);
  return all;
}

DeviceRequest RunOptions::deviceRequest() const {
  DeviceRequest request;
  request.device = scene.device;
  request.validation = validation;
  return request;
}

CrowdOptions RunOptions::crowdOptions(const OutTarget& target, const Scene& of, bool inWindow) const {
  CrowdOptions crowd;
  crowd.timestamps = timings || inWindow;
  crowd.measure = !unmeasured;
  crowd.watchEvery = watchEvery;
  crowd.sleep = sleep;
  crowd.crowding = crowding;
  crowd.levels = levels.empty() ? savedLevels_ : loadLevels(levels);
  crowd.pageAgents = pageAgents;
  const bool judgesAll = !unjudged && of.capacity() <= LawWatch::mostPosed;
  crowd.feet = !trace.empty() || inWindow || crowding || judgesAll;
  if (!footfalls.empty()) crowd.footfalls = UINT32_MAX;  // all that can be
  crowd.pose = poses || inWindow || !trace.empty() || crowding || judgesAll ||
               (target.kind != OutTarget::Kind::none && Renderer::needsPoses(of));
  return crowd;
}

void RunOptions::addTo(CLI::App& command) {
  command_ = &command;
  scene.addTo(command, "the scene's");
  addNumbers(command, *this);
  command.add_option("--view", view, "follow the crowd from here instead of the scene's camera")
      ->check(CLI::IsMember({"close", "crowd", "far"}));
  command
      .add_option_function<std::string>(
          "--light", [this](const std::string& text) { light = parseNamed("--light", text, allSkies); },
          fmt::format("what lights the pictures: {} [the scene's]", namesOf(allSkies)))
      ->type_name("NAME");
  command.add_flag("--headless", headless, "no window; without --out nothing is drawn at all");
  command
      .add_option(
          "--out", out,
          "DIR: a PNG a frame and skitter.mp4, in place of an earlier run's; FILE.mp4: a video; FILE.png: "
          "the last frame")
      ->type_name("DIR|FILE.mp4|FILE.png");
  command.add_option("--json", json, "write the summary to a file")->type_name("FILE");
  command
      .add_option("--trace", trace,
                  "write joints, rotations, stances and bodies of every tick, in place of an earlier trace "
                  "(docs/trace.md)")
      ->type_name("DIR");
  command
      .add_option("--footfalls", footfalls,
                  "write every touchdown: herd, agent, leg, tick, seconds, place, speed of the foot")
      ->type_name("FILE.csv");
  command.add_option("--save", save, "write the run's state at its end, to go on with later (docs/state.md)")
      ->type_name("FILE");
  command
      .add_option_function<std::string>(
          "--save-every",
          [this](const std::string& text) { saveEvery = parseWhole("--save-every", text, 1, maxFrames); },
          "and after every N frames")
      ->type_name("N");
  command
      .add_option("--resume", resume,
                  "go on from a state, which has scene, terrain and options; --frames counts from the first "
                  "run's start [as many as that run wanted]")
      ->type_name("FILE");
  command
      .add_option_function<std::string>(
          "--page-agents",
          [this](const std::string& text) {
            pageAgents = static_cast<uint32_t>(parseWhole("--page-agents", text, 1, Scene::maxAgents));
          },
          "most agents a page of device memory, which changes no result [as many as the device's limits "
          "allow]")
      ->type_name("N");
  command.add_flag("--obstacle", obstacle,
                   "a mound wanders across the crowd's way: the terrain is edited in every tick");
  command.add_flag(
      "--force", force,
      "with a DIR that is not empty and no earlier run's: write into it, over files of the same names");
  command.add_flag("--large", large, "allow a trace of more than 4 GiB");
  command.add_flag(
      "--sleep", sleep,
      "pass over agents that have stood still for seconds, until their goal or the ground moves");
  command
      .add_option("--levels", levels,
                  "who is far from the camera ticks every second, fourth or eighth time: within the usual "
                  "distances and numbers, or those of a JSON file [those of the scene, else none]")
      ->type_name("default|FILE");
  command.add_flag("--crowding", crowding,
                   "measure how agents share the ground: overlaps, jams, crossings of legs, flow; looks at "
                   "all of them ten times a second");
  command.add_flag("--paused", paused, "a window waits for its first key (Space)");
  command.add_flag("--timings", timings, "time every stage on the device's clock (software devices may lie)");
  command.add_flag("--poses", poses, "pose every agent though nobody draws it, for what that costs");
  command.add_flag("--no-measure", unmeasured, "leave the fidelity figures out, for what they cost");
  command.add_flag("--no-laws", unjudged,
                   "do not judge the run by the laws of the visible world (docs/laws.md)");
  command.add_flag("--strict", strict, "a law that is broken fails the run, with exit code 1");
  command.add_flag("--validation", validation, "run under Vulkan's validation layer; a complaint fails");
  command.add_flag("--quiet", quiet, "no progress on stderr");
  command.footer(
      "The first Ctrl-C ends the run within a second, and completes its files; a second one kills it.\n"
      "\n"
      "Examples:\n"
      "  skitter run\n"
      "  skitter run --headless --agents 10000 --frames 600 --json figures.json\n"
      "  skitter run --terrain everest.png --spacing 0.5 --heights 0,40 --out walk.mp4\n"
      "  skitter run scene.json --frames 120 --out frames --trace trace\n"
      "  skitter run --headless --frames 36000 --save hour.state --save-every 3600\n"
      "  skitter run --resume hour.state --frames 36300 --out end.mp4");
}

}  // namespace skitter::app
