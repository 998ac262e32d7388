#version 460
#extension GL_GOOGLE_include_directive : require
#include "stages/awake.glsl"

LOAD4_BUFFER(BINDING_BODY, bodies);
LOAD4_BUFFER(BINDING_STEP, steps);
LOAD4_BUFFER(BINDING_ARC, arcs);
#ifdef REACTS
LOAD4_BUFFER(BINDING_RIG, rig);
#endif
STORE4_BUFFER(BINDING_FOOT_OUT, feetOut);
#include "stages/swing.glsl"

void main() {
  int record = legAt(int(gl_GlobalInvocationID.x));
  if (record < 0) return;
  STORE4(feetOut, record, makeFoot(agentOfRecord(record, LEGS), record));
}
