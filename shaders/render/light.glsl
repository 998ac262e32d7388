#ifndef LIGHT_GLSL
#define LIGHT_GLSL
// One light for all that is drawn: a low warm sun, a blue sky, and haze of the horizon's colour.
// Radiances are linear, relative to a white surface that reads as about 0.8 after developed().

const vec3 SUN_LIGHT = vec3(3.10, 2.55, 1.85);
const vec3 SKY_LIGHT = vec3(0.31, 0.43, 0.66);     // from straight above
const vec3 BOUNCE_LIGHT = vec3(0.25, 0.19, 0.13);  // from sunlit ground
const vec3 ZENITH = vec3(0.07, 0.20, 0.56);
const vec3 HORIZON = vec3(0.56, 0.66, 0.78);

// About the sun; `towards` is the cosine of the angle to it.
vec3 glow(float towards, float strength) {
  towards *= towards;
  towards *= towards;
  return vec3(0.42, 0.25, 0.10) * towards * towards * strength;
}

// Sky radiance in a unit direction; below the horizon the haze goes on.
vec3 skyColour(vec3 direction, vec3 sun) {
  float up = max(direction.y, 0.0);
  float towards = max(dot(direction, sun), 0.0);
  return mix(ZENITH, HORIZON, exp2(-9.0 * up)) + glow(towards, 0.35 + 0.65 * exp2(-5.0 * up));
}

vec3 sunDisc(vec3 direction, vec3 sun) {
  float towards = dot(direction, sun);
  return SUN_LIGHT * (6.0 * smoothstep(0.99986, 0.99993, towards) + 0.35 * exp2(-900.0 * (1.0 - towards)));
}

vec3 ambientLight(vec3 normal) { return mix(BOUNCE_LIGHT, SKY_LIGHT, 0.5 + 0.5 * normal.y); }

// `colour` seen from the eye through the haze, which has the colour of the sky at the horizon.
vec3 hazed(vec3 colour, vec3 direction, float distanceToEye, float density, vec3 sun) {
  float depth = distanceToEye * density;
  float towards = max(dot(direction.xz, sun.xz), 0.0) * inversesqrt(max(dot(direction.xz, direction.xz), 1e-8));
  return mix(HORIZON + glow(towards, 1.0), colour, exp(-depth * depth));
}

layout(constant_id = CONSTANT_ROOTS) const bool ROOTS = false;

// A filmic curve (Narkowicz 2016, "ACES Filmic Tone Mapping Curve"); the attachment makes sRGB of it. What the
// edge filter reads are roots in a plain attachment: a software device pays dearly for reading sRGB.
vec3 developed(vec3 x) {
  x *= 0.62;
  vec3 colour = clamp((x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0);
  return ROOTS ? sqrt(colour) : colour;
}

#endif
