#ifndef UNHELD_STEP_GLSL
#define UNHELD_STEP_GLSL
#include "columns.glsl"
// The active set's step (active_set.glsl) and chord steps of a chain of cones of which no bone meets its limit: nothing
// is held then and nothing clamped, which is half of the work (docs/stages/ik.md).

// Whether a step leads no bone to its limit, from n (1 + d.z) and n of the direction d after it; c: cos(alpha).
// Clamped is what has cos(theta) < c; held what has n cos(theta) < c times a number from 1 to n.
bool clearOfLimit(float below, float n, float c) { return below - n - 1e-5 > (c > 0.0 ? c * n : c); }

// k: 2 / (1 + X^2 + Y^2).
vec3 tipOf(Limb limb, vec2 swing[BONES], float k[BONES]) {
  vec3 v = vec3(0.0);
  for (int i = BONES - 1; i >= 0; --i) {
    v.z += limb.bone[i];
    v = rotate(swungFrame(limb.carry[i], swing[i], k[i]), v);
  }
  return v;
}

// As activeSet with CHORDS_ALL, undamped, from within half the reach of the target. False if a bone may meet its limit
// or the step leads away: what is returned is of no use then.
bool unheldStep(Limb limb, vec3 target, int chords, float restPull, float tolerance, inout Pose pose,
                inout float error) {
  Columns c;
  columnsOf(limb, pose, pose.tip, c);
  vec2 x[BONES];
  vec3 e = target - pose.tip;
  Symmetric m = Symmetric(vec3(0.25 * dot(e, e) + 1e-5), vec3(0.0));
  for (int i = 0; i < BONES; ++i) {
    addOuter(m, c, i);
    x[i] = towardRest(pose.swing[i], restPull * limb.stiffness[i]);
    e -= x[i].x * c.x[i] + x[i].y * c.y[i];
  }
  Inverse inverse = inverseOf(m);
  Pose trial;
  bool clear = true;
  [[unroll]] for (int step = 0; step <= chords; ++step) {
    vec3 lambda = times(inverse, e);
    float k[BONES];
    for (int i = 0; i < BONES; ++i) {
      x[i] += stepOf(c, i, lambda);
      vec4 to = stepped(pose.swing[i], x[i]);
      clear = clear && ((PADDED && limb.bone[i] == 0.0) || clearOfLimit(to.z, to.w, limb.cosine[i]));
      float over = 1.0 / (to.z * to.w);
      trial.swing[i] = to.xy * (over * to.w);
      trial.twist[i] = pose.twist[i];
      k[i] = to.z * (over * to.z);
    }
    trial.tip = tipOf(limb, trial.swing, k);
    e = target - trial.tip;
  }
  float after = length(e);
  clear = clear && (after <= 1.0001 * error || after <= tolerance);
  keepIf(true, pose, trial);
  error = after;
  return clear;
}

#endif
