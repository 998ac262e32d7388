#ifndef LIGHT_GLSL
#define LIGHT_GLSL
// One light for all that is drawn: sun or moon, a sky, and haze of the horizon's colour (render/light.h).

// About the sun; `towards` is the cosine of the angle to it.
vec3 glow(float towards, float strength) {
  towards *= towards;
  towards *= towards;
  return picture.glow.rgb * (towards * towards * strength);
}

// Sky radiance in a unit direction; below the horizon the haze goes on.
vec3 skyColour(vec3 direction, vec3 sun) {
  float up = max(direction.y, 0.0);
  float towards = max(dot(direction, sun), 0.0);
  return mix(picture.zenith.rgb, picture.horizon.rgb, exp2(-picture.zenith.w * up)) +
         glow(towards, 0.35 + 0.65 * exp2(-5.0 * up));
}

vec3 sunDisc(vec3 direction, vec3 sun) {
  float towards = dot(direction, sun);
  return picture.sunlight.rgb * picture.glow.w *
         (smoothstep(0.99986, 0.99993, towards) + 0.06 * exp2(-900.0 * (1.0 - towards)));
}

// The light of sky and ground on a surface, from the sky's own radiance (ambientOf in render/light.cpp).
vec3 ambientLight(vec3 normal) {
  float s = dot(normal.xz, picture.sun.xz);
  return picture.ambient[0].rgb +
         normal.y * (picture.ambient[1].rgb + normal.y * picture.ambient[3].rgb + s * picture.ambient[5].rgb) +
         s * (picture.ambient[2].rgb + s * picture.ambient[4].rgb);
}

// `colour` seen from the eye through the haze, which has the colour of the sky at the horizon.
vec3 hazed(vec3 colour, vec3 direction, float distanceToEye, float density, vec3 sun) {
  float depth = distanceToEye * density;
  float towards = max(dot(direction.xz, sun.xz), 0.0) * inversesqrt(max(dot(direction.xz, direction.xz), 1e-8));
  return mix(picture.horizon.rgb + glow(towards, 1.0), colour, exp(-depth * depth));
}

layout(constant_id = CONSTANT_ROOTS) const bool ROOTS = false;

// A filmic curve (Narkowicz 2016, "ACES Filmic Tone Mapping Curve"); the attachment makes sRGB of it. What the
// edge filter reads are roots in a plain attachment: a software device pays dearly for reading sRGB.
vec3 developed(vec3 x) {
  x *= picture.sunlight.w;
  vec3 colour = clamp((x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0);
  return ROOTS ? sqrt(colour) : colour;
}

#endif
