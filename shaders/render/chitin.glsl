#ifndef CHITIN_GLSL
#define CHITIN_GLSL

// The colour that a creature without materials has in the picture. `colour` is linear RGB and openness to the sky,
// `lit` is the share of sunlight that nothing takes away, `normal` and `toEye` are unit, and `away` is in metres. The
// rim has at most `mostRim`, and the sheen is `gloss`.
vec3 chitin(vec4 colour, vec3 normal, vec3 toEye, float away, float lit, float mostRim, float gloss) {
  vec3 sun = picture.sun.xyz;
  float facing = max(dot(normal, sun), 0.0);
  // A dull sheen of chitin, and a rim of skylight that parts dark creatures from dark ground.
  vec3 halfway = normalize(toEye + sun);
  float sheen = max(dot(normal, halfway), 0.0);
  sheen *= sheen; sheen *= sheen; sheen *= sheen; sheen *= sheen; sheen *= sheen;
  float rim = 1.0 - max(dot(normal, toEye), 0.0);
  rim = min(rim * rim * rim, mostRim);
  vec3 ambient = ambientLight(normal) * colour.a;
  vec3 light = colour.rgb * (SUN_LIGHT * (facing * lit) + ambient) +
               SUN_LIGHT * (gloss * sheen * lit * smoothstep(0.0, 0.15, facing)) +
               ambient * rim * 0.35;
  return developed(hazed(light, -toEye, away, picture.tile.w, sun));
}

#endif
