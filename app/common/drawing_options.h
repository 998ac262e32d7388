#pragma once

#include <CLI/CLI.hpp>

#include "skitter/renderer.h"

namespace skitter::app {

// Adds the parts of RendererOptions that all commands that draw have.
constexpr const char *renderScaleOption = "--render-scale", *occlusionOption = "--occlusion";
void addDrawingOptions(CLI::App& command, RendererOptions& options);

}  // namespace skitter::app
