#ifndef CLIP_GLSL
#define CLIP_GLSL
// Clips as they are played (docs/stages/clip.md).
#include "lib/rarely.glsl"

layout(constant_id = CONSTANT_JOINTS) const int JOINTS = 1;
// PASS_QUICK leaves out the agents that fade between clips, PASS_LISTED has no others.
layout(constant_id = CONSTANT_PASS) const int PASS = PASS_WHOLE;

struct Play {
  float to, toTime, from, fromTime;
  float weight, toRate, fromRate;
  vec4 frames;  // of both: frame, fraction
};

Play unpackPlay(vec4 a, vec4 b, vec4 c) { return Play(a.x, a.y, a.z, a.w, b.x, b.y, b.z, c); }

// Rows of a joint's matrix: between frames, then between clips.
#define LOAD_MATRIX(m, rows, play, joint)                                                           \
  {                                                                                                 \
    int a_ = (int((play).frames.x) * JOINTS + (joint)) * MATRIX_STRIDE, next_ = JOINTS * MATRIX_STRIDE; \
    for (int r_ = 0; r_ < 3; ++r_)                                                                  \
      m[r_] = mix(LOAD4(rows, a_ + r_), LOAD4(rows, a_ + next_ + r_), (play).frames.y);             \
    RARELY(PASS != PASS_QUICK && (play).weight < 1.0) {                                             \
      int b_ = (int((play).frames.z) * JOINTS + (joint)) * MATRIX_STRIDE;                           \
      for (int r_ = 0; r_ < 3; ++r_)                                                                \
        m[r_] = mix(mix(LOAD4(rows, b_ + r_), LOAD4(rows, b_ + next_ + r_), (play).frames.w), m[r_], \
                    (play).weight);                                                                 \
    }                                                                                               \
  }

vec3 transformed(vec4 m[3], vec3 p) {
  return vec3(dot(m[0], vec4(p, 1.0)), dot(m[1], vec4(p, 1.0)), dot(m[2], vec4(p, 1.0)));
}

// How ill a clip suits a speed.
float clipCost(Parameters q, float clipSpeed, float speed, bool standing) {
  bool idle = speed < q.clipIdle;
  float octaves = abs(log2(max(speed, 1e-6) / max(clipSpeed, 1e-6)));
  if (clipSpeed > 0.0) return octaves + (idle && standing ? 1000.0 : 0.0);
  return idle ? 0.0 : 2000.0;
}

float wrapped(float time, float seconds) {
  float t = time - floor(time / max(seconds, 1e-6)) * seconds;
  return seconds > 0.0 ? clamp(t, 0.0, seconds) : 0.0;
}

#endif
