#include "app/common/drawing_options.h"

#include <fmt/format.h>

#include "app/common/values.h"

namespace skitter::app {

void addDrawingOptions(CLI::App& command, RendererOptions& options) {
  command
      .add_option_function<std::string>(
          renderScaleOption,
          [&options](const std::string& text) {
            options.scale = static_cast<float>(
                parseNumber(renderScaleOption, text, double{RendererOptions::leastScale}, 1));
          },
          "shade so many pixels along each side, as a share, and enlarge the picture; 0.5 is faster [1]")
      ->type_name("X");
  command
      .add_option_function<std::string>(
          occlusionOption, [&options](const std::string& text) { options.occlusion = text == "on"; },
          fmt::format("leave agents out whom others or the ground hide, which changes no picture [where it "
                      "pays: on for "
                      "crowds of {} and more on a GPU]",
                      RendererOptions::occlusionAgents))
      ->check(CLI::IsMember({"on", "off"}))
      ->type_name("on|off");
}

}  // namespace skitter::app
