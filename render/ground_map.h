#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "gpu/image.h"
#include "skitter/heightfield.h"

namespace skitter::render {

// dh/dx and dh/dz of the ground map at a sample; beyond the edge the ground goes on level.
glm::vec2 gradientAt(const Heightfield&, int x, int z);

// What the light does to each height sample, worked out once: gradient dh/dx and dh/dz by central differences
// (so that shading is smooth across cells), the share of the sky that is open, and the share of sunlight that
// hills leave. RGBA16F, in state sampled.
gpu::Image makeGroundMap(const gpu::Context&, const Heightfield&, const glm::vec3& towardsSun);

}  // namespace skitter::render
