#version 460
#extension GL_GOOGLE_include_directive : require
// Each foot that has left the ground since the last picture leaves a print where it stood.
#include "decal.glsl"
#include "footprint.glsl"
#include "lib/load4.glsl"
#include "lib/records.glsl"

layout(local_size_x = WORK_GROUP) in;
LOAD4_BUFFER(DRAW_BODY, bodies)
LOAD4_BUFFER(DRAW_STEP, steps)
STORE4_BUFFER(DRAW_PRINTS_OUT, printsOut)
// The first tick of each leg's step, as the last picture found it; PRINT_UNSEEN before its first one.
layout(set = 0, binding = DRAW_PRINT_STEPS, std430) buffer LastBlock { float last[]; };
layout(set = 0, binding = DRAW_PRINT_COUNTS, std430) buffer CountsBlock { uint counts[]; };

void main() {
  int record = int(gl_GlobalInvocationID.x), legs = int(constants.legs);
  if (record >= int(constants.records) || agentOfRecord(record, legs) >= int(constants.agents)) return;
  vec4 landing = LOAD4(steps, record * STEP_STRIDE), liftOff = LOAD4(steps, record * STEP_STRIDE + 1);
  float before = last[record];
  if (before == landing.w) return;
  last[record] = landing.w;
  if (before == float(PRINT_UNSEEN)) return;

  float tile = LOAD4(bodies, agentOfRecord(record, legs) * BODY_STRIDE).w;
  float apart = tilesApart(tileOfTicks(liftOff.w), stepTile(tileX(tile), tileZ(tile)));
  vec2 at = vec2(tileX(tile) + apartX(apart), tileZ(tile) + apartZ(apart));
  Print made = Print(liftOff.xyz, packedTile(at.x, at.y), constants.tick, constants.radius);
  vec3 place = placeOf(made);
  // A step that was aimed anew began in the air.
  bool stood = abs(place.y - groundAt(decalField(), place.xz)) < 0.25 * made.radius;
  if (!stood || !isLargeEnough(place, made.radius)) return;
  uint left = atomicAdd(counts[PRINT_TOTAL], 1u), slot = left % PRINTS;
  if (left == slot) atomicMax(counts[PRINT_GROUPS], slot / WORK_GROUP + 1u);
  STORE4_TWO(printsOut, int(slot) * PRINT_STRIDE, vec4(made.local, made.tile), vec4(made.tick, made.radius, 0.0, 0.0));
}
