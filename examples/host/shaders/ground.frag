#version 460
#extension GL_GOOGLE_include_directive : require
#include "light.glsl"
layout(location = 0) in vec3 normal;
layout(location = 1) in vec2 place;
layout(location = 2) in float away;
layout(location = 0) out vec4 picture;

void main() {
  // Grass, and rock where it is steep; a line every four metres gives the scale.
  vec3 colour = mix(vec3(0.16, 0.13, 0.10), vec3(0.13, 0.15, 0.06), smoothstep(0.80, 0.93, normalize(normal).y));
  vec2 line = abs(fract(place / 4.0 - 0.5) - 0.5) * 4.0 / max(fwidth(place), vec2(1e-4));
  colour *= 1.0 - 0.25 * (1.0 - smoothstep(0.5, 1.5, min(line.x, line.y))) * exp(-away * 0.03);
  picture = vec4(seen(lit(colour, normalize(normal)), away), 1.0);
}
