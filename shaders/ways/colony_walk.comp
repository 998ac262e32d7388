#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// An ant walks from the nest until it is at the goal, and back out of dead ends (docs/colony.md).
#include "ways/colony.glsl"
#include "ways/colony_trips.glsl"
#include "lib/split_mix.glsl"

layout(local_size_x = COLONY_GROUP) in;
layout(set = 0, binding = COLONY_WEIGHT, std430) readonly buffer WeightBlock { uint weights[]; };
layout(set = 0, binding = COLONY_MARK, std430) buffer MarkBlock { uint marks[]; };
layout(set = 0, binding = COLONY_CROSSING, std430) buffer CrossingBlock { uint crossings[]; };

uint markWord(uint ant, uint cell) { return (cell >> 5) * colony.ants + ant; }
bool isSeen(uint ant, uint cell) { return ((marks[markWord(ant, cell)] >> (cell & 31u)) & 1u) != 0u; }
void see(uint ant, uint cell) { marks[markWord(ant, cell)] |= 1u << (cell & 31u); }

// The weights of all directions, 0 for cells that the ant has seen, and their sum.
uint weigh(uint ant, uint cell, out uint weight[8]) {
  ivec2 at = placeOf(cell);
  uint sum = 0u;
  [[unroll]] for (int direction = 0; direction < 8; ++direction) {
    weight[direction] = weights[8u * cell + direction];
    if (weight[direction] != 0u && isSeen(ant, cellOf(at + stepOf(direction)))) weight[direction] = 0u;
    sum += weight[direction];
  }
  return sum;
}

uint heaviest(uint weight[8]) {
  uint best = 0u, most = weight[0];
  [[unroll]] for (int direction = 1; direction < 8; ++direction)
    if (weight[direction] > most) most = weight[direction], best = direction;
  return best;
}

uint roulette(uint weight[8], uint sum, uint random) {
  uint mark, unused, upTo = 0u, chosen = 0u;
  umulExtended(random, sum, mark, unused);
  [[unroll]] for (int direction = 0; direction < 8; ++direction) {
    upTo += weight[direction];
    if (mark >= upTo) chosen = direction + 1;
  }
  return chosen;
}

void main() {
  uint ant = gl_GlobalInvocationID.x;
  if (ant >= colony.ants) return;
  uvec2 key = splitMixDraw(uvec2(colony.seedLow, colony.seedHigh), colony.iteration * colony.ants + ant + 1u);
  uint cell = colony.nest, count = 0u, length = 0u;
  see(ant, cell);
  for (uint walked = 1u; walked <= colony.steps && cell != colony.goal; ++walked) {
    uint weight[8];
    uint sum = weigh(ant, cell, weight), from = cell;
    if (sum == 0u) {
      if (count == 0u) break;
      uint direction = moveAt(ant, --count);
      cell = cellOf(placeOf(from) - stepOf(direction));
      length -= moveLength(costOf(grounds[cell]), costOf(grounds[from]), direction);
      continue;
    }
    uvec2 random = splitMixDraw(key, walked);
    uint direction = RULE == COLONY_ACS && random.x < colony.greed ? heaviest(weight)
                                                                    : roulette(weight, sum, random.y);
    cell = cellOf(placeOf(from) + stepOf(direction));
    length += moveLength(costOf(grounds[from]), costOf(grounds[cell]), direction);
    setMove(ant, count++, direction);
    see(ant, cell);
    if (RULE == COLONY_ACS) atomicAdd(crossings[8u * from + direction], 1u);
    if (length > LONGEST_TRIP) break;
  }
  bool arrived = cell == colony.goal && length <= LONGEST_TRIP;
  trips[ant] = uvec2(count, arrived ? length : NO_WAY);
}
