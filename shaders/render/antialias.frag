#version 460
// Smooths edges in the finished picture, where more samples a pixel would cost a software device sevenfold (after the
// removal of sub-pixel aliasing in Lottes 2011, "FXAA 3.11"): a pixel that stands out from the four beside it goes
// towards their mean.
#extension GL_GOOGLE_include_directive : require
#include "render/bindings.h"

layout(set = 0, binding = DRAW_DRAWN) uniform sampler2D drawn;
layout(location = 0) out vec4 outColour;

const float LEAST_CONTRAST = 0.05, LEAST_RELATIVE = 0.12;
const float MOST_SMOOTHED = 0.6;

// The picture holds roots, which are as bright as they look.
float luma(vec3 c) { return dot(c, vec3(0.25, 0.6, 0.15)); }

void main() {
  ivec2 last = textureSize(drawn, 0) - 1, p = ivec2(gl_FragCoord.xy);
  vec3 middle = texelFetch(drawn, p, 0).rgb;
  vec3 left = texelFetch(drawn, ivec2(max(p.x - 1, 0), p.y), 0).rgb;
  vec3 right = texelFetch(drawn, ivec2(min(p.x + 1, last.x), p.y), 0).rgb;
  vec3 above = texelFetch(drawn, ivec2(p.x, max(p.y - 1, 0)), 0).rgb;
  vec3 below = texelFetch(drawn, ivec2(p.x, min(p.y + 1, last.y)), 0).rgb;

  float m = luma(middle);
  vec4 beside = vec4(luma(left), luma(right), luma(above), luma(below));
  float most = max(m, max(max(beside.x, beside.y), max(beside.z, beside.w)));
  float contrast = most - min(m, min(min(beside.x, beside.y), min(beside.z, beside.w)));
  float standsOut = abs(dot(beside, vec4(0.25)) - m) / max(contrast, 1e-3);
  bool isEdge = contrast >= max(LEAST_CONTRAST, LEAST_RELATIVE * most);
  float smoothed = isEdge ? MOST_SMOOTHED * min(2.0 * standsOut, 1.0) : 0.0;
  vec3 root = mix(middle, 0.25 * (left + right + above + below), smoothed);
  outColour = vec4(root * root, 1.0);
}
