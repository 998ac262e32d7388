#ifndef FORAGE_STAGE_GLSL
#define FORAGE_STAGE_GLSL
// Stage navigate of herds that forage (docs/foraging.md), for its entry point, which declares the bindings.
#include "lib/forage.glsl"
#include "lib/rarely.glsl"
#include "lib/split_mix.glsl"

struct Forager {
  int cell;  // that it goes to; -1: none
  ivec2 heading;
  int state, place, steps;
};
struct Deed {
  int entered;  // a cell; -1: none
  int kind;
  uint grains;
};

// Read at once, before any branch.
ivec2 forageShape = ivec2(grounds[FORAGE_COLUMNS], grounds[FORAGE_ROWS]);
ivec2 forageOrigin = ivec2(grounds[FORAGE_ORIGIN_X], grounds[FORAGE_ORIGIN_Z]);
ivec2 forageNest = ivec2(grounds[FORAGE_NEST_COLUMN], grounds[FORAGE_NEST_ROW]);
int forageCell = int(grounds[FORAGE_CELL]), foragePatience = int(grounds[FORAGE_PATIENCE]);
uvec2 forageSeed = uvec2(grounds[FORAGE_SEED_LOW], grounds[FORAGE_SEED_HIGH]);
uint forageThreshold = grounds[FORAGE_THRESHOLD], foragePower = grounds[FORAGE_POWER];
uint layHome = grounds[FORAGE_LAY_HOME], layOut = grounds[FORAGE_LAY_OUT];

ivec2 middleOf(int cell) { return ivec2(cell % forageShape.x, cell / forageShape.x); }
int cellAt(ivec2 at) { return at.y * forageShape.x + at.x; }

ivec2 cellUnder(vec4 body) {
  ivec2 place =
      ivec2(tileOf(body.w) * (TILE_SIZE * float(FORAGE_QUANTA)) + floor(body.xz * float(FORAGE_QUANTA)));
  return min(max(place - forageOrigin, ivec2(0)) / forageCell, forageShape - 1);
}

void turnTo(int state, inout Forager ant) {
  ant.state = state;
  ant.steps = 0;
  ant.heading = -ant.heading;
}

// It has come to a cell, and may change what it is about.
void arrive(int cell, int place, inout Forager ant, inout Deed deed) {
  deed.entered = cell;
  ++ant.steps;
  if (ant.state == FORAGE_SEARCH) {
    int source = clamp(place - PLACE_FOOD, 0, MOST_SOURCES - 1);
    bool feeds = place == PLACE_FOOD + source && trail[place + DEED_AT] < grounds[FORAGE_AMOUNTS + source];
    if (feeds) deed.kind = place + DEED_AT;
    if (feeds || ant.steps >= foragePatience) turnTo(feeds ? FORAGE_LADEN : FORAGE_BACK, ant);
  } else if (place == PLACE_NEST) {
    deed.kind = ant.state == FORAGE_LADEN ? DEED_BROUGHT : DEED_EMPTY;
    turnTo(FORAGE_REST, ant);
  }
  if (place >= PLACE_BRANCH && place != ant.place) deed.kind = place + DEED_AT;
  ant.place = place;
  deed.grains = ant.state == FORAGE_LADEN ? layHome : ant.state == FORAGE_SEARCH ? layOut : 0u;
}

// The choice function of Deneubourg et al. 1990; 8 where no move is open.
int chosenMove(Forager ant, int cell, uint moves, uint random) {
  ivec2 at = middleOf(cell);
  bool goesHome = ant.state != FORAGE_SEARCH;
  moves = movesAhead(moves, ant.heading);
  if (goesHome) moves = movesHome(moves, at, forageNest);
  uint smells[8], most = 1u;
  for (int d = 0; d < 8; ++d) {
    bool open = (moves >> d & 1u) != 0u;
    int to = open ? cellAt(at + forageStep(d)) : cell;
    smells[d] = forageThreshold + min(trail[TRAIL_CELLS + to], MOST_GRAINS);
    most = open ? max(most, smells[d]) : most;
  }
  uint weights[8];
  for (int d = 0; d < 8; ++d)
    weights[d] = (moves >> d & 1u) == 0u
                     ? 0u
                     : attraction(smells[d], most, foragePower) *
                           preference(ant.heading, d, goesHome, at, forageNest);
  return drawnMove(weights, random);
}

// The agent rests, is lost or has come to where it went.
void decide(int agent, int here, inout Forager ant, inout Deed deed) {
  uvec2 random = splitMixDraw(splitMixDraw(forageSeed, constants.first + uint(agent) + 1u), uint(crowdTick));
  uint ground = grounds[FORAGE_CELLS + here];
  if (ant.heading == ivec2(0)) ant.heading = 1024 * forageStep(int(random.x & 7u));
  if (ant.state == FORAGE_REST) {
    ant.cell = here;
    // The chance grows with the ticks of the crowd in the agent's own; a share of 1 is cut to 2^32 - 1.
    uint ticks = uint(tickSpan), leave = constants.watched > ~0u / ticks ? ~0u : constants.watched * ticks;
    if (random.x >= leave) return;
    ant.state = FORAGE_SEARCH;
    ant.steps = 0;
    ant.place = PLACE_NONE;
  } else {
    ant.cell = here;
    arrive(here, int(ground >> FORAGE_PLACE_SHIFT), ant, deed);
    if (ant.state == FORAGE_REST) return;
  }
  int move = chosenMove(ant, here, ground & 255u, random.y);
  ant.cell = move < 8 ? cellAt(middleOf(here) + forageStep(move)) : -1;
  if (move < 8) ant.heading = turnedHeading(ant.heading, move);
}

vec2 forage(int agent, vec4 body) {
  vec4 aim = LOAD4(foragers, agent * FORAGER_STRIDE), last = LOAD4(foragers, agent * FORAGER_STRIDE + 1);
  int state = int(aim.w);
  Forager ant =
      Forager(int(aim.x) - 1, ivec2(aim.yz), state % FORAGE_STATES, state / FORAGE_STATES, int(last.w));
  Deed deed = Deed(-1, DEED_NONE, 0u);
  ivec2 at = cellUnder(body), apart = abs(at - middleOf(max(ant.cell, 0)));
  int here = cellAt(at);
  bool isLost = ant.cell < 0 || max(apart.x, apart.y) > 1;
  RARELY(isLost || ant.state == FORAGE_REST || ant.cell == here) decide(agent, here, ant, deed);
  STORE4_TWO(foragersOut, agent * FORAGER_STRIDE,
             vec4(float(ant.cell + 1), vec2(ant.heading), float(ant.state + FORAGE_STATES * ant.place)),
             vec4(float(deed.entered + 1), float(deed.grains), float(deed.kind), float(ant.steps)));
  ivec2 goal = ant.cell < 0 ? forageNest : middleOf(ant.cell);
  vec2 target = vec2(2 * forageOrigin + forageCell * (2 * goal + 1)) / (2.0 * float(FORAGE_QUANTA));
  vec2 delta = target - worldOf(body.xyz, tileOf(body.w));
  float speed = ant.state == FORAGE_REST ? 0.0 : LOAD4(goals, agent * GOAL_STRIDE + 1).x;
  return delta * (speed / max(sqrt(dot(delta, delta)), 1e-6));
}

#endif
