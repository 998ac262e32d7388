#ifndef GAIT_GLSL
#define GAIT_GLSL

// What speed asks of the legs (docs/stages.md, gait).
struct Stride {
  float halfStride, ticks, swing, cycle;
};

Stride strideFor(Parameters q, float surfaceSpeed, float turnRate, float groups) {
  Stride s;
  float v = surfaceSpeed + abs(turnRate) * q.homeRadius;
  s.halfStride = min(q.halfStrideStill + q.halfStrideGain * v, q.halfStrideMax);
  s.ticks = max(3.0, floor(q.swingStill / (1.0 + v / q.swingSpeed) / q.dt + 0.5));
  s.swing = s.ticks * q.dt;
  s.cycle = min(q.cycleMax, 2.0 * s.halfStride / max(v, 1e-3) + s.swing);
  s.cycle = max(s.cycle, groups * s.swing * q.windowSlack);
  return s;
}

// Where, in model space, a foot should land that touches down in `time` seconds: its home in the middle of the
// stance that follows.
vec3 predictLanding(vec3 home, float turnRate, float surfaceSpeed, float time, float stance) {
  float ahead = time + 0.5 * stance;
  return turn(turnRate * ahead, home) + vec3(0.0, 0.0, surfaceSpeed * ahead);
}

vec3 predictRoot(vec3 root, float turnRate, float surfaceSpeed, float time) {
  return turn(turnRate * time, root) + vec3(0.0, 0.0, surfaceSpeed * time);
}

#endif
