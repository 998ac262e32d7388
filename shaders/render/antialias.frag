#version 460
// Smooths edges in the finished picture, where more samples a pixel would cost a software device sevenfold
// (after Lottes 2009, "FXAA"): along an edge found by luma, the colour is averaged.
#extension GL_GOOGLE_include_directive : require
#include "render/bindings.h"

layout(set = 0, binding = DRAW_DRAWN) uniform sampler2D drawn;
layout(location = 0) out vec4 outColour;

// The picture holds roots, which are as bright as they look.
float luma(vec3 c) { return dot(c, vec3(0.25, 0.6, 0.15)); }

void main() {
  ivec2 last = textureSize(drawn, 0) - 1, p = ivec2(gl_FragCoord.xy);
  vec3 middle = texelFetch(drawn, p, 0).rgb;
  float m = luma(middle);
  float nw = luma(texelFetch(drawn, max(p + ivec2(-1, -1), 0), 0).rgb);
  float ne = luma(texelFetch(drawn, ivec2(min(p.x + 1, last.x), max(p.y - 1, 0)), 0).rgb);
  float sw = luma(texelFetch(drawn, ivec2(max(p.x - 1, 0), min(p.y + 1, last.y)), 0).rgb);
  float se = luma(texelFetch(drawn, min(p + 1, last), 0).rgb);

  float least = min(m, min(min(nw, ne), min(sw, se))), most = max(m, max(max(nw, ne), max(sw, se)));
  vec2 along = vec2(sw + se - nw - ne, nw + sw - ne - se);
  float shorter = min(abs(along.x), abs(along.y)) + max((nw + ne + sw + se) * 0.03125, 1.0 / 128.0);
  along = clamp(along / shorter, -2.5, 2.5);

  vec2 texel = 1.0 / vec2(last + 1), at = gl_FragCoord.xy * texel;
  along *= texel;
  vec3 smoothed = 0.5 * (texture(drawn, at - 0.3 * along).rgb + texture(drawn, at + 0.3 * along).rgb);
  vec3 root = most - least < max(0.05, 0.12 * most) ? middle : smoothed;
  outColour = vec4(root * root, 1.0);
}
