#include "app/common/render_scale.h"

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

}  // namespace skitter::app
