#version 460
#extension GL_GOOGLE_include_directive : require
// Where each spline's traveller is and how fast, by its clock (docs/spline.md).
#include "spline/batch.glsl"
#include "spline/segment.glsl"
#include "lib/clock.glsl"

layout(constant_id = CONSTANT_ARC_LENGTH) const bool ARC_LENGTH = true;
layout(constant_id = CONSTANT_CONSTANT_SPEED) const bool CONSTANT_SPEED = false;

LOAD4_BUFFER(SPLINE_LENGTH, lengths);
LOAD4_BUFFER(SPLINE_SUMMARY, summaries);
LOAD4_BUFFER(SPLINE_CLOCK, clocks);
STORE4_BUFFER(SPLINE_MOTION_OUT, motionsOut);

float milestone(int spline, int k) {
  return CONSTANT_SPEED ? LOAD4(lengths, spline * KEYS + k).x : LOAD4(keys, spline * KEYS + k).w;
}

// The last segment that begins at `at` or before. Strides that no spline of the batch needs fold away.
int segmentOf(int spline, float at) {
  int i = 0;
  for (int stride = 512; stride > 0; stride >>= 1) {
    if (stride >= SEGMENTS) continue;
    int next = i + stride;
    float begins = milestone(spline, min(next, SEGMENTS));
    i = next < SEGMENTS && begins <= at ? next : i;
  }
  return i;
}

void main() {
  int spline = int(gl_GlobalInvocationID.x);
  if (spline >= int(constants.count)) return;
  vec4 clock = LOAD4(clocks, spline), summary = LOAD4(summaries, spline);
  float total = summary.x, first = summary.y, span = summary.z;
  float duration = clock.z;
  Exact elapsed = elapsedSince(clock.x, clock.y, constants.now, constants.nowRest);
  bool refused = summary.w > 0.0 || !(duration > 0.0 && duration <= 1e30) ||
                 !(abs(elapsed.value) <= 1e30) || isnan(clock.w);
  bool begun = clock.w > 0.0 && elapsed.value >= 0.0;
  bool over = !CLOSED && begun && elapsed.value >= duration;
  float rounds = 0.0, since = elapsed.value;
  if (CLOSED) since = withinRound(elapsed, duration, rounds);
  float phase = begun ? min(since / duration, 1.0) : 0.0;
  rounds = begun ? rounds : 0.0;

  float begins, time;
  float at = CONSTANT_SPEED ? phase * total : first + phase * span;
  int i = segmentOf(spline, at);
  Cubic cubic = segmentAt(spline, i, time, begins);
  float before = ARC_LENGTH || CONSTANT_SPEED ? LOAD4(lengths, spline * KEYS + i).x : 0.0;
  float s = clamp((at - begins) / time, 0.0, 1.0);
  if (CONSTANT_SPEED) s = cubicAtLength(cubic, at - before, LOAD4(lengths, spline * KEYS + i + 1).x - before);
  vec3 tangent = cubicTangent(cubic, s);
  float speed = length(tangent);
  vec3 velocity = CONSTANT_SPEED ? tangent * (speed < 1e-10 ? 0.0 : total / (duration * speed))
                                 : tangent * (span / (time * duration));
  float travelled = 0.0;
  if (ARC_LENGTH) travelled = rounds * total + (CONSTANT_SPEED ? at : before + cubicLength(cubic, s));

  vec3 position = cubicPoint(cubic, s);
  float state = refused ? STATE_REFUSED : over ? STATE_FINISHED : begun ? STATE_MOVING : STATE_IDLE;
  STORE4(motionsOut, MOTION_STRIDE * spline, refused ? vec4(0.0) : vec4(position, travelled));
  STORE4(motionsOut, MOTION_STRIDE * spline + 1,
         vec4(state == STATE_MOVING ? velocity : vec3(0.0), state));
}
