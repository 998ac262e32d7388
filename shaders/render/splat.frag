#version 460
#extension GL_GOOGLE_include_directive : require
// The canvas, with its depths, among all else that is drawn.
#include "picture.glsl"
#include "light.glsl"
#include "render/splat.h"
#include "lib/load4.glsl"

layout(push_constant) uniform ConstantBlock { uint width, height; };
LOAD4_BUFFER(DRAW_CANVAS, canvas)

layout(location = 0) out vec4 outColour;

void main() {
  int place = int(gl_FragCoord.y) * int(width) + int(gl_FragCoord.x);
  uint word = floatBitsToUint(LOAD4(canvas, place >> 2)[place & 3]);
  if (word == 0u) discard;
  vec3 colour = vec3(word >> 11 & 63u, word >> 5 & 63u, word & 31u) / vec3(63.0, 63.0, 31.0);
  outColour = vec4(ROOTS ? colour : colour * colour, 1.0);
  float depth = float((word >> 17) - 1u) / float(SPLAT_DEPTHS - 1);
  gl_FragDepth = picture.clipFromPicture[VIEW_CAMERA][3][2] *
                 exp2(-(float(SPLAT_FIRST_OCTAVE) + (1.0 - depth) * float(SPLAT_OCTAVES)));
}
