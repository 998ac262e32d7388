#version 460
#extension GL_GOOGLE_include_directive : require
#include "stages/stage.glsl"
#include "lib/heightfield.glsl"

layout(set = 0, binding = BINDING_HEIGHTS) uniform sampler2D heights;
LOAD4_BUFFER(BINDING_RIG, rig);
LOAD4_BUFFER(BINDING_BODY, bodies);
LOAD4_BUFFER(BINDING_STEP, steps);
LOAD4_BUFFER(BINDING_CHAIN, chains);
LOAD4_BUFFER(BINDING_METRIC, metrics);
STORE4_BUFFER(BINDING_METRIC_OUT, metricsOut);
layout(set = 0, binding = BINDING_HISTOGRAM, std430) buffer HistogramBlock { uint histogram[]; };

void main() {
  int record = int(gl_GlobalInvocationID.x);
  if (record >= int(constants.count)) return;
  int agent = record / LEGS, leg = record - agent * LEGS;
  int at = record * METRIC_STRIDE, stepAt = record * STEP_STRIDE, rigAt = leg * rigStride(BONES);
  vec3 local = LOAD4(bodies, agent * BODY_STRIDE).xyz;
  vec2 tile = LOAD4(bodies, agent * BODY_STRIDE + 1).xy;
  vec2 stepTile = vec2(LOAD4(steps, stepAt).w, LOAD4(steps, stepAt + 1).w);
  float firstTick = LOAD4(steps, stepAt + 2).w, ticks = abs(LOAD4(steps, stepAt + 3).w);
  vec4 tip = LOAD4(chains, record * chainStride(BONES) + chainDirections(BONES));
  vec4 m0 = LOAD4(metrics, at), m1 = LOAD4(metrics, at + 1), m2 = LOAD4(metrics, at + 2);

  bool planted = constants.tick - firstTick >= ticks;
  bool plantedBefore = constants.tick - 1.0 - firstTick >= ticks;
  bool lifted = constants.tick - 1.0 == firstTick;  // the step began this tick
  vec2 offset = (tile - stepTile) * TILE_SIZE;
  vec3 here = vec3(tip.x + local.x + offset.x, tip.y + local.y, tip.z + local.z + offset.y);

  // A stance ends where the next step begins; what it slid is then final. A step that is aimed anew in the air
  // ends none.
  bool stanceEnds = lifted && m0.w >= 0.0;
  m1.x += stanceEnds ? m0.w : 0.0;
  m1.y += stanceEnds ? 1.0 : 0.0;
  float slip = planted ? (plantedBefore && m0.w >= 0.0 ? m0.w + distance(here.xz, m0.xz) : 0.0) : -1.0;

  float ground = heightAt(heights, vec2(parameters.originX, parameters.originZ),
                          vec2(parameters.inverseSpacingX, parameters.inverseSpacingZ),
                          worldOf(here, stepTile)).x;
  m1.z += max(0.0, ground - here.y);
  m1.w += planted ? max(0.0, here.y - ground) : 0.0;

  float violation = 0.0;
  for (int i = 0; i < BONES; ++i) {
    vec4 directions = LOAD4(chains, record * chainStride(BONES) + i / 2);
    float limit = LOAD4(rig, rigAt + RIG_LEG_STRIDE + RIG_BONE_STRIDE * i + 1).w;
    float over = length((i & 1) == 0 ? directions.xy : directions.zw) - limit;
    violation = max(violation, 2.0 * over / (1.0 + limit * limit));
  }
  m2 = vec4(m2.x + 1.0, m2.y + (planted ? 1.0 : 0.0), max(m2.z, tip.w), max(m2.w, violation));

  STORE4(metricsOut, at, vec4(here, slip));
  STORE4(metricsOut, at + 1, m1);
  STORE4(metricsOut, at + 2, m2);
  // A loop, because an `if` would not skip the atomic on a device that masks lanes.
  for (bool due = mod(constants.tick, HISTOGRAM_EVERY) == 1.0; due; due = false) {
    float bucket = 4.0 * (log2(max(tip.w / parameters.legLength, 1e-30)) + 20.0);
    atomicAdd(histogram[int(clamp(floor(bucket), 0.0, float(HISTOGRAM_BUCKETS - 1)))], 1u);
  }
}
