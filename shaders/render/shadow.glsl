#ifndef SHADOW_GLSL
#define SHADOW_GLSL
layout(set = 0, binding = DRAW_SHADOW) uniform sampler2DShadow shadowMap;

// The share of sunlight that no agent takes away at picture point `p`; `normal` moves the point off surfaces
// that cast shadows themselves by `offTexels` texels, so that they do not shade themselves. Both cascades'
// points are worked out and one is looked up: on software devices a branch is paid for on both sides.
float sunlight(vec3 p, vec3 normal, float offTexels) {
  vec3 nearAt = (picture.clipFromPicture[1] * vec4(p + normal * (offTexels * picture.shadow.x), 1.0)).xyz;
  vec3 farAt = (picture.clipFromPicture[2] * vec4(p + normal * (offTexels * picture.shadow.y), 1.0)).xyz;
  bool isNear = max(abs(nearAt.x), abs(nearAt.y)) < 0.98;
  float edge = max(abs(farAt.x), abs(farAt.y));
  vec3 at = isNear ? nearAt : farAt;
  vec2 texel = vec2(0.5, 1.0) / picture.shadow.w;
  vec2 uv = at.xy * vec2(0.25, 0.5) + vec2(isNear ? 0.25 : 0.75, 0.5);
  // Four bilinear comparisons make a smooth 3 x 3 kernel.
  float sum = texture(shadowMap, vec3(uv + texel * vec2(-0.5, -0.5), at.z)) +
              texture(shadowMap, vec3(uv + texel * vec2(0.5, -0.5), at.z)) +
              texture(shadowMap, vec3(uv + texel * vec2(-0.5, 0.5), at.z)) +
              texture(shadowMap, vec3(uv + texel * vec2(0.5, 0.5), at.z));
  float fade = smoothstep(0.8, 0.96, edge);
  return edge < 0.96 ? mix(0.25 * sum, 1.0, fade) : 1.0;
}

#endif
