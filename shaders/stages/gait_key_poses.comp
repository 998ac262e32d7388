#version 460
#extension GL_GOOGLE_include_directive : require
#include "stages/awake.glsl"

LOAD4_BUFFER(BINDING_BODY, bodies);
LOAD4_BUFFER(BINDING_GAIT, gaits);
STORE4_BUFFER(BINDING_GAIT_OUT, gaitsOut);

void main() {
  int agent = agentAt(int(gl_GlobalInvocationID.x));
  if (agent < 0) return;
  int gaitAt = agent * GAIT_STRIDE;
  Body body = LOAD_BODY(agent);
  float speed = body.surfaceSpeed + abs(body.turnRate) * parameters.homeRadius;
  float phase = LOAD4(gaits, gaitAt).x + speed * parameters.dt / parameters.poseStride;
  STORE4_TWO(gaitsOut, gaitAt, vec4(phase - floor(phase), 0.0, 0.0, 0.0), vec4(0.0));
}
