#version 460
#extension GL_GOOGLE_include_directive : require
// One sample of each agent's trial (docs/evolve.md).
#include "lib/load4.glsl"
#include "shared/bindings.h"
#include "shared/trial.h"
#include "skitter/records.h"
#include "lib/math.glsl"
#include "lib/records.glsl"

layout(local_size_x = WORK_GROUP) in;
layout(constant_id = CONSTANT_LEGS) const int LEGS = 8;
#include "lib/support.glsl"
layout(push_constant) uniform TrialBlock { TrialConstants trial; };

LOAD4_BUFFER(BINDING_BODY, bodies);
LOAD4_BUFFER(BINDING_GAIT, gaits);
LOAD4_BUFFER(BINDING_FOOT, feet);
LOAD4_BUFFER(BINDING_TIP, tips);
LOAD4_BUFFER(BINDING_TRIAL, trials);
STORE4_BUFFER(BINDING_TRIAL_OUT, trialsOut);

// From one sample to the next, across tiles.
vec3 moved(vec3 now, vec3 before) {
  vec3 way = now - before;
  way.xz -= TILE_SIZE * floor(way.xz / TILE_SIZE + 0.5);
  return way;
}

void main() {
  int agent = int(gl_GlobalInvocationID.x);
  if (uint(agent) >= trial.count) return;
  int at = agent * trialStride(LEGS), firstLeg = legRecord(agent, 0, LEGS);
  bool counts = trial.begins == 0u;
  float one = counts ? 1.0 : 0.0;
  vec3 local = LOAD4(bodies, agent * BODY_STRIDE).xyz;
  vec2 centre = rotate(LOAD4(bodies, agent * BODY_STRIDE + 2), vec3(0.0, trial.bodyHeight, 0.0)).xz;
  float phase = LOAD4(gaits, agent * GAIT_STRIDE).x;
  vec4 sums = LOAD4(trials, at), most = LOAD4(trials, at + 1), last = LOAD4(trials, at + 2);
  sums = counts ? sums : vec4(0.0);
  most = counts ? most : vec4(0.0);

  vec2 q[LEGS];
  uint support = 0u;
  for (int leg = 0; leg < LEGS; ++leg) {
    vec4 tip = LOAD4(tips, firstLeg + leg * BLOCK), before = LOAD4(trials, at + TRIAL_LEGS + leg);
    bool planted = LOAD4(feet, firstLeg + leg * BLOCK).w >= 1.0;
    float stood = counts ? floor(0.5 * before.w) : 0.0;
    bool stays = counts && planted && before.w > 2.0 * stood;
    vec3 place = tip.xyz + local;
    most.x += stays ? length(moved(place, before.xyz).xz) : 0.0;
    most.y = counts ? max(most.y, tip.w) : 0.0;
    STORE4(trialsOut, at + TRIAL_LEGS + leg,
           vec4(place, 2.0 * (stood + (planted ? one : 0.0)) + (planted ? 1.0 : 0.0)));
    q[leg] = tip.xz - centre;
    support |= planted ? 1u << leg : 0u;
  }
  float margin = marginOfPlanted(q, support, trial.legLength);

  float turned = phase - last.w;
  turned -= floor(turned);
  most.z = counts && sums.x > 0.0 ? min(most.z, margin) : margin;
  sums += one * vec4(1.0, moved(local, last.xyz).z, turned, margin < trial.safe ? 1.0 : 0.0);
  STORE4(trialsOut, at, sums);
  STORE4(trialsOut, at + 1, most);
  STORE4(trialsOut, at + 2, vec4(local, phase));
}
