#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation keeps the best way, and lays the trail on which pheromone is deposited (docs/colony.md).
#include "ways/colony.glsl"
#include "ways/colony_trips.glsl"

layout(local_size_x = 1) in;
layout(set = 0, binding = COLONY_TRAIL, std430) writeonly buffer TrailBlock { uint trail[]; };
layout(set = 0, binding = COLONY_BEST, std430) buffer BestBlock { uint best[]; };

void keep(uint ant, uint iteration) {
  uvec2 trip = trips[ant];
  for (uint move = 0u; move < trip.x; move += 8u)
    best[BEST_HEAD + (move >> 3)] = moves[moveWord(ant, move)];
  best[BEST_MOVES] = trip.x;
  best[BEST_LENGTH] = trip.y;
  best[BEST_FOUND] = iteration;
}

void lay(bool bestsTurn, uint ant, uint iteration) {
  uint cell = colony.nest, count = bestsTurn ? best[BEST_MOVES] : trips[ant].x;
  for (uint move = 0u; move < count; ++move) {
    uint word = bestsTurn ? best[BEST_HEAD + (move >> 3)] : moves[moveWord(ant, move)];
    uint direction = (word >> (4u * (move & 7u))) & 15u;
    trail[cell] = 8u * iteration + direction;
    cell = cellOf(placeOf(cell) + stepOf(direction));
  }
}

void main() {
  uint iteration = colony.iteration + 1u, first = firstOf(0u, colony.ants);
  if (first != NO_WAY && trips[first].y < best[BEST_LENGTH]) keep(first, iteration);
  bool turn = colony.bestEvery != 0u && iteration % colony.bestEvery == 0u;
  bool bestsTurn = RULE == COLONY_ACS || turn || first == NO_WAY;
  if (bestsTurn ? best[BEST_LENGTH] != NO_WAY : true) lay(bestsTurn, first, iteration);
}
