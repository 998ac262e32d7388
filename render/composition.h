#pragma once

#include <array>

#include "render/light.h"
#include "render/picture.h"
#include "skitter/heightfield.h"
#include "skitter/renderer.h"

namespace skitter::render {

// Everything that follows from a view, worked out once a picture on the host.
struct Composition {
  shared::Picture block{};
  glm::dvec2 origin{0};    // world x, z of picture space's origin
  float viewDistance = 0;  // metres; beyond it fog hides everything
};

// `lowest` and `highest` are the terrain's heights; shadowTexels is the side of a cascade's square.
Composition compose(const View&, const LightModel&, const Heightfield&, float lowest, float highest,
                    uint32_t width, uint32_t height, uint32_t shadowTexels);

}  // namespace skitter::render
