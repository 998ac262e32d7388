// The page's counters, and which of its herds an agent is of: equal herds share pages.
#include "lib/rarely.glsl"

layout(constant_id = CONSTANT_HERD_STEPS) const int HERD_STEPS = 0;
layout(set = 0, binding = BINDING_COUNTERS, std430) buffer CountersBlock { uint counters[]; };

// The row of an agent's herd: the last one that does not begin beyond the agent.
int rowOf(int agent) {
  int row = 0;
  for (int step = (1 << HERD_STEPS) >> 1; step > 0; step >>= 1)
    row = counters[counterHerd(row + step, 1 << HERD_STEPS)] <= uint(agent) ? row + step : row;
  return row;
}

void countForHerd(bool counts, int agent, int counter) {
  if (HERD_STEPS == 0) {
    if (counts) atomicAdd(counters[counterRow(0) + counter], 1u);
  } else {
    RARELY(counts) atomicAdd(counters[counterRow(rowOf(agent)) + counter], 1u);
  }
}
