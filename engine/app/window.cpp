#include "window.h"

#include <vulkan/vulkan.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <optional>
#include <thread>

#include "gpu/context.h"
#include "gpu/swapchain.h"
#include "signals.h"
#include "skitter/error.h"
#include "skitter/renderer.h"

namespace skitter::app {
namespace {

using Clock = std::chrono::steady_clock;

Error windowError(const char* what) {
  const char* reason = nullptr;
  glfwGetError(&reason);
  return deviceError(
      fmt::format("{}: {} (--headless runs without a window)", what, reason ? reason : "no reason given"));
}

// Draws at the window's size. While the user drags a corner the old picture is stretched: making a new
// renderer for every step of that would be slow.
class Canvas {
 public:
  Canvas(const WindowRun& run, Size size) : run_(run) { make(size); }

  Renderer& renderer(Size wanted) {
    const auto now = Clock::now();
    if (wanted.width != wanted_.width || wanted.height != wanted_.height) {
      wanted_ = wanted;
      since_ = now;
    }
    const bool fits = renderer_->width() == wanted.width && renderer_->height() == wanted.height;
    if (!fits && now - since_ > std::chrono::milliseconds(200)) {
      run_.device.waitIdle();
      make(wanted);
    }
    return *renderer_;
  }

 private:
  void make(Size size) {
    renderer_.reset();
    renderer_.emplace(run_.device, run_.crowd, size.width, size.height);
  }

  const WindowRun& run_;
  std::optional<Renderer> renderer_;
  Size wanted_{0, 0};
  Clock::time_point since_;
};

}  // namespace

bool hasDisplay() {
  const auto isSet = [](const char* name) {
    const char* value = std::getenv(name);
    return value && *value;
  };
  return isSet("DISPLAY") || isSet("WAYLAND_DISPLAY");
}

Window::Window(Size size) {
  if (!glfwInit()) throw windowError("no window");
  glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
  if (glfwVulkanSupported()) {
    window_ = glfwCreateWindow(static_cast<int>(size.width), static_cast<int>(size.height), "skitter",
                               nullptr, nullptr);
  }
  if (!window_) {
    const Error error = windowError("no window for Vulkan");
    glfwTerminate();
    throw error;
  }
}

Window::~Window() {
  glfwDestroyWindow(window_);
  glfwTerminate();
}

std::vector<std::string> Window::instanceExtensions() const {
  uint32_t count = 0;
  const char** names = glfwGetRequiredInstanceExtensions(&count);
  return names ? std::vector<std::string>(names, names + count) : std::vector<std::string>{};
}

VkSurfaceKHR Window::makeSurface(VkInstance instance) const {
  VkSurfaceKHR surface = VK_NULL_HANDLE;
  if (glfwCreateWindowSurface(instance, window_, nullptr, &surface) != VK_SUCCESS) {
    throw windowError("no surface for the window");
  }
  return surface;
}

bool Window::poll() {
  glfwPollEvents();
  return !glfwWindowShouldClose(window_) && glfwGetKey(window_, GLFW_KEY_ESCAPE) != GLFW_PRESS;
}

Size Window::size() const {
  int width = 0, height = 0;
  glfwGetFramebufferSize(window_, &width, &height);
  return {static_cast<uint32_t>(std::max(width, 0)), static_cast<uint32_t>(std::max(height, 0))};
}

void Window::setTitle(const std::string& title) { glfwSetWindowTitle(window_, title.c_str()); }

uint64_t runInWindow(Window& window, const WindowRun& run, TickTimes& times) {
  const gpu::Context& context = run.device.context();
  gpu::CommandRing ring(context);
  gpu::Swapchain swapchain(context, window.makeSurface(run.device.instance()), ring.slots());
  Size size = window.size();
  Canvas canvas(run, {std::max(size.width, 1u), std::max(size.height, 1u)});

  const auto frameTime = std::chrono::duration_cast<Clock::duration>(
      std::chrono::duration<double>(static_cast<double>(run.dt) * static_cast<double>(run.ticksPerFrame)));
  uint64_t frames = 0, framesAtTitle = 0;
  auto titleAt = Clock::now(), nextFrame = titleAt;
  while (window.poll() && !stopRequested() && run.crowd.tick() < run.ticks) {
    std::this_thread::sleep_until(nextFrame);
    nextFrame = std::max(nextFrame + frameTime, Clock::now());
    ring.waitAll();  // or the drawing of the last frame would be timed as part of the tick
    for (uint64_t k = 0; k < run.ticksPerFrame && run.crowd.tick() < run.ticks; ++k) {
      runTick(ring, run.crowd, run.dt, times);
      run.afterTick();
    }

    size = window.size();
    swapchain.resize({size.width, size.height});
    if (size.width > 0 && size.height > 0) {
      Renderer& renderer = canvas.renderer(size);
      const vk::CommandBuffer cmd = ring.begin();
      const double seconds = static_cast<double>(run.crowd.tick()) * static_cast<double>(run.dt);
      renderer.record(cmd, viewOf(run.scene, run.crowd, seconds));
      swapchain.show(cmd, renderer.image(), {renderer.width(), renderer.height()}, ring.slot());
      ring.submit(swapchain.links());
      swapchain.present();
      ++frames;
    }

    const auto now = Clock::now();
    if (now - titleAt > std::chrono::milliseconds(500)) {
      const double rate =
          static_cast<double>(frames - framesAtTitle) / std::chrono::duration<double>(now - titleAt).count();
      window.setTitle(fmt::format("skitter: {} agents, {:.0f} frames/s", run.crowd.agentCount(), rate));
      titleAt = now;
      framesAtTitle = frames;
    }
  }
  ring.waitAll();
  return frames;
}

}  // namespace skitter::app
