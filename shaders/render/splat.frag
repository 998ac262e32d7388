#version 460
#extension GL_GOOGLE_include_directive : require
#include "picture.glsl"
#include "splat.glsl"

layout(constant_id = CONSTANT_ROOTS) const bool ROOTS = false;
layout(push_constant) uniform ConstantBlock { SplatConstants constants; };
layout(set = 0, binding = DRAW_SPLATS, std430) readonly buffer Splats { uint splats[]; };
layout(location = 0) out vec4 outColour;

void main() {
  uvec2 at = uvec2(gl_FragCoord.xy);
  uint splat = splats[at.y * constants.width + at.x];
  if (splat == 0u) discard;
  gl_FragDepth = depthOf(splat);
  vec3 root = rootOf(splat);
  outColour = vec4(ROOTS ? root : root * root, 1.0);
}
