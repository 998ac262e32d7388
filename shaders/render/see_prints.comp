#version 460
#extension GL_GOOGLE_include_directive : require
// Which footprints are drawn: those that are not too old, in the camera's sight, and no smaller than a pixel.
#include "footprint.glsl"
#include "lib/load4.glsl"

layout(local_size_x = WORK_GROUP) in;
LOAD4_BUFFER(DRAW_PRINTS, prints)
layout(set = 0, binding = DRAW_PRINT_COUNTS, std430) buffer CountsBlock { uint counts[]; };
layout(set = 0, binding = DRAW_PRINT_LIST, std430) writeonly buffer ListBlock { uint list[]; };

void main() {
  uint slot = gl_GlobalInvocationID.x;
  if (slot >= min(counts[PRINT_TOTAL], uint(PRINTS))) return;
  Print print = LOAD_PRINT(slot);
  if (constants.tick - print.tick >= constants.life) return;
  vec3 place = placeOf(print);
  float inside = picture.tile.z - distance(place, picture.eye.xyz);
  for (int i = 0; i < 4; ++i) inside = min(inside, dot(picture.planes[i].xyz, place) + picture.planes[i].w);
  if (inside < -print.radius || !isLargeEnough(place, print.radius)) return;
  list[atomicAdd(counts[PRINT_DRAW + 1], 1u)] = slot;
}
