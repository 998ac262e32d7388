#ifndef FOOTPRINT_GLSL
#define FOOTPRINT_GLSL
// Footprints (docs/stages/pictures.md).
#include "picture.glsl"
#include "skitter/records.h"

layout(push_constant) uniform ConstantBlock { FootprintConstants constants; };

struct Print {
  vec3 local;  // world in y
  float tile;
  float tick, radius;
};

// Reads the buffer `prints`.
Print unpackPrint(vec4 a, vec4 b) { return Print(a.xyz, a.w, b.x, b.y); }
#define LOAD_PRINT(slot) \
  unpackPrint(LOAD4(prints, int(slot) * PRINT_STRIDE), LOAD4(prints, int(slot) * PRINT_STRIDE + 1))

// In picture space.
vec3 placeOf(Print print) {
  return print.local + TILE_SIZE * vec3(tileX(print.tile) - picture.tile.x, 0.0, tileZ(print.tile) - picture.tile.y);
}

bool isLargeEnough(vec3 place, float radius) {
  return radius > 0.5 * distance(place, picture.eye.xyz) * picture.eye.w;
}

#endif
