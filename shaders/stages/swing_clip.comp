#version 460
#extension GL_GOOGLE_include_directive : require
#define ONLY_CONES
#include "stages/awake.glsl"
#include "shared/ik_batch.h"
#include "lib/chain.glsl"
#include "lib/clip.glsl"
#include "lib/limb.glsl"
#include "stages/hurt.glsl"

LOAD4_BUFFER(BINDING_RIG, rig);
LOAD4_BUFFER(BINDING_BODY, bodies);
LOAD4_BUFFER(BINDING_PLAY, plays);
LOAD4_BUFFER(BINDING_CLIP_FRAME, frames);
LOAD4_BUFFER(BINDING_CLIP_ROW, rows);
LOAD4_BUFFER(BINDING_CLIP_LEG, legs);
STORE4_BUFFER(BINDING_FOOT_OUT, feetOut);
#ifdef PLANTED
#include "stages/ground.glsl"
LOAD4_BUFFER(BINDING_STEP, steps);
STORE4_BUFFER(BINDING_STEP_OUT, stepsOut);
STORE4_BUFFER(BINDING_START_OUT, chainsOut);

// Height of the ground below a point relative to the body.
float drop(Body body, vec2 q) {
  return groundAt(worldOf(body.local, body.tile) + q).x - body.local.y;
}
#else
STORE4_BUFFER(BINDING_CHAIN_OUT, chainsOut);
STORE4_BUFFER(BINDING_TIP_OUT, tipsOut);
#endif

void main() {
  int record = legAt(int(gl_GlobalInvocationID.x));
  if (record < 0) return;
  int agent = agentOfRecord(record, LEGS), leg = legOfRecord(record, LEGS);
  int playAt = agent * PLAY_STRIDE;
  Body body = LOAD_BODY(agent);
  Play play = unpackPlay(LOAD4(plays, playAt), LOAD4(plays, playAt + 1), LOAD4(plays, playAt + 2));
  uint standing = uint(LOAD4(frames, int(play.weight < 0.5 ? play.frames.z : play.frames.x)).z);
  bool stands = (standing >> leg & 1u) != 0u;

  vec3 joint[BONES + 1];
  for (int i = 0; i <= BONES; ++i) {
    vec4 place = LOAD4(legs, leg * (BONES + 1) + i), m[3];
    LOAD_MATRIX(m, rows, play, int(place.w));
    joint[i] = transformed(m, place.xyz);
  }
  Limb limb;
  LOAD_LIMB(limb, rig, leg * rigStride(BONES) + RIG_LEG_STRIDE);
  vec2 swings[BONES];
  Frame f = noTurn();
  for (int i = 0; i < BONES; ++i) {
    vec3 along = joint[i + 1] - joint[i];
    Frame a = carried(i, f, limb.carry[i]);
    vec3 d = rotateBack(a, unit(along));
    swings[i] = dot(along, along) > 1e-16 ? d.xy / (1.0 + max(d.z, -0.999)) : vec2(0.0);
    f = turnedFrame(i, a, swings[i], 0.0);
  }
  vec3 foot = joint[BONES], target = rotate(body.orientation, foot);
  float u = stands ? 1.0 : 0.5;

#ifdef PLANTED
  int stepAt = record * STEP_STRIDE;
  vec4 s0 = LOAD4(steps, stepAt), s1 = LOAD4(steps, stepAt + 1);
  bool locked = s1.w > 0.0;
  vec3 lock = fromTile(s0.xyz, tileOf(s0.w) - body.tile, body.local), offset = s1.xyz;
  float above = max(foot.y, 0.0);
  vec3 wanted = vec3(target.x, drop(body, target.xz) + above, target.z);
  offset = stands && locked ? lock - wanted : offset;
  float stray = length(offset.xz);
  bool locks = stands && !locked && stray <= 0.5 * parameters.plantStray;
  vec3 place = wanted + offset;
  lock = locks ? vec3(place.x, drop(body, place.xz) + above, place.z) : lock;
  locked = locks || (stands && locked && stray <= parameters.plantStray);
  offset *= locked ? 1.0 : parameters.plantKeep;
  target = locked ? lock : wanted + offset;
  u = locked ? 1.0 : 0.5;
#ifdef HURT
  // It has no target, and when it carries again it begins off its lock.
  if (!carries(agent, leg)) {
    target = lock = offset = vec3(0.0);
    u = 0.0;
    locked = locks = false;
  }
#endif
  // A lock stays as it was written, in the tile of that tick; rounded anew in every tick it would creep.
  bool kept = locked && !locks;
  STORE4_TWO(stepsOut, stepAt, kept ? s0 : vec4(lock + body.local, packedTile(body.tile.x, body.tile.y)),
             vec4(offset, locked ? 1.0 : 0.0));
  int at = record * startStride(BONES);
  STORE_SWINGS(chainsOut, at, swings, startStride(BONES) % 2 == 0);
  STORE4(chainsOut, at + chainStride(BONES), vec4(joint[0], 0.0));
#else
  STORE_SWINGS(chainsOut, record * chainStride(BONES), swings, chainStride(BONES) % 2 == 0);
  STORE4(tipsOut, record, vec4(target, 0.0));
#endif
  STORE4(feetOut, record, vec4(target, u));
}
