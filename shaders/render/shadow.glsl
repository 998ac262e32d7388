#ifndef SHADOW_GLSL
#define SHADOW_GLSL
#include "shadow_map.glsl"

// Texels that lookups cover along the pixel, and that their places are off that way.
const float LEAST_WAY = 3.0, MOST_WAY = 32.0, ACROSS = 0.3;

// The share of sunlight that no agent takes away at picture point `p`, which lies at `nearAt` and `farAt` in the
// cascades.
float sunlightAt(vec3 p, vec3 nearAt, vec3 farAt) {
  bool isNear = inNearCascade(nearAt);
  vec3 at = isNear ? nearAt : farAt;
  float width = picture.shadow.w;
  vec2 place = placeOnMap(at, isNear);
  // Two places along the longer side of the pixel on the map, for ground is seen along: a shadow thinner than a pixel
  // would be dashes. One is to the left and one to the right, for shadows that lie along that side.
  vec2 x = dFdx(nearAt.xy), y = dFdy(nearAt.xy);
  vec2 side = (dot(x, x) > dot(y, y) ? x : y) * (0.5 * width * (isNear ? 1.0 : picture.shadow.x / picture.shadow.y));
  float texels = length(side);
  side = texels > 1e-6 ? side / texels : vec2(1.0, 0.0);
  vec2 off = 0.1875 * clamp(1.5 * texels, LEAST_WAY, MOST_WAY) * side + ACROSS * vec2(-side.y, side.x);
  // Depths are gathered and weighed here, for not every device filters them.
  vec2 texel = texelOfMap();
  return fadedShadow(p, 0.5 * (compared(place - off, at.z, texel) + compared(place + off, at.z, texel)));
}

// `normal` moves the point off surfaces that cast shadows themselves by `offTexels` texels, so that they do not
// shade themselves.
float sunlight(vec3 p, vec3 normal, float offTexels) {
  return sunlightAt(p, offSurface(0, p, normal, offTexels), offSurface(1, p, normal, offTexels));
}

#endif
