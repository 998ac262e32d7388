#version 460
#extension GL_GOOGLE_include_directive : require
// A cell's pheromone evaporates and is deposited, or is forgotten; then its weights follow (docs/colony.md).
#include "ways/colony.glsl"

layout(local_size_x = COLONY_CELL_GROUP) in;
layout(set = 0, binding = COLONY_PHEROMONE, std430) buffer PheromoneBlock { uint pheromones[]; };
layout(set = 0, binding = COLONY_WEIGHT, std430) writeonly buffer WeightBlock { uint weights[]; };
layout(set = 0, binding = COLONY_TRAIL, std430) readonly buffer TrailBlock { uint trail[]; };
layout(set = 0, binding = COLONY_CROSSING, std430) buffer CrossingBlock { uint crossings[]; };

const uint MOST_CROSSINGS = 64u;

uint worn(uint tau, uint edge) {
  uint count = min(crossings[edge], MOST_CROSSINGS);
  if (count > 0u) crossings[edge] = 0u;
  for (uint n = 0u; n < count; ++n) tau -= shareOf(tau - colony.least, colony.wear);
  return tau;
}

uint iterated(uint tau, uint edge, bool laid) {
  if (RULE == COLONY_ACS) {
    tau = worn(tau, edge);
    return laid ? tau + shareOf(FULL_PHEROMONE - tau, colony.evaporation) : tau;
  }
  tau -= shareOf(tau, colony.evaporation);
  if (laid) tau += shareOf(FULL_PHEROMONE, colony.evaporation);
  return clamp(tau, colony.least, FULL_PHEROMONE);
}

uint forgotten(uint tau) {
  if (RULE == COLONY_ACS) return tau - shareOf(tau - colony.least, colony.forget);
  return tau + shareOf(FULL_PHEROMONE - tau, colony.forget);
}

void main() {
  uint cell = gl_GlobalInvocationID.x;
  if (cell >= colony.columns * colony.rows) return;
  uint ground = grounds[cell], laid = trail[cell];
  ivec2 at = placeOf(cell), goal = placeOf(colony.goal);
  for (uint direction = 0u; direction < 8u; ++direction) {
    uint edge = 8u * cell + direction, tau = pheromones[edge], weight = 0u;
    if (colony.update == UPDATE_ITERATION)
      tau = iterated(tau, edge, laid == 8u * (colony.iteration + 1u) + direction);
    if (colony.update == UPDATE_FORGET && (ground & GROUND_CHANGED) != 0u) tau = forgotten(tau);
    pheromones[edge] = tau;
    if (((ground >> direction) & 1u) != 0u) {
      ivec2 to = at + stepOf(direction);
      int detour = int(moveLength(costOf(ground), costOf(grounds[cellOf(to)]), direction)) +
                   straightLength(to, goal) - straightLength(at, goal);
      weight = (tau >> 4) * desirabilityOf(uint(detour), colony.margin, colony.beta);
    }
    weights[edge] = weight;
  }
}
