#include "app/viewer/window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "skitter/error.h"

namespace skitter::app {
namespace {

constexpr float stillMost = 4;  // pixels that a click may slip

Error windowError(const char* what) {
  const char* reason = nullptr;
  glfwGetError(&reason);
  return deviceError(
      fmt::format("{}: {} (--headless runs without a window)", what, reason ? reason : "no reason given"));
}

Window& windowOf(GLFWwindow* handle) { return *static_cast<Window*>(glfwGetWindowUserPointer(handle)); }

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
  glfwSetWindowUserPointer(window_, this);
  glfwSetKeyCallback(window_, [](GLFWwindow* w, int key, int, int action, int modifiers) {
    windowOf(w).keyed(key, action, modifiers);
  });
  glfwSetMouseButtonCallback(window_, [](GLFWwindow* w, int button, int action, int) {
    windowOf(w).buttoned(button, action == GLFW_PRESS);
  });
  glfwSetCursorPosCallback(
      window_, [](GLFWwindow* w, double x, double y) { windowOf(w).mouseMoved(windowOf(w).pixelAt(x, y)); });
  glfwSetScrollCallback(window_, [](GLFWwindow* w, double, double notches) {
    windowOf(w).input_.wheel += static_cast<float>(notches);
  });
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
  return !glfwWindowShouldClose(window_);
}

Size Window::size() const {
  int width = 0, height = 0;
  glfwGetFramebufferSize(window_, &width, &height);
  return {static_cast<uint32_t>(std::max(width, 0)), static_cast<uint32_t>(std::max(height, 0))};
}

void Window::setTitle(const std::string& title) { glfwSetWindowTitle(window_, title.c_str()); }

Input Window::takeInput() {
  Input input = std::exchange(input_, {});
  const auto axis = [&](Action more, Action less) {
    return static_cast<float>(isHeld(more)) - static_cast<float>(isHeld(less));
  };
  input.flown = {axis(Action::right, Action::left), axis(Action::up, Action::down),
                 axis(Action::forward, Action::back)};
  if (isHeld(Action::hurry)) input.flown *= 4.0f;
  input.mouse = mouse_;
  input.held = left_;
  return input;
}

void Window::close() { glfwSetWindowShouldClose(window_, GLFW_TRUE); }

float Window::scale() const {
  float x = 1, y = 1;
  glfwGetWindowContentScale(window_, &x, &y);
  return std::clamp(y, 1.0f, 4.0f);
}

void Window::keyed(int key, int action, int modifiers) {
  const std::optional<Action> meant = actionOf(key);
  if (!meant || action == GLFW_RELEASE) return;
  if (action == GLFW_REPEAT && *meant != Action::step) return;
  input_.pressed.push_back({*meant, (modifiers & GLFW_MOD_SHIFT) != 0});
}

void Window::buttoned(int button, bool down) {
  if (button == GLFW_MOUSE_BUTTON_RIGHT || button == GLFW_MOUSE_BUTTON_MIDDLE) right_ = down;
  if (button != GLFW_MOUSE_BUTTON_LEFT) return;
  if (down) {
    pressedAt_ = mouse_;
    dragged_ = false;
  } else if (left_ && !dragged_) {
    input_.clicked = pressedAt_;
  }
  left_ = down;
}

void Window::mouseMoved(const glm::vec2& to) {
  const glm::vec2 by = to - mouse_;
  mouse_ = to;
  if (right_) input_.moved += by;
  if (!left_) return;
  if (!dragged_ && glm::distance(to, pressedAt_) > stillMost) {
    dragged_ = true;
    input_.grabbed = true;
  }
  if (dragged_) input_.turned += by;
}

bool Window::isHeld(Action action) const {
  const auto rows = keyRows();
  const auto row =
      std::find_if(rows.begin(), rows.end(), [&](const KeyRow& r) { return r.action == action; });
  return row != rows.end() && glfwGetKey(window_, row->key) == GLFW_PRESS;
}

// GLFW counts in screen coordinates, of which a pixel may be a part.
glm::vec2 Window::pixelAt(double x, double y) const {
  int width = 1, height = 1;
  glfwGetWindowSize(window_, &width, &height);
  const Size pixels = size();
  return {
      static_cast<float>(x) * static_cast<float>(pixels.width) / static_cast<float>(std::max(width, 1)),
      static_cast<float>(y) * static_cast<float>(pixels.height) / static_cast<float>(std::max(height, 1))};
}

}  // namespace skitter::app
