// What every stage's entry point begins with.
#include "lib/load4.glsl"
#include "shared/bindings.h"
#include "skitter/records.h"
#include "shared/parameters.h"
#include "shared/levels.h"
#include "lib/math.glsl"
#include "lib/records.glsl"

layout(local_size_x = WORK_GROUP) in;
layout(constant_id = CONSTANT_LEGS) const int LEGS = 8;
layout(constant_id = CONSTANT_BONES) const int BONES = 4;
layout(constant_id = CONSTANT_GROUPS) const int GROUPS = 2;

layout(push_constant) uniform TickBlock { TickConstants constants; };
// Read at once, before any branch: below one, a device that masks lanes gathers what is uniform lane by lane.
float crowdTick = constants.tick;
// Where there are levels of rate, times are in ticks of the agent's own, each of `tickSpan` ticks of the crowd, a
// power of two, so that nothing is rounded; what is stored is in ticks of the crowd.
layout(constant_id = CONSTANT_LEVELS) const bool LEVELS = false;
float thisTick = crowdTick;
float tickSpan = 1.0, tickShare = 1.0;
// The agent's last tick, of the crowd's.
float lastTick() { return LEVELS ? crowdTick - tickSpan : thisTick - 1.0; }
Step inOwnTicks(Step s) {
  if (LEVELS) {
    s.firstTick *= tickShare;
    s.ticks *= tickShare;
  }
  return s;
}
#ifndef WITHOUT_PARAMETERS
layout(std140, set = 0, binding = BINDING_PARAMETERS) uniform ParametersBlock {
  Parameters uniformParameters;
};
#define DECLARE_KNOWN(i, name) layout(constant_id = CONSTANT_PARAMETERS + i) const float known_##name = 0.0;
KNOWN_PARAMETERS(DECLARE_KNOWN)
Parameters allParameters() {
  Parameters p = uniformParameters;
#define TAKE_KNOWN(i, name) p.name = known_##name;
  KNOWN_PARAMETERS(TAKE_KNOWN)
  return p;
}
Parameters parameters = allParameters();

// The share that so many ticks (a power of two) leave, where each leaves `keep`.
float keptOver(float keep, float ticks) {
  float two = keep * keep, four = two * two;
  return ticks >= 8.0 ? four * four : ticks >= 4.0 ? four : ticks >= 2.0 ? two : keep;
}
float blendOver(float blend, float ticks) { return 1.0 - keptOver(1.0 - blend, ticks); }
mat2 springOver(mat2 step, float ticks) {
  mat2 two = step * step, four = two * two;
  return ticks >= 8.0 ? four * four : ticks >= 4.0 ? four : ticks >= 2.0 ? two : step;
}
// The invocation's agent ticks after so many ticks of the crowd. To be called once.
void tickOver(float ticks) {
  if (!LEVELS) return;
  tickSpan = ticks;
  tickShare = ticks >= 8.0 ? 0.125 : ticks >= 4.0 ? 0.25 : ticks >= 2.0 ? 0.5 : 1.0;  // a quotient may be rounded
  thisTick = crowdTick * tickShare;
  parameters.dt *= ticks;
  parameters.heightBlend = blendOver(parameters.heightBlend, ticks);
  parameters.tiltBlend = blendOver(parameters.tiltBlend, ticks);
  parameters.clipFade *= ticks;
  parameters.plantKeep = keptOver(parameters.plantKeep, ticks);
  mat2 spring = springOver(
      mat2(parameters.springKeep, parameters.springPull, parameters.springDrift, parameters.springCarry), ticks);
  parameters.springKeep = spring[0].x;
  parameters.springPull = spring[0].y;
  parameters.springDrift = spring[1].x;
  parameters.springCarry = spring[1].y;
}
#endif
