#ifndef RECORDS_GLSL
#define RECORDS_GLSL
// The records of include/skitter/records.h, unpacked.

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

// Reads the buffer `bodies`. It is a macro because GLSL cannot pass a buffer to a function.
#define LOAD_BODY(agent)                                                                     \
  unpackBody(LOAD4(bodies, (agent) * BODY_STRIDE), LOAD4(bodies, (agent) * BODY_STRIDE + 1), \
             LOAD4(bodies, (agent) * BODY_STRIDE + 2), LOAD4(bodies, (agent) * BODY_STRIDE + 3))

struct Step {
  vec3 landing, liftOff;  // local to the tile in x and z, world in y
  float tile;             // stepTile
  float firstTick, ticks;
  bool lastResort;
};

Step unpackStep(vec4 a, vec4 b) {
  return Step(a.xyz, b.xyz, tileOfTicks(b.w), a.w, ticksOf(b.w), b.w < 0.0);
}

// Reads the buffer `steps`.
#define LOAD_STEP(leg) \
  inOwnTicks(unpackStep(LOAD4(steps, (leg) * STEP_STRIDE), LOAD4(steps, (leg) * STEP_STRIDE + 1)))

// A step's end is compared, not divided: Vulkan lets a device round n / n down.
float stepProgress(Step s, float tick) {
  float flown = tick - s.firstTick;
  return flown >= s.ticks ? 1.0 : max(flown / s.ticks, 0.0);
}

// A point relative to a body's position, along world axes; its tile is so many off from the body's.
vec3 fromTile(vec3 point, vec2 apart, vec3 bodyLocal) {
  vec2 offset = apart * TILE_SIZE;
  return point + vec3(offset.x - bodyLocal.x, -bodyLocal.y, offset.y - bodyLocal.z);
}
vec3 fromStep(vec3 point, Step s, vec3 bodyLocal, vec2 bodyTile) {
  float apart = tilesApart(s.tile, stepTile(bodyTile.x, bodyTile.y));
  return fromTile(point, vec2(apartX(apart), apartZ(apart)), bodyLocal);
}

struct Arc {
  vec3 lift, startTangent;
};

// Reads the buffer `arcs`.
#define LOAD_ARC(leg) Arc(LOAD4(arcs, (leg) * ARC_STRIDE).xyz, LOAD4(arcs, (leg) * ARC_STRIDE + 1).xyz)

// A leg's miss in the tick before, which is `last`, of a pair of legs' record.
float missTold(vec4 pairs, int leg, float last) {
  vec2 told = leg % 2 == 0 ? pairs.xy : pairs.zw;
  return told.y == last ? told.x : 0.0;
}
// Reads the buffer `misses`.
#define LOAD_MISS(agent, leg) missTold(LOAD4(misses, (agent) * missStride(LEGS) + (leg) / 2), leg, lastTick())

vec2 worldOf(vec3 local, vec2 tile) { return tile * TILE_SIZE + local.xz; }

#endif
