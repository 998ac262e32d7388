#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/common/values.h"
#include "app/viewer/keys.h"
#include "app/viewer/window.h"
#include "gpu/context.h"

struct ImDrawList;

namespace skitter::app {

// A heading has no value.
using Figures = std::vector<std::pair<std::string, std::string>>;

// The panels of a window, by Dear ImGui. A frame is begin(), what it shows, end(), and draw() while the
// picture is drawn.
class Gui {
 public:
  Gui(const gpu::Context& context, float scale);
  ~Gui();

  void begin(Size size, float seconds, const Input& input);
  // The mouse is over a panel.
  bool hasMouse() const;
  // What is drawn below all panels.
  ImDrawList& underneath();
  // Every key; the action of the row that was clicked.
  std::optional<Action> help();
  void figures(const Figures& figures);
  void message(const std::string& text);
  void end();
  void draw(vk::CommandBuffer cmd);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace skitter::app
