#include "app/common/drawing_options.h"

#include "app/common/values.h"
#include "skitter/renderer.h"

namespace skitter::app {

void addRenderScale(CLI::App& command, float& scale) {
  command
      .add_option_function<std::string>(
          renderScaleOption,
          [&scale](const std::string& text) {
            scale = static_cast<float>(
                parseNumber(renderScaleOption, text, double{RendererOptions::leastScale}, 1));
          },
          "shade so many pixels along each side, as a share, and enlarge the picture; 0.5 is faster [1]")
      ->type_name("X");
}

void addOcclusion(CLI::App& command, RendererOptions& options) {
  command
      .add_option_function<std::string>(
          occlusionOption, [&options](const std::string& text) { options.occlusion = text == "on"; },
          "leave agents out whom others or the ground hide, which changes no picture [where it pays: on for "
          "crowds of 200000 and more on a GPU]")
      ->check(CLI::IsMember({"on", "off"}))
      ->type_name("on|off");
}

}  // namespace skitter::app
