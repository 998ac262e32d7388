#version 460
#extension GL_GOOGLE_include_directive : require
#include "stages/awake.glsl"
#include "lib/gait.glsl"
#include "stages/hurt.glsl"

LOAD4_BUFFER(BINDING_BODY, bodies);
LOAD4_BUFFER(BINDING_GAIT, gaits);
STORE4_BUFFER(BINDING_GAIT_OUT, gaitsOut);

void main() {
  int agent = agentAt(int(gl_GlobalInvocationID.x));
  if (agent < 0) return;
  Body body = LOAD_BODY(agent);
#ifdef HURT
  Stride stride = strideOfHurt(parameters, body, agent, hurtOf(agent));
#else
  Stride stride = strideFor(parameters, body.surfaceSpeed, body.turnRate, float(GROUPS));
#endif
  float phase = LOAD4(gaits, agent * GAIT_STRIDE).x + (body.still > 0.0 ? 0.0 : parameters.dt / stride.cycle);
  STORE4_TWO(gaitsOut, agent * GAIT_STRIDE, vec4(phase - floor(phase), 0.0, 0.0, stride.ticks),
             vec4(stride.halfStride, stride.cycle, 0.0, 0.0));
}
