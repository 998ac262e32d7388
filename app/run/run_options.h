#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "app/common/files.h"
#include "app/common/scene_options.h"
#include "app/common/values.h"
#include "app/run/pictures.h"
#include "app/run/run_note.h"
#include "skitter/crowd.h"
#include "skitter/device.h"
#include "skitter/renderer.h"
#include "skitter/scene.h"

namespace CLI {
class App;
}

namespace skitter::app {

// What the command line asks a run for.
struct RunOptions {
  SceneOptions scene;
  std::optional<uint64_t> frames;
  uint64_t ticksPerFrame = 1;
  uint32_t watchEvery = 0;
  std::optional<double> fps, slow;  // of a video
  Size size{1280, 720};
  RendererOptions drawing;
  std::string view, out, json, trace, footfalls;
  std::optional<Sky> light;           // none: as the scene says
  std::string save, resume;           // state files
  std::string levels;                 // of rate: "default", a file, or those of the scene
  std::optional<uint64_t> saveEvery;  // frames
  uint32_t pageAgents = 0;
  bool poses = false, unmeasured = false;
  bool headless = false, force = false, large = false, obstacle = false, timings = false, validation = false,
       quiet = false, sleep = false, crowding = false, paused = false, unjudged = false, strict = false;

  double secondsAFrame() const { return scene.dt * static_cast<double>(ticksPerFrame); }
  uint64_t framesWithoutWindow() const { return frames.value_or(defaultFrames); }
  double videoFps() const { return fps.value_or(defaultFps); }

  // Whether what they ask for is shown in a window.
  bool windowed(const OutTarget& target) const;
  // Throws Error(input) where there is no video to play as asked for, none with a frame, or a trace without
  // an end.
  void check(const OutTarget& target, bool inWindow) const;
  // The scene that they name, with its camera as they want it; `saved` takes its place in a run that goes on.
  Scene load(const Scene* saved = nullptr) const;
  // Takes over what a state and its note decide. Throws Error(input) that names an option which says
  // otherwise, or where the state is beyond the frames that are wanted.
  void adopt(const State& state, const RunNote& note, bool inWindow);
  // What is read and written.
  Files files(const OutTarget& target, const Scene& scene) const;
  DeviceRequest deviceRequest() const;
  CrowdOptions crowdOptions(const OutTarget& target, const Scene& of, bool inWindow) const;

  // The flags, and what the command's help says beside them.
  void addTo(CLI::App& command);

  static constexpr uint64_t defaultFrames = 300;
  static constexpr double defaultFps = 60;

 private:
  bool isGiven(const char* option) const;

  const CLI::App* command_ = nullptr;  // outlives the run
  std::optional<Levels> savedLevels_;  // of the state that the run goes on from
};

}  // namespace skitter::app
