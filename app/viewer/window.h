#pragma once

#include <vulkan/vulkan.h>

#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/common/values.h"
#include "app/viewer/keys.h"

struct GLFWwindow;

namespace skitter::app {

// Whether there is a display to open a window on.
bool hasDisplay();

// What the user did since the last look. Pixels, x to the right and y down.
struct Input {
  struct Pressed {
    Action action;
    bool shift = false;
  };
  std::vector<Pressed> pressed;      // in order
  std::optional<glm::vec2> clicked;  // the left button, pressed and released in one place
  bool grabbed = false;              // a drag with the left button began
  glm::vec2 turned{0}, moved{0};     // dragged with the left and with the right button
  float wheel = 0;                   // notches forward
  glm::vec3 flown{0};                // right, up and forward, by keys that are held
  glm::vec2 mouse{-1};
  bool held = false;  // the left button
};

// A window on the display. Throws Error(device) when there can be none.
class Window {
 public:
  explicit Window(Size size);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  std::vector<std::string> instanceExtensions() const;
  VkSurfaceKHR makeSurface(VkInstance instance) const;
  // False once the window is to close.
  bool poll();
  Input takeInput();
  void close();
  Size size() const;    // in pixels; zero while minimised
  float scale() const;  // of text, for displays of many pixels
  void setTitle(const std::string& title);

 private:
  void keyed(int key, int action, int modifiers);
  void buttoned(int button, bool down);
  void mouseMoved(const glm::vec2& to);
  bool isHeld(Action action) const;
  glm::vec2 pixelAt(double x, double y) const;

  GLFWwindow* window_ = nullptr;
  Input input_;
  glm::vec2 pressedAt_{0}, mouse_{-1};  // where events say it was, which may be a while ago
  bool left_ = false, right_ = false, dragged_ = false;
};

}  // namespace skitter::app
