#version 460
#extension GL_GOOGLE_include_directive : require
#include "picture.glsl"
#include "skin.glsl"
#include "hash.glsl"

layout(location = 8) in vec3 colour;
layout(set = 0, binding = DRAW_GROUND) uniform sampler2D groundMap;

layout(location = 0) out vec3 outPosition;
layout(location = 1) out vec3 outNormal;
layout(location = 2) out vec4 outColour;  // linear RGB; openness to the sky
layout(location = 3) out float outSun;    // sunlight that hills leave

void main() {
  Skinned s = skinned();
  vec3 toEye = picture.eye.xyz - s.position;
  float away = length(toEye);
  spread(s, toEye / away, away * picture.eye.w);
  gl_Position = picture.clipFromPicture[VIEW_CAMERA] * vec4(s.position, 1.0);
  outPosition = s.position;
  outNormal = s.normal;

  vec2 at = (s.body.xz - picture.ground.xy) / picture.ground.zw;
  vec4 ground = textureLod(groundMap, (at + 0.5) / vec2(textureSize(groundMap, 0)), 0.0);
  float above = dot(s.position - s.body, normalize(vec3(-ground.x, 1.0, -ground.y)));
  float openness = ground.z * clamp(0.45 + 1.1 * above, 0.3, 1.0);

  // No two alike: a little lighter or darker, redder or greyer.
  uint h = hashed(uvec2(agent + constants.firstAgent, constants.kind));
  float value = 0.75 + 0.6 * unitOf(h), warmth = unitOf(h * 0x9E3779B1u) - 0.5;
  outColour = vec4(colour * value * vec3(1.0 + 0.35 * warmth, 1.0, 1.0 - 0.35 * warmth), openness);
  outSun = ground.w;
}
