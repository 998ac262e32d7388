#version 460
#extension GL_GOOGLE_include_directive : require
#include "picture.glsl"
#include "skin.glsl"
#ifdef LIT
#include "light.glsl"
#include "shadow_map.glsl"
#include "chitin.glsl"
#endif

layout(location = 8) in vec3 colour;
layout(set = 0, binding = DRAW_GROUND) uniform sampler2D groundMap;
#include "variation.glsl"

#ifdef LIT
layout(location = 0) out vec3 outColour;  // as the picture shows it
#else
layout(location = 0) out vec3 outPosition;
layout(location = 1) out vec3 outNormal;
#endif
#ifdef WORN
layout(location = 9) in vec4 uv;
layout(location = 11) in float opacity;
layout(location = 2) out vec4 outColour;   // linear RGB, opacity
layout(location = 3) out vec2 outLight;    // openness to the sky, sunlight that hills leave
layout(location = 4) out vec4 outTint;     // times the colour; of which only the lightness counts where w is 1
layout(location = 5) out vec4 outUv;
layout(location = 6) out vec4 outTangent;
#elif !defined(LIT)
layout(location = 2) out vec4 outColour;  // linear RGB; openness to the sky
layout(location = 3) out float outSun;    // sunlight that hills leave
#endif

void main() {
  Skinned s = skinned();
  vec3 toEye = picture.eye.xyz - s.position;
  float away = length(toEye);
  spread(s, toEye / away, away * picture.eye.w);
  gl_Position = picture.clipFromPicture[VIEW_CAMERA] * vec4(s.position, 1.0);
#ifndef LIT
  outPosition = s.position;
  outNormal = s.normal;
#endif

  vec2 at = (s.body.xz - picture.ground.xy) / picture.ground.zw;
  vec4 ground = textureLod(groundMap, (at + 0.5) / vec2(textureSize(groundMap, 0)), 0.0);
  float above = dot(s.position - s.body, normalize(vec3(-ground.x, 1.0, -ground.y)));
  float openness = ground.z * clamp(0.45 + 1.1 * above, 0.3, 1.0);

  Variation variation = variationOf(agent, agent + constants.firstAgent, constants.kind);
#ifdef WORN
  // The textures' colours come before all that.
  outColour = vec4(colour, opacity);
  outTint = vec4(variation.times, variation.lightness ? 1.0 : 0.0);
  outLight = vec2(openness, ground.w);
  outUv = uv;
  outTangent = vec4(s.tangent, tangent.w);
#else
  vec4 seen = vec4(varied(variation, colour), openness);
#ifdef LIT
  vec3 normal = normalize(s.normal);
  // On a sphere the rim's mean is 0.1. The triangles of a coarse one would spread that of the outline over all of it,
  // and so they would the sheen.
  outColour = chitin(seen, normal, toEye / away, away, ground.w * sunlightOnce(s.position, normal, 3.0), 0.1, 0.0);
#else
  outColour = seen;
  outSun = ground.w;
#endif
#endif
}
