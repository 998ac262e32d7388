#ifndef LOOP_GLSL
#define LOOP_GLSL
// A foot on its fixed loop (docs/stages/loop.md).
#include "lib/gait.glsl"
#include "lib/hermite.glsl"

struct LoopFoot {
  vec3 place;  // model space
  float u;     // 1 in stance
};

LoopFoot loopFoot(vec3 home, float turnRate, float surfaceSpeed, float phase, float cycle, float swing, float lift) {
  float stance = cycle - swing, time = phase * cycle;
  float flown = (time - stance) / swing;
  float ahead = flown < 0.0 ? 0.5 * stance - time : 0.5 * stance;
  vec3 front = predictLanding(home, turnRate, surfaceSpeed, ahead, 0.0);
  vec3 back = predictLanding(home, turnRate, surfaceSpeed, -ahead, 0.0), up = vec3(0.0, lift, 0.0);
  Swing flight = Swing(back, front, up, up);
  return flown < 0.0 ? LoopFoot(front, 1.0) : LoopFoot(swingPoint(flight, flown), min(flown, 0.999));
}

#endif
