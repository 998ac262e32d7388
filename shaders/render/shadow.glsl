#ifndef SHADOW_GLSL
#define SHADOW_GLSL
layout(set = 0, binding = DRAW_SHADOW) uniform sampler2DShadow shadowMap;

// Texels that a lookup covers along the pixel, and that its places are off that way.
const float LEAST_WAY = 3.0, MOST_WAY = 32.0, ACROSS = 0.6;

// The mean of the four comparisons about a place of the map, in texels, weighed by their nearness.
float compared(vec2 at, float depth, vec2 texel) {
  vec2 first = floor(at - 0.5), f = at - 0.5 - first;
  vec4 lit = textureGather(shadowMap, (first + 1.0) * texel, depth);
  return mix(mix(lit.w, lit.z, f.x), mix(lit.x, lit.y, f.x), f.y);
}

// The share of sunlight that no agent takes away at picture point `p`, which lies at `nearAt` and `farAt` in the
// cascades. The far one holds all that is in the picture up to the distance at which shadows have faded. One
// of them is looked up, chosen without a branch: software devices pay for both sides of one.
float sunlightAt(vec3 p, vec3 nearAt, vec3 farAt) {
  bool isNear = max(abs(nearAt.x), abs(nearAt.y)) < 0.98;
  vec3 at = isNear ? nearAt : farAt;
  float width = picture.shadow.w;
  vec2 place = width * (at.xy * 0.5 + vec2(isNear ? 0.5 : 1.5, 0.5));
  // Four places in zigzag along the longer side of the pixel on the map, for ground is seen along: a shadow thinner
  // than a pixel would be dashes. Neighbouring pixels overlap by a half.
  vec2 x = dFdx(nearAt.xy), y = dFdy(nearAt.xy);
  vec2 side = (dot(x, x) > dot(y, y) ? x : y) * (0.5 * width * (isNear ? 1.0 : picture.shadow.x / picture.shadow.y));
  float texels = length(side);
  side = texels > 1e-6 ? side / texels : vec2(1.0, 0.0);
  vec2 along = 0.125 * clamp(1.5 * texels, LEAST_WAY, MOST_WAY) * side, across = ACROSS * vec2(-side.y, side.x);
  // Depths are gathered and weighed here, for not every device filters them.
  vec2 texel = 1.0 / vec2(2.0 * width, width);
  float lit = 0.25 * (compared(place - 3.0 * along - across, at.z, texel) + compared(place - along + across, at.z, texel) +
                      compared(place + along - across, at.z, texel) + compared(place + 3.0 * along + across, at.z, texel));
  float ahead = dot(p - picture.eye.xyz, picture.forward.xyz);
  return mix(lit, 1.0, smoothstep(0.8, 0.98, ahead / picture.forward.w));
}

// `normal` moves the point off surfaces that cast shadows themselves by `offTexels` texels, so that they do not
// shade themselves.
float sunlight(vec3 p, vec3 normal, float offTexels) {
  return sunlightAt(p, (picture.clipFromPicture[1] * vec4(p + normal * (offTexels * picture.shadow.x), 1.0)).xyz,
                    (picture.clipFromPicture[2] * vec4(p + normal * (offTexels * picture.shadow.y), 1.0)).xyz);
}

#endif
