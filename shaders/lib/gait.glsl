#ifndef GAIT_GLSL
#define GAIT_GLSL

// A share of the half stride: without a rhythm, a foot is out of comfort beyond it. It is less than 1,
// because a leg may have to wait for a neighbour.
const float REACH_SHARE = 0.6;
// Places of a watched way, from where the foot is on.
const int AHEAD = 3;
// Ticks that a step aimed anew has left at least: what rises under a landing foot is climbed, not jumped on.
const float REAIM_LEAST = 2.0;

// What speed asks of the legs (docs/stages/gait.md).
struct Stride {
  float halfStride, ticks, swing, cycle;
  float spread;  // of a group's lift-offs, share of a cycle
};

Stride strideFor(Parameters q, float surfaceSpeed, float turnRate, float groups) {
  Stride s;
  float v = surfaceSpeed + abs(turnRate) * q.homeRadius;
  s.ticks = max(2.0, floor(q.swingStill / (1.0 + v / q.swingSpeed) / q.dt + 0.5));
  s.swing = s.ticks * q.dt;
  float duty = max(q.dutyLeast, q.dutyStill - q.dutyGain * v);
  s.cycle = max(min(q.cycleMax, s.swing / (1.0 - duty)), groups * s.swing * q.windowSlack);
  s.halfStride = clamp(0.5 * v * (s.cycle - s.swing), q.halfStrideStill, q.halfStrideMax);
  s.spread = q.lagShare * (1.0 / groups - s.swing / s.cycle);
  return s;
}

// May a leg of `group` that lifts `lag` after the first one of it begin a step at this phase?
bool windowOpen(Parameters q, float phase, float group, float lag, Stride s, float groups) {
  float since = phase - (group / groups + s.spread * lag);
  since -= floor(since);
  return since * groups < q.windowOpen;
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
