#pragma once

#include "skitter/renderer.h"

namespace skitter::app {

// Says on stderr which images of models cannot be drawn, each once however often it is called.
void warnOfImages(const Renderer& renderer);

// Says on stderr at the end of its scope, also where an error ends it, what was left out or mended as models
// and clips were read, each line once.
struct ModelWarnings {
  ~ModelWarnings();
};

}  // namespace skitter::app
