#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// The first ant of a crew has its way tightened: each of its cells moves by a cell at most, all at once, so
// that the way is the shortest of these (docs/colony.md).
#include "ways/colony.glsl"
#include "ways/colony_trips.glsl"

layout(local_size_x = COLONY_GROUP) in;
layout(set = 0, binding = COLONY_CHAIN, std430) buffer ChainBlock { uint chains[]; };

uint crews() { return (colony.ants + colony.crew - 1u) / colony.crew; }
uint chainWord(uint crew, uint layer, uint candidate) {
  return (2u * layer + (candidate >> 3)) * crews() + crew;
}

struct Layer {
  uint least[9];  // length to each candidate, or NO_WAY
  uint ground[9];
};

uint groundAt(ivec2 at) { return isOnMap(at) ? grounds[cellOf(at)] : 0u; }

// The candidate of the layer before from which one is reached by the shortest way of at most `bound`, and
// that way's length. Neither this nor relax has a branch in its loops over candidates, so that they are
// unrolled (engine/ways/colony.cpp counts the turns of loops).
uint reach(Layer before, uint ground, ivec2 at, uint bound, out uint least) {
  uint from = 0u;
  least = NO_WAY;
  [[unroll]] for (int candidate = 0; candidate < 9; ++candidate) {
    ivec2 by = at - besideOf(candidate);
    bool stays = by == ivec2(0), isNear = all(lessThanEqual(abs(by), ivec2(1)));
    uint direction = stays || !isNear ? 0u : directionOf(by), start = before.ground[candidate];
    uint move = stays ? 0u : moveLength(costOf(start), costOf(ground), direction);
    uint length = before.least[candidate] + move;
    bool isOpen = isNear && (stays || ((start >> direction) & 1u) != 0u);
    bool isLess = before.least[candidate] != NO_WAY && isOpen && length <= bound && length < least;
    least = isLess ? length : least;
    from = isLess ? uint(candidate) : from;
  }
  return from;
}

// Fills the chains of the crew; the length of the shortest way, or NO_WAY.
uint relax(uint crew, uint ant, uvec2 trip) {
  Layer before, next;
  ivec2 at = placeOf(colony.nest);
  [[unroll]] for (int candidate = 0; candidate < 9; ++candidate) {
    before.least[candidate] = candidate == 4 ? 0u : NO_WAY;
    before.ground[candidate] = groundAt(at + besideOf(candidate));
  }
  for (uint layer = 1u; layer <= trip.x; ++layer) {
    ivec2 by = stepOf(moveAt(ant, layer - 1u));
    at += by;
    uint low = 0u, high = 0u;
    [[unroll]] for (int candidate = 0; candidate < 9; ++candidate) {
      uint ground = groundAt(at + besideOf(candidate));
      uint least, from = reach(before, ground, by + besideOf(candidate), trip.y, least);
      bool isOpen = costOf(ground) != 0u && (layer != trip.x || candidate == 4);
      next.ground[candidate] = ground;
      next.least[candidate] = isOpen ? least : NO_WAY;
      if (candidate < 8) low |= from << (4 * candidate);
      else high = from;
    }
    chains[chainWord(crew, layer, 0u)] = low;
    chains[chainWord(crew, layer, 8u)] = high;
    before = next;
  }
  return before.least[4];
}

// Turns the chains into candidates, from the goal to the nest.
void follow(uint crew, uint count) {
  uint candidate = 4u;
  for (uint layer = count; layer > 0u; --layer) {
    uint from = (chains[chainWord(crew, layer, candidate)] >> (4u * (candidate & 7u))) & 15u;
    chains[chainWord(crew, layer, 0u)] = candidate;
    candidate = from;
  }
}

// The candidates become moves, those that stay left out; their count.
uint rewrite(uint crew, uint ant, uint count) {
  ivec2 at = placeOf(colony.nest), last = at;
  uint kept = 0u;
  for (uint layer = 1u; layer <= count; ++layer) {
    at += stepOf(moveAt(ant, layer - 1u));
    ivec2 moved = at + besideOf(int(chains[chainWord(crew, layer, 0u)]));
    if (moved == last) continue;
    setMove(ant, kept++, directionOf(moved - last));
    last = moved;
  }
  return kept;
}

void main() {
  uint crew = gl_GlobalInvocationID.x;
  if (crew >= crews()) return;
  uint ant = firstOf(crew * colony.crew, min(colony.ants, (crew + 1u) * colony.crew));
  if (ant == NO_WAY) return;
  uvec2 trip = trips[ant];
  for (uint pass = 0u; pass < colony.passes; ++pass) {
    uint length = relax(crew, ant, trip);
    if (length >= trip.y) break;
    follow(crew, trip.x);
    trip = uvec2(rewrite(crew, ant, trip.x), length);
  }
  trips[ant] = trip;
}
