#version 460
#extension GL_GOOGLE_include_directive : require
// Crowds whose models have materials; crowd.frag shades all others.
#include "picture.glsl"
#include "light.glsl"
#include "shadow_map.glsl"
#include "material.glsl"
#include "tint.h"
#ifdef FADES
#include "fade.glsl"
layout(location = FADE_LOCATION) flat in uint fade;
#endif

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 wornNormal;
layout(location = 2) in vec4 colour;   // linear RGB, opacity
layout(location = 3) in vec2 light;    // openness to the sky, sunlight that hills leave
layout(location = 4) in vec4 tint;     // times the colour; of which only the lightness counts where w is 1
layout(location = 5) in vec4 uv;       // both texture coordinates
layout(location = 6) in vec4 tangent;  // w: the side of the image's top
layout(location = 0) out vec4 outColour;
layout(set = 0, binding = DRAW_TEXTURES + BASE_COLOUR) uniform sampler2D baseColours;
layout(set = 0, binding = DRAW_TEXTURES + METALLIC_ROUGHNESS) uniform sampler2D roughnesses;
layout(set = 0, binding = DRAW_TEXTURES + NORMAL) uniform sampler2D normals;
layout(set = 0, binding = DRAW_TEXTURES + OCCLUSION) uniform sampler2D occlusions;
layout(set = 0, binding = DRAW_TEXTURES + EMISSIVE) uniform sampler2D emissives;

// As the normal texture bends it.
vec3 bentNormal(vec3 normal) {
  if (has(NORMAL)) {
    vec3 across = tangent.xyz - dot(tangent.xyz, normal) * normal;
    across *= inversesqrt(max(dot(across, across), 1e-12));
    vec3 up = cross(normal, across) * (tangent.w < 0.0 ? -1.0 : 1.0);
    vec3 bump = texture(normals, placeOf(NORMAL, uv)).xyz * 2.0 - 1.0;
    bump.xy *= material.factors.z;
    normal = normalize(bump.x * across + bump.y * up + bump.z * normal);
  }
  return normal;
}

void main() {
  vec3 toEye = picture.eye.xyz - position;
  float away = length(toEye);
  toEye /= away;
  vec3 sun = picture.sun.xyz;
  // All is shaded from the side that is seen.
  float side = gl_FrontFacing ? 1.0 : -1.0;
  vec3 outward = normalize(wornNormal), normal = side * bentNormal(outward);

  vec4 base = colour;
  if (has(BASE_COLOUR)) base *= texture(baseColours, placeOf(BASE_COLOUR, uv));
  if (tint.w > 0.5) base.rgb = vec3(dot(base.rgb, vec3(RED_LIGHTNESS, GREEN_LIGHTNESS, BLUE_LIGHTNESS)));
  base.rgb *= tint.rgb;
  vec2 surface = material.factors.xy;
  if (has(METALLIC_ROUGHNESS)) surface *= texture(roughnesses, placeOf(METALLIC_ROUGHNESS, uv)).bg;
  float open = light.x;
  if (has(OCCLUSION))
    open *= 1.0 + material.factors.w * (texture(occlusions, placeOf(OCCLUSION, uv)).r - 1.0);
  vec3 glowing = material.emissive.rgb;
  if (has(EMISSIVE)) glowing *= texture(emissives, placeOf(EMISSIVE, uv)).rgb;

  Reflector reflector = reflectorOf(base.rgb, surface.x, surface.y);
  float lit = light.y * sunlightOnce(position, side * outward, 3.0);
  float seen = max(dot(normal, toEye), 0.0);
  vec3 ambient = ambientLight(normal) * reflector.diffuse + ambientLight(reflect(-toEye, normal)) * mirrored(reflector, seen);
  vec3 shaded = SUN_LIGHT * lit * reflected(reflector, normal, toEye, sun) + ambient * open + glowing;
  // After every look-up, whose level follows from the pixels beside.
  if (CUTOUT && base.a < material.emissive.w) discard;
#ifdef FADES
  if (isFaded(uvec2(gl_FragCoord.xy), fade)) discard;
#endif
  outColour = vec4(developed(hazed(shaded, -toEye, away, picture.tile.w, sun)), 1.0);
}
