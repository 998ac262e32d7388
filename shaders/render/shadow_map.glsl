#ifndef SHADOW_MAP_GLSL
#define SHADOW_MAP_GLSL
layout(set = 0, binding = DRAW_SHADOW) uniform sampler2DShadow shadowMap;

// The mean of the four comparisons about a place of the map, in texels, weighed by their nearness.
float compared(vec2 at, float depth, vec2 texel) {
  vec2 first = floor(at - 0.5), f = at - 0.5 - first;
  vec4 lit = textureGather(shadowMap, (first + 1.0) * texel, depth);
  return mix(mix(lit.w, lit.z, f.x), mix(lit.x, lit.y, f.x), f.y);
}

// The far cascade holds all that is in the picture up to the distance at which shadows have faded. One of the
// cascades is looked up, chosen without a branch: software devices pay for both sides of one.
bool inNearCascade(vec3 nearAt) { return max(abs(nearAt.x), abs(nearAt.y)) < 0.98; }

// Texels.
vec2 placeOnMap(vec3 at, bool isNear) { return picture.shadow.w * (at.xy * 0.5 + vec2(isNear ? 0.5 : 1.5, 0.5)); }
vec2 texelOfMap() { return 1.0 / vec2(2.0 * picture.shadow.w, picture.shadow.w); }

float fadedShadow(vec3 p, float lit) {
  float ahead = dot(p - picture.eye.xyz, picture.forward.xyz);
  return mix(lit, 1.0, smoothstep(0.8, 0.98, ahead / picture.forward.w));
}

// A point moved off a surface that may cast the shadow itself, in a cascade.
vec3 offSurface(int cascade, vec3 p, vec3 normal, float texels) {
  float texel = cascade == 0 ? picture.shadow.x : picture.shadow.y;
  return (picture.clipFromPicture[1 + cascade] * vec4(p + normal * (texels * texel), 1.0)).xyz;
}

// The share of sunlight that nobody takes away, by one comparison: for agents. `normal` moves the
// point off surfaces that cast shadows themselves by `offTexels` texels.
float sunlightOnce(vec3 p, vec3 normal, float offTexels) {
  vec3 nearAt = offSurface(0, p, normal, offTexels), farAt = offSurface(1, p, normal, offTexels);
  bool isNear = inNearCascade(nearAt);
  vec3 at = isNear ? nearAt : farAt;
  return fadedShadow(p, compared(placeOnMap(at, isNear), at.z, texelOfMap()));
}

#endif
