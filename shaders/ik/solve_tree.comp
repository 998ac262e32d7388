#version 460
#extension GL_GOOGLE_include_directive : require
// A body with its legs as one solve: FABRIK with several ends (docs/ik.md; Aristidou & Lasenby 2011).
#include "lib/load4.glsl"
#include "shared/bindings.h"
#include "shared/ik_batch.h"
#include "skitter/records.h"
#include "lib/math.glsl"

layout(local_size_x = WORK_GROUP) in;
layout(constant_id = CONSTANT_BONES) const int BONES = 4;
layout(constant_id = CONSTANT_LEGS) const int LEGS = 8;
const int JOINTS = BONES + 1;

LOAD4_BUFFER(BATCH_RIG, rig);        // per leg: root; per bone: rest direction, length / longest leg
LOAD4_BUFFER(BATCH_TARGET, targets);  // a leg
LOAD4_BUFFER(BATCH_BASE, bodies);
STORE4_BUFFER(BATCH_STATE_OUT, bodiesOut);
STORE4_BUFFER(BATCH_JOINT_OUT, jointsOut);
STORE4_BUFFER(BATCH_REPORT_OUT, reportsOut);
layout(push_constant) uniform TreeBlock { TreeConstants constants; };

struct Rig {
  vec3 root[LEGS], target[LEGS];
  float bone[LEGS * BONES];
};

struct Tree {
  vec3 body;
  vec3 joint[LEGS * JOINTS];
};

void keepIf(bool keep, inout Tree best, Tree candidate) {
  best.body = keep ? candidate.body : best.body;
  for (int j = 0; j < LEGS * JOINTS; ++j) best.joint[j] = keep ? candidate.joint[j] : best.joint[j];
}

float errorOf(Rig r, Tree tree) {
  float worst = 0.0;
  for (int l = 0; l < LEGS; ++l) worst = max(worst, distance(r.target[l], tree.joint[l * JOINTS + BONES]));
  return worst;
}

void iterate(Rig r, inout Tree tree) {
  vec3 q[LEGS * BONES], mean = vec3(0.0);  // where bone i should end
  for (int l = 0; l < LEGS; ++l) {
    vec3 end = r.target[l];
    for (int i = BONES - 1; i >= 0; --i) {
      q[l * BONES + i] = end;
      end += r.bone[l * BONES + i] * unit(tree.joint[l * JOINTS + i] - end);
    }
    mean += (end - r.root[l]) / float(LEGS);
  }
  tree.body = mean * (1.0 - constants.anchor);
  for (int l = 0; l < LEGS; ++l) {
    vec3 p = tree.body + r.root[l], before = tree.joint[l * JOINTS];
    tree.joint[l * JOINTS] = p;
    for (int i = 0; i < BONES; ++i) {
      vec3 v = q[l * BONES + i] - p, kept = tree.joint[l * JOINTS + i + 1] - before;
      before = tree.joint[l * JOINTS + i + 1];
      float v2 = dot(v, v);
      p += v2 < 1e-12 ? kept : v * (r.bone[l * BONES + i] * inversesqrt(max(v2, 1e-20)));
      tree.joint[l * JOINTS + i + 1] = p;
    }
  }
}

void main() {
  int index = int(gl_GlobalInvocationID.x);
  if (index >= int(constants.count)) return;
  Tree tree;
  Rig r;
  bool lost = false;
  // About the body's first place, which is its anchor, in lengths of the longest leg.
  vec3 place = LOAD4(bodies, index).xyz;
  tree.body = vec3(0.0);
  for (int l = 0; l < LEGS; ++l) {
    r.root[l] = LOAD4(rig, l * JOINTS).xyz;
    r.target[l] = (LOAD4(targets, index * LEGS + l).xyz - place) / constants.reach;
    lost = lost || !finite(r.target[l]);
    vec3 p = r.root[l];
    tree.joint[l * JOINTS] = p;
    for (int i = 0; i < BONES; ++i) {
      vec4 b = LOAD4(rig, l * JOINTS + 1 + i);
      r.bone[l * BONES + i] = b.w;
      p += b.w * b.xyz;
      tree.joint[l * JOINTS + i + 1] = p;
    }
  }
  float error = lost ? 0.0 : errorOf(r, tree), last = error;
  float reason = lost ? STOP_SKIPPED : (error > constants.tolerance ? STOP_CAP : STOP_TOLERANCE);
  Tree best;
  keepIf(true, best, tree);
  bool open = error > constants.tolerance;
  int k = 0;
  for (; open && k < int(constants.iterations); ++k) {
    iterate(r, tree);
    float now = errorOf(r, tree);
    keepIf(now < error, best, tree);
    error = min(error, now);
    bool stalled = abs(last - now) < max(1e-3 * constants.tolerance, 3e-7);
    last = now;
    open = error > constants.tolerance && !stalled;
    reason = error <= constants.tolerance ? STOP_TOLERANCE
                                          : (stalled && k + 1 < int(constants.iterations) ? STOP_STALL : STOP_CAP);
  }
  STORE4(bodiesOut, index, vec4(place + constants.reach * best.body, 0.0));
  for (int j = 0; j < LEGS * JOINTS; ++j)
    STORE4(jointsOut, index * LEGS * JOINTS + j, vec4(place + constants.reach * best.joint[j], 0.0));
  STORE4(reportsOut, index, vec4(error, float(k), reason, 0.0));
}
