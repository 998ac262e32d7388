#pragma once

#include <cstdint>

#include "skitter/heightfield.h"
#include "skitter/scene.h"

namespace skitter::app {

// Hash of everything that is simulated, after flags have changed the scene: its values, the terrain's
// samples, and the bytes of the files of rigs and of their sidecars. The camera and the scene's name are no
// part of it.
uint64_t sceneHash(const Scene& scene, const Heightfield& terrain);

}  // namespace skitter::app
