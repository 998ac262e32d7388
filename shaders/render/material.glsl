#ifndef MATERIAL_GLSL
#define MATERIAL_GLSL
// A material's textures and how it reflects light (glTF 2.0, section 3.9 and appendix B).
#include "render/material.h"

layout(constant_id = CONSTANT_TEXTURES) const int HAS_TEXTURES = 0;
layout(constant_id = CONSTANT_CUTOUT) const bool CUTOUT = false;
layout(std140, set = 0, binding = DRAW_MATERIAL) uniform MaterialBlock { MaterialNumbers material; };

bool has(int role) { return (HAS_TEXTURES & (1 << role)) != 0; }

// `uv` holds both pairs of texture coordinates.
vec2 placeOf(int role, vec4 uv) {
  vec4 first = material.rows[2 * role], second = material.rows[2 * role + 1];
  vec3 from = vec3(first.w > 0.5 ? uv.zw : uv.xy, 1.0);
  return vec2(dot(first.xyz, from), dot(second.xyz, from));
}

struct Reflector {
  vec3 diffuse;     // colour of what is scattered
  vec3 specular;    // reflected along the normal
  float alpha;      // width of the highlight: roughness, squared
  float roughness;
};

// Narrower highlights than this would be smaller than a pixel, or none at all.
const float LEAST_ROUGHNESS = 0.05;

Reflector reflectorOf(vec3 baseColour, float metallic, float roughness) {
  float r = max(roughness, LEAST_ROUGHNESS);
  return Reflector(baseColour * (1.0 - metallic), mix(vec3(0.04), baseColour, metallic), r * r, r);
}

// The share of light from `toLight` that goes to `toEye`, times pi and the cosine: Lambert's and GGX's (Walter et
// al. 2007), with height-correlated shadowing (Heitz 2014) and Schlick's Fresnel term (1994). All are unit.
vec3 reflected(Reflector r, vec3 normal, vec3 toEye, vec3 toLight) {
  float facing = max(dot(normal, toLight), 0.0), seen = max(dot(normal, toEye), 1e-4);
  vec3 halfway = normalize(toEye + toLight + vec3(0.0, 1e-6, 0.0));
  float aligned = max(dot(normal, halfway), 0.0), grazing = 1.0 - max(dot(toEye, halfway), 0.0);
  float a2 = r.alpha * r.alpha, grazing2 = grazing * grazing;
  float spread = aligned * aligned * (a2 - 1.0) + 1.0;
  float visible = 0.5 / max(facing * sqrt(seen * seen * (1.0 - a2) + a2) + seen * sqrt(facing * facing * (1.0 - a2) + a2),
                            1e-6);
  vec3 fresnel = r.specular + (1.0 - r.specular) * (grazing2 * grazing2 * grazing);
  return ((1.0 - fresnel) * r.diffuse + fresnel * (a2 / (spread * spread) * visible)) * facing;
}

// The share of light from all about that is mirrored to the eye (Karis 2014, "Physically Based Shading on Mobile").
vec3 mirrored(Reflector r, float seen) {
  vec4 fit = r.roughness * vec4(-1.0, -0.0275, -0.572, 0.022) + vec4(1.0, 0.0425, 1.04, -0.04);
  float bias = min(fit.x * fit.x, exp2(-9.28 * seen)) * fit.x + fit.y;
  return r.specular * (-1.04 * bias + fit.z) + (1.04 * bias + fit.w);
}

#endif
