#ifndef GROUND_GLSL
#define GROUND_GLSL
// The heightfield as the stages see it.
#include "lib/heightfield.glsl"

layout(set = 0, binding = BINDING_HEIGHTS) uniform sampler2D heights;
// Read at once, as the parameters are.
Field field = fieldOf(heights, vec2(parameters.originX, parameters.originZ),
                      vec2(parameters.inverseSpacingX, parameters.inverseSpacingZ));

// Height and gradient.
vec3 groundAt(vec2 world) { return heightAt(heights, field, world); }

#endif
