#ifndef RECORDS_GLSL
#define RECORDS_GLSL
// The records of shaders/shared/records.h, unpacked.

struct Body {
  vec3 local;         // x and z within the tile, world y
  vec2 tile;
  vec2 heading;       // unit, world x, z
  float speed;        // horizontal, along the heading
  vec4 orientation;   // R_0
  float turnRate, still, follow, surfaceSpeed;
};

vec2 tileOf(float tile) { return vec2(tileX(tile), tileZ(tile)); }

Body unpackBody(vec4 a, vec4 b, vec4 c, vec4 d) {
  return Body(a.xyz, tileOf(a.w), b.xy, b.z, c, d.x, d.y, d.z, d.w);
}

// Of the buffer `bodies`; a macro, as GLSL cannot pass one to a function.
#define LOAD_BODY(agent)                                                                     \
  unpackBody(LOAD4(bodies, (agent) * BODY_STRIDE), LOAD4(bodies, (agent) * BODY_STRIDE + 1), \
             LOAD4(bodies, (agent) * BODY_STRIDE + 2), LOAD4(bodies, (agent) * BODY_STRIDE + 3))

struct Step {
  vec3 landing, liftOff;  // tile-local in x and z, world in y
  vec2 tile;
  vec3 lift, startTangent;
  float firstTick, ticks;
  bool lastResort;
};

Step unpackStep(vec4 a, vec4 b, vec4 c, vec4 d) {
  return Step(a.xyz, b.xyz, vec2(a.w, b.w), vec3(c.zw, d.w), d.xyz, c.x, abs(c.y), c.y < 0.0);
}

// Of the buffer `steps`.
#define LOAD_STEP(leg)                                                                   \
  unpackStep(LOAD4(steps, (leg) * STEP_STRIDE), LOAD4(steps, (leg) * STEP_STRIDE + 1), \
             LOAD4(steps, (leg) * STEP_STRIDE + 2), LOAD4(steps, (leg) * STEP_STRIDE + 3))

float stepProgress(Step s, float tick) { return clamp((tick - s.firstTick) / s.ticks, 0.0, 1.0); }

// A point of a step relative to a body's position, along world axes.
vec3 fromTile(vec3 point, vec2 tile, vec3 bodyLocal, vec2 bodyTile) {
  vec2 offset = (tile - bodyTile) * TILE_SIZE;
  return point + vec3(offset.x - bodyLocal.x, -bodyLocal.y, offset.y - bodyLocal.z);
}

// A leg's miss in the tick before, of a pair of legs' record.
float missTold(vec4 pairs, int leg, float tick) {
  vec2 told = leg % 2 == 0 ? pairs.xy : pairs.zw;
  return told.y == tick - 1.0 ? told.x : 0.0;
}
// Of the buffer `misses`.
#define LOAD_MISS(agent, leg) missTold(LOAD4(misses, (agent) * missStride(LEGS) + (leg) / 2), leg, thisTick)

vec2 worldOf(vec3 local, vec2 tile) { return tile * TILE_SIZE + local.xz; }

#endif
