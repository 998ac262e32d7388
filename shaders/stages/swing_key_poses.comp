#version 460
#extension GL_GOOGLE_include_directive : require
#define ONLY_CONES
#include "stages/awake.glsl"
#include "shared/ik_batch.h"
#include "lib/chain.glsl"
#include "lib/hermite.glsl"
#include "lib/limb.glsl"

LOAD4_BUFFER(BINDING_RIG, rig);
LOAD4_BUFFER(BINDING_BODY, bodies);
LOAD4_BUFFER(BINDING_GAIT, gaits);
LOAD4_BUFFER(BINDING_KEY, poses);
LOAD4_BUFFER(BINDING_CHAIN, chains);
LOAD4_BUFFER(BINDING_SPRING, springs);
STORE4_BUFFER(BINDING_FOOT_OUT, feetOut);
STORE4_BUFFER(BINDING_CHAIN_OUT, chainsOut);
STORE4_BUFFER(BINDING_SPRING_OUT, springsOut);
STORE4_BUFFER(BINDING_TIP_OUT, tipsOut);
layout(constant_id = CONSTANT_FEET) const bool FEET = false;

void main() {
  int record = legAt(int(gl_GlobalInvocationID.x));
  if (record < 0) return;
  int agent = agentOfRecord(record, LEGS), leg = legOfRecord(record, LEGS), pairs = chainStride(BONES);
  int at = record * pairs;
  Body body = LOAD_BODY(agent);
  float phase = LOAD4(gaits, agent * GAIT_STRIDE).x;
  float speed = body.surfaceSpeed + abs(body.turnRate) * parameters.homeRadius;
  float walking = min(1.0, speed / parameters.poseWalk);

  // The spring lags behind its goal: it is given one so much ahead.
  float lead = 2.0 * parameters.springDamping / parameters.springFrequency - 0.5 * parameters.dt;
  int keys = int(parameters.poseKeys);
  float place = fract(phase + lead * speed / parameters.poseStride) * parameters.poseKeys;
  int k = min(int(place), keys - 1);
  vec4 weight = hermiteBasis(place - float(k));
  int poseAt = leg * keyStride(BONES, keys), standing = poseAt + 1, first = standing + pairs;
  int from = first + 2 * pairs * k, to = first + (k + 1 < keys ? 2 * pairs * (k + 1) : 0);

  Pose pose;
  for (int i = 0; i < BONES; i += 2) {
    int pair = i / 2;
    vec4 cycle = weight.x * LOAD4(poses, from + pair) + weight.y * LOAD4(poses, from + pairs + pair) +
                 weight.z * LOAD4(poses, to + pair) + weight.w * LOAD4(poses, to + pairs + pair);
    vec4 goal = mix(LOAD4(poses, standing + pair), cycle, walking);
    vec4 off = LOAD4(chains, at + pair) - goal, rate = LOAD4(springs, at + pair);
    vec4 swings = goal + (parameters.springKeep * off + parameters.springDrift * rate);
    STORE4(chainsOut, at + pair, swings);
    STORE4(springsOut, at + pair, parameters.springPull * off + parameters.springCarry * rate);
    pose.swing[i] = swings.xy;
    if (i + 1 < BONES) pose.swing[min(i + 1, BONES - 1)] = swings.zw;
  }
  for (int i = 0; i < BONES; ++i) pose.twist[i] = 0.0;
  Limb limb;
  int rigAt = leg * rigStride(BONES);
  LOAD_LIMB(limb, rig, rigAt + RIG_LEG_STRIDE);
  forwardKinematics(limb, pose);

  vec4 root = LOAD4(rig, rigAt), contact = LOAD4(poses, poseAt);
  vec3 tip = rotate(body.orientation, root.xyz + root.w * pose.tip);
  bool stands = walking < 0.5 || fract(phase - contact.x) < contact.y;
  if (FEET) STORE4(feetOut, record, vec4(tip, stands ? 1.0 : 0.5));
  if (FEET) STORE4(tipsOut, record, vec4(tip, 0.0));
}
