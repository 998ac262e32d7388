#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "gpu/submit.h"
#include "simulate.h"
#include "skitter/crowd.h"
#include "skitter/device.h"
#include "skitter/scene.h"
#include "values.h"

struct GLFWwindow;

namespace skitter::app {

// Whether there is a display to open a window on.
bool hasDisplay();

// A window on the display. Throws Error(device) when there can be none.
class Window {
 public:
  explicit Window(Size size);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  std::vector<std::string> instanceExtensions() const;
  VkSurfaceKHR makeSurface(VkInstance instance) const;
  // Handles what the user did; false once the window is to close (its button, or Esc).
  bool poll();
  Size size() const;  // in pixels; zero while minimised
  void setTitle(const std::string& title);

 private:
  GLFWwindow* window_ = nullptr;
};

struct WindowRun {
  Device& device;
  Crowd& crowd;
  const Scene& scene;
  float dt;
  uint64_t ticks;  // at most
  uint64_t ticksPerFrame;
  std::function<void()> afterTick;
};

// Simulates and shows, no faster than real time, until the window closes, a stop is requested or the ticks
// are done. Returns the number of frames.
uint64_t runInWindow(Window& window, const WindowRun& run, TickTimes& times);

}  // namespace skitter::app
