#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "app/common/signals.h"
#include "app/common/simulate.h"
#include "app/viewer/window.h"
#include "skitter/crowd.h"
#include "skitter/device.h"
#include "skitter/renderer.h"
#include "skitter/scene.h"

namespace skitter::app {

struct WindowRun {
  Device& device;
  Crowd& crowd;
  const Scene& scene;  // that the crowd was made of
  float dt;
  uint64_t ticks;  // at most
  uint64_t ticksPerFrame;
  RendererOptions drawing;
  bool paused;   // at first
  bool timings;  // stages are timed all along
  std::function<void()> afterTick;
  StopDeadline::Leave leave;  // of work that takes too long to wait for
  // Makes crowd and scene anew, with another controller where one is named. Throws Error, and then both stay
  // as they are.
  std::function<void(std::optional<Controller> controller)> restart;
  std::string unbroken;  // the option that asks for the whole run, so that it cannot begin anew; else empty
};

// Simulates and shows, at most as fast as asked for, until the window closes, a stop is requested or the
// ticks are done. Returns the number of frames. `times` are those since the last restart.
uint64_t runInWindow(Window& window, const WindowRun& run, TickTimes& times);

}  // namespace skitter::app
