#pragma once

#include <CLI/CLI.hpp>

namespace skitter::app {

// RendererOptions::scale as an option of commands that draw.
constexpr const char* renderScaleOption = "--render-scale";
void addRenderScale(CLI::App& command, float& scale);

}  // namespace skitter::app
