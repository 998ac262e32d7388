#pragma once

#include <CLI/CLI.hpp>

#include "skitter/renderer.h"

namespace skitter::app {

// RendererOptions as options of commands that draw.
constexpr const char* renderScaleOption = "--render-scale";
void addRenderScale(CLI::App& command, float& scale);
constexpr const char* occlusionOption = "--occlusion";
void addOcclusion(CLI::App& command, RendererOptions& options);

}  // namespace skitter::app
