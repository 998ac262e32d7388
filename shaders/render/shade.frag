#version 460
#extension GL_GOOGLE_include_directive : require
// Ground in the shadow of agents that are drawn as splats.
#include "picture.glsl"
#include "light.glsl"
#include "splat.glsl"

layout(push_constant) uniform ConstantBlock { SplatConstants constants; };
layout(set = 0, binding = DRAW_SPLATS, std430) readonly buffer Splats { uint splats[]; };
layout(location = 0) out vec4 outColour;

// Blended over the ground, whose roots it dims by the root.
void main() {
  uvec2 at = uvec2(gl_FragCoord.xy);
  uint pixel = at.y * constants.width + at.x, splat = splats[constants.width * constants.height + pixel];
  // Agents stand nearer to the ground than its depth is known.
  if (splat == 0u || splats[pixel] != 0u) discard;
  float depth = depthOf(splat), haze = NEAR_PLANE / depth * picture.tile.w;
  gl_FragDepth = depth;
  // What the sky alone leaves of the light on level ground (terrain.frag).
  vec3 sky = ambientLight(vec3(0.0, 1.0, 0.0));
  float lit = dot(SUN_LIGHT * picture.sun.y + sky, vec3(1.0)), left = 0.62 * dot(sky, vec3(1.0)) / lit;
  left = 1.0 - (1.0 - left) * shadeOf(splat) * exp(-haze * haze);
  outColour = vec4(0.0, 0.0, 0.0, 1.0 - (ROOTS ? sqrt(left) : left));
}
