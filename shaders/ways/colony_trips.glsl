// The trips of ants: moves, and where each ended.
layout(set = 0, binding = COLONY_MOVE, std430) buffer MoveBlock { uint moves[]; };
layout(set = 0, binding = COLONY_TRIP, std430) buffer TripBlock { uvec2 trips[]; };  // moves, length

uint moveWord(uint ant, uint move) { return (move >> 3) * colony.ants + ant; }

uint moveAt(uint ant, uint move) { return (moves[moveWord(ant, move)] >> (4u * (move & 7u))) & 15u; }

void setMove(uint ant, uint move, uint direction) {
  uint word = moveWord(ant, move), at = 4u * (move & 7u);
  moves[word] = (moves[word] & ~(15u << at)) | (direction << at);
}

// The first ant of those that arrived by the shortest way, or NO_WAY.
uint firstOf(uint begin, uint end) {
  uint first = NO_WAY, length = NO_WAY;
  for (uint ant = begin; ant < end; ++ant) {
    uint other = trips[ant].y;
    if (other < length) first = ant, length = other;
  }
  return first;
}
