#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#define WITHOUT_PARAMETERS
#include "stages/stage.glsl"
#include "lib/rarely.glsl"

layout(constant_id = CONSTANT_JOINTS) const int JOINTS = 1;
LOAD4_BUFFER(BINDING_STEER, steers);
STORE4_BUFFER(BINDING_AWAKE_OUT, awakeOut);
layout(set = 0, binding = BINDING_COUNTERS, std430) buffer CountersBlock { uint counters[]; };

uint groupsOf(uint invocations) { return (invocations + uint(WORK_GROUP) - 1u) / uint(WORK_GROUP); }

void main() {
  int block = int(gl_GlobalInvocationID.x), count = int(constants.count);
  uint mask = 0u;
  [[unroll]] for (int lane = 0; lane < BLOCK; ++lane) {
    int agent = block * BLOCK + lane;
    bool sleeps = LOAD4(steers, clamp(agent, 0, max(count - 1, 0))).z > 0.0;
    mask |= agent < count && !sleeps ? 1u << lane : 0u;
  }
  RARELY(mask != 0u) {
    uint place = atomicAdd(counters[COUNTER_AWAKE_BLOCKS], 1u), agents = (place + 1u) * uint(BLOCK);
    atomicAdd(counters[COUNTER_AWAKE], uint(bitCount(mask)));
    STORE4(awakeOut, place, vec4(float(block), float(mask), 0.0, 0.0));
    atomicMax(counters[COUNTER_AWAKE_AGENTS_X], groupsOf(agents));
    atomicMax(counters[COUNTER_AWAKE_LEGS_X], groupsOf(agents * uint(LEGS)));
    atomicMax(counters[COUNTER_AWAKE_JOINTS_X], groupsOf(agents * uint(JOINTS)));
  }
}
