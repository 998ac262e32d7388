#ifndef LIGHT_GLSL
#define LIGHT_GLSL
// One light for all that is drawn: sun or moon, a sky, and haze of the horizon's colour (render/light.h).

#define LIGHT_NUMBER(name, at) layout(constant_id = CONSTANT_LIGHT + (at)) const float name = 0.0;
#define LIGHT_COLOUR(name, at)        \
  LIGHT_NUMBER(name##_RED, at)        \
  LIGHT_NUMBER(name##_GREEN, (at) + 1) \
  LIGHT_NUMBER(name##_BLUE, (at) + 2) \
  const vec3 name = vec3(name##_RED, name##_GREEN, name##_BLUE);
LIGHT_COLOUR(SUN_LIGHT, 0)  // on a white surface that faces it
LIGHT_NUMBER(EXPOSURE, 3)
LIGHT_COLOUR(ZENITH, 4)
LIGHT_NUMBER(HAZE, 7)  // how soon the horizon's colour is gone
LIGHT_COLOUR(HORIZON, 8)
LIGHT_COLOUR(GLOW, 11)  // about the sun
LIGHT_NUMBER(DISC, 14)  // the sun's brightness, in sunlights
// What a normal's 1, y, s, y y, s s and y s are multiplied by, s = dot(normal.xz, sun.xz).
LIGHT_COLOUR(AMBIENT, 15)
LIGHT_COLOUR(AMBIENT_Y, 18)
LIGHT_COLOUR(AMBIENT_S, 21)
LIGHT_COLOUR(AMBIENT_YY, 24)
LIGHT_COLOUR(AMBIENT_SS, 27)
LIGHT_COLOUR(AMBIENT_YS, 30)

// About the sun; `towards` is the cosine of the angle to it.
vec3 glow(float towards, float strength) {
  towards *= towards;
  towards *= towards;
  return GLOW * (towards * towards * strength);
}

// Sky radiance in a unit direction; below the horizon the haze goes on.
vec3 skyColour(vec3 direction, vec3 sun) {
  float up = max(direction.y, 0.0);
  float towards = max(dot(direction, sun), 0.0);
  return mix(ZENITH, HORIZON, exp2(-HAZE * up)) +
         glow(towards, 0.35 + 0.65 * exp2(-5.0 * up));
}

vec3 sunDisc(vec3 direction, vec3 sun) {
  float towards = dot(direction, sun);
  return SUN_LIGHT * DISC *
         (smoothstep(0.99986, 0.99993, towards) + 0.06 * exp2(-900.0 * (1.0 - towards)));
}

// The light of sky and ground on a surface, from the sky's own radiance (ambientOf in render/light.cpp).
vec3 ambientLight(vec3 normal) {
  float s = dot(normal.xz, picture.sun.xz);
  return AMBIENT + normal.y * (AMBIENT_Y + normal.y * AMBIENT_YY + s * AMBIENT_YS) + s * (AMBIENT_S + s * AMBIENT_SS);
}

// The haze between the eye and what it sees has the colour of the sky at the horizon, and leaves a share.
struct Haze {
  vec3 colour;
  float left;
};

Haze hazeOf(vec3 direction, float distanceToEye, float density, vec3 sun) {
  float depth = distanceToEye * density;
  float towards = max(dot(direction.xz, sun.xz), 0.0) * inversesqrt(max(dot(direction.xz, direction.xz), 1e-8));
  return Haze(HORIZON + glow(towards, 1.0), exp(-depth * depth));
}
vec3 hazed(vec3 colour, Haze haze) { return mix(haze.colour, colour, haze.left); }
vec3 hazed(vec3 colour, vec3 direction, float distanceToEye, float density, vec3 sun) {
  return hazed(colour, hazeOf(direction, distanceToEye, density, sun));
}

layout(constant_id = CONSTANT_ROOTS) const bool ROOTS = false;

// A filmic curve (Narkowicz 2016, "ACES Filmic Tone Mapping Curve"); the attachment makes sRGB of it. What the
// edge filter reads are roots in a plain attachment: a software device pays dearly for reading sRGB.
vec3 developed(vec3 x) {
  x *= EXPOSURE;
  vec3 colour = clamp((x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0);
  return ROOTS ? sqrt(colour) : colour;
}

#endif
