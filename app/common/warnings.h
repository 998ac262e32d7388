#pragma once

#include "skitter/renderer.h"

namespace skitter::app {

// Says on stderr which images of models cannot be drawn, each once however often it is called.
void warnOfImages(const Renderer& renderer);

}  // namespace skitter::app
