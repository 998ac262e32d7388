#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "app/common/values.h"
#include "skitter/crowd.h"
#include "skitter/device.h"
#include "skitter/heightfield.h"
#include "skitter/renderer.h"
#include "skitter/scene.h"

namespace skitter::app {

struct FrameOptions {
  Size size{1280, 720};
  RendererOptions drawing;
  std::optional<Levels> levels;  // of rate, by the picture's camera; else those of the scene
  double dt = 1.0 / 60;          // seconds a tick
  uint32_t warmUp = 20;          // frames before the first that counts
  uint32_t frames = 100;         // that count
  uint32_t timedFrames = 20;     // after these, each part by itself
};

// What a frame costs: a tick, the drawing of it, and its copy in host memory.
struct FrameTimes {
  uint64_t agents = 0;
  double framesPerSecond = 0;    // by the median frame; one is drawn while the last one is waited for
  double cpuMilliseconds = 0;    // a frame, of all threads of the process
  PictureCounts counts;          // of the last frame
  std::vector<StageTime> parts;  // medians, of frames whose parts wait for each other
};

// Draws the scene's crowd as its camera sees it. `step` is called with the share of the frames that are done;
// `stopped` ends it early.
FrameTimes timeFrames(Device&, const Heightfield&, const Scene&, const FrameOptions&,
                      const std::function<void(double)>& step, const std::function<bool()>& stopped);

void print(const FrameTimes& times);
nlohmann::ordered_json jsonOf(const FrameTimes& times);

}  // namespace skitter::app
