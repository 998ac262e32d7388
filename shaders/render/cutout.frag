#version 460
#extension GL_GOOGLE_include_directive : require
// Shadows of materials through which light may fall.
#include "render/bindings.h"
#include "material.glsl"
#ifdef FADES
#include "fade.glsl"
layout(location = FADE_LOCATION) flat in uint fade;
#endif

layout(location = 0) in vec4 uv;
layout(location = 1) in float opacity;
layout(set = 0, binding = DRAW_TEXTURES + BASE_COLOUR) uniform sampler2D baseColours;

void main() {
  float alpha = opacity;
  if (has(BASE_COLOUR)) alpha *= texture(baseColours, placeOf(BASE_COLOUR, uv)).a;
  if (alpha < material.emissive.w) discard;
#ifdef FADES
  if (isFaded(uvec2(gl_FragCoord.xy), fade)) discard;
#endif
}
