#version 460
#extension GL_GOOGLE_include_directive : require
#include "stages/awake.glsl"
#include "shared/ik_batch.h"
#include "lib/clip.glsl"
#include "stages/hurt.glsl"

LOAD4_BUFFER(BINDING_BODY, bodies);
LOAD4_BUFFER(BINDING_PLAY, plays);
LOAD4_BUFFER(BINDING_CLIP_ROW, rows);
#ifdef PLANTED
LOAD4_BUFFER(BINDING_CLIP_JOINT, joints);
LOAD4_BUFFER(BINDING_FIX, fixes);
#endif
#ifdef HURT
LOAD4_BUFFER(BINDING_CLIP_LEG, legs);
#endif
STORE4_BUFFER(BINDING_POSE_OUT, posesOut);

layout(set = 0, binding = BINDING_COUNTERS, std430) readonly buffer CountersBlock { uint counters[]; };
layout(set = 0, binding = BINDING_LIST, std430) readonly buffer ListBlock { uint list[]; };

void main() {
  int record = int(gl_GlobalInvocationID.x);
  int agent = record / JOINTS, joint = record - agent * JOINTS;
  if (PASS == PASS_LISTED) {
    if (agent >= int(counters[COUNTER_LISTED])) return;
    agent = int(list[agent]);
  } else {
    agent = agentAt(agent);
    if (agent < 0) return;
  }
  int playAt = agent * PLAY_STRIDE;
  Play play = unpackPlay(LOAD4(plays, playAt), LOAD4(plays, playAt + 1), LOAD4(plays, playAt + 2));
  mat3 turned = matrixOf(LOAD4(bodies, agent * BODY_STRIDE + 2));
  if (PASS == PASS_QUICK && play.weight < 1.0) return;
  vec4 m[3];
  LOAD_MATRIX(m, rows, play, joint);
  mat4x3 column = transpose(mat3x4(m[0], m[1], m[2]));
#ifdef PLANTED
  int bone = int(LOAD4(joints, joint).x), own = max(bone, 0);
  int fixAt = (legRecord(agent, own / BONES, LEGS) * BONES + own % BONES) * FIX_STRIDE;
  mat3 fix = matrixOf(bone >= 0 ? LOAD4(fixes, fixAt) : vec4(0.0, 0.0, 0.0, 1.0));
  column = fix * column;
  column[3] += bone >= 0 ? LOAD4(fixes, fixAt + 1).xyz : vec3(0.0);
#ifdef HURT
  int leg = own / BONES, whole = bone >= 0 ? lostFrom(agent, leg) : BONES;
  // All of the skin of lost bones is drawn to the stump's end, where the first of them starts.
  if (own % BONES >= whole) {
    vec4 place = LOAD4(legs, leg * (BONES + 1) + whole);
    LOAD_MATRIX(m, rows, play, int(place.w));
    fixAt = (legRecord(agent, leg, LEGS) * BONES + whole) * FIX_STRIDE;
    vec3 end = matrixOf(LOAD4(fixes, fixAt)) * transformed(m, place.xyz) + LOAD4(fixes, fixAt + 1).xyz;
    column = mat4x3(vec3(0.0), vec3(0.0), vec3(0.0), end);
  }
#endif
#endif
  mat3x4 row = transpose(turned * column);
  for (int r = 0; r < 3; ++r) STORE4(posesOut, (agent * JOINTS + joint) * MATRIX_STRIDE + r, row[r]);
}
