#version 460
#extension GL_GOOGLE_include_directive : require
// Tangents of every key, by rule or as given, and whether the key may be (docs/spline.md).
#include "spline/batch.glsl"
#include "lib/tangent_rule.glsl"

layout(constant_id = CONSTANT_RULE) const int RULE = RULE_CATMULL_ROM;

LOAD4_BUFFER(SPLINE_KEY, keys);
LOAD4_BUFFER(SPLINE_GIVEN, given);
STORE4_BUFFER(SPLINE_TANGENT_OUT, tangentsOut);

// The last key of a closed spline has the first one's point.
vec4 keyAt(int spline, int k) {
  vec4 key = LOAD4(keys, spline * KEYS + k);
  return CLOSED && k == SEGMENTS ? vec4(LOAD4(keys, spline * KEYS).xyz, key.w) : key;
}

Side sideAt(int spline, int segment) {
  int i = CLOSED ? (segment + SEGMENTS) % SEGMENTS : clamp(segment, 0, SEGMENTS - 1);
  vec4 from = keyAt(spline, i), to = keyAt(spline, i + 1);
  float time = to.w - from.w;
  return Side((to.xyz - from.xyz) / time, time);
}

vec3 catmullRom(int spline, int k, Side before, Side after) {
  vec3 m = parabolaTangent(before, after);
  if (CLOSED || SEGMENTS == 1 || (k > 0 && k < SEGMENTS)) return m;
  int inner = k == 0 ? 1 : SEGMENTS - 1;
  return 2.0 * after.slope - parabolaTangent(sideAt(spline, inner - 1), sideAt(spline, inner));
}

vec3 monotone(int spline, int k, Side before, Side after) {
  vec3 m = monotoneMean(before.slope, after.slope);
  vec3 left = monotoneMean(sideAt(spline, k - 2).slope, before.slope);
  vec3 right = monotoneMean(after.slope, sideAt(spline, k + 1).slope);
  vec3 scaleBefore = CLOSED || k > 0 ? monotoneScale(before.slope, left, m) : vec3(1.0);
  vec3 scaleAfter = CLOSED || k < SEGMENTS ? monotoneScale(after.slope, m, right) : vec3(1.0);
  return m * min(scaleBefore, scaleAfter);
}

void main() {
  int index = int(gl_GlobalInvocationID.x);
  if (index >= int(constants.count) * KEYS) return;
  int spline = index / KEYS, k = index % KEYS;
  vec4 key = keyAt(spline, k);
  bool sound = within(key.xyz, LARGEST_COORDINATE) && abs(key.w) <= LARGEST_COORDINATE;
  sound = sound && (k == 0 || key.w - keyAt(spline, k - 1).w >= LEAST_STEP);

  Side before = sideAt(spline, k - 1), after = sideAt(spline, k);
  vec3 arriving = vec3(0.0), leaving = vec3(0.0);
  if (RULE == RULE_GIVEN) {
    int from = CLOSED && k == SEGMENTS ? spline * KEYS : index;
    arriving = LOAD4(given, TANGENT_STRIDE * from).xyz;
    leaving = LOAD4(given, TANGENT_STRIDE * from + 1).xyz;
    sound = sound && within(arriving, LARGEST_TANGENT) && within(leaving, LARGEST_TANGENT);
  } else if (RULE == RULE_KOCHANEK_BARTELS) {
    arriving = tcbTangent(before, after, constants.tension, constants.continuity, constants.bias, false);
    leaving = tcbTangent(before, after, constants.tension, constants.continuity, constants.bias, true);
  } else if (RULE != RULE_ZERO) {
    if (RULE == RULE_CATMULL_ROM) arriving = catmullRom(spline, k, before, after);
    if (RULE == RULE_FINITE_DIFFERENCE) arriving = 0.5 * (before.slope + after.slope);
    if (RULE == RULE_CARDINAL) arriving = cardinalTangent(before, after, constants.tension);
    if (RULE == RULE_MONOTONE) arriving = monotone(spline, k, before, after);
    leaving = arriving;
  }
  STORE4(tangentsOut, TANGENT_STRIDE * index, vec4(arriving, sound ? 0.0 : 1.0));
  STORE4(tangentsOut, TANGENT_STRIDE * index + 1, vec4(leaving, 0.0));
}
