// The agents near an agent, found by the crowd's grid (docs/stages/avoid.md): for stages of herds that avoid.
#include "lib/avoid.glsl"
#include "lib/cells.glsl"
#include "lib/rarely.glsl"
#include "shared/grid.h"

LOAD4_BUFFER(BINDING_CELL, cells);
LOAD4_BUFFER(BINDING_PLACE, places);
LOAD4_BUFFER(BINDING_WALKER, walkers);

int buckets = int(constants.every), row = GRID_ROW(findMSB(buckets)), look = int(constants.room);
// The lowest bits of a power that a key leaves out.
int dropped = int(constants.watched & 255u);
float metres = constants.sleepTime;

int numberOf(int agent) { return int(constants.first) + agent; }

// The walkers of the nearest, the nearest first; -1 is nobody.
int nearest[NEIGHBOURS];

// How far a walker is in power, and whether it is in reach of `self`.
int powerOf(vec4 other, vec4 self, out bool inReach) {
  int x = abs(int(other.x - self.x)), z = abs(int(other.y - self.y)), radii = int(other.z + self.z);
  int reach = radii + look, distance2 = x * x + z * z;
  // Where x or z is beyond reach, the square may be beyond an int.
  inReach = max(x, z) <= reach && distance2 <= reach * reach;
  return distance2 - radii * radii;
}

// The nearest of however many agents, by power and number.
void findNearestExactly(Runs runs, int own, vec4 self) {
  int power[NEIGHBOURS], number[NEIGHBOURS];
  [[unroll]] for (int k = 0; k < NEIGHBOURS; ++k) {
    power[k] = number[k] = 0x7FFFFFFF;
    nearest[k] = -1;
  }
  for (int i = 0; i < runs.count; ++i) {
    int at = walkerIn(runs, i);
    vec4 other = LOAD4(walkers, at);
    bool inReach;
    int p = powerOf(other, self, inReach), n = int(other.w);
    bool before = inReach && at != own && isBefore(p, n, power[NEIGHBOURS - 1], number[NEIGHBOURS - 1]);
    [[unroll]] for (int k = NEIGHBOURS - 1; k >= 0; --k) {
      int less = max(k - 1, 0);
      bool earlier = before && k > 0 && isBefore(p, n, power[less], number[less]);
      power[k] = earlier ? power[less] : before ? p : power[k];
      number[k] = earlier ? number[less] : before ? n : number[k];
      nearest[k] = earlier ? nearest[less] : before ? at : nearest[k];
      before = earlier;
    }
  }
}

// Sorts the nearest by power and number.
void sortNearest(vec4 self) {
  int power[NEIGHBOURS], number[NEIGHBOURS];
  [[unroll]] for (int k = 0; k < NEIGHBOURS; ++k) {
    vec4 other = LOAD4(walkers, max(nearest[k], 0));
    bool inReach;
    power[k] = nearest[k] < 0 ? 0x7FFFFFFF : powerOf(other, self, inReach);
    number[k] = int(other.w);
  }
  for (int sweep = 1; sweep < NEIGHBOURS; ++sweep)
    [[unroll]] for (int k = 1; k < NEIGHBOURS; ++k) {
      int p = power[k], n = number[k], walker = nearest[k];
      bool swap = isBefore(p, n, power[k - 1], number[k - 1]);
      power[k] = swap ? power[k - 1] : p;
      number[k] = swap ? number[k - 1] : n;
      nearest[k] = swap ? nearest[k - 1] : walker;
      power[k - 1] = swap ? p : power[k - 1];
      number[k - 1] = swap ? n : number[k - 1];
      nearest[k - 1] = swap ? walker : nearest[k - 1];
    }
}

// Finds the nearest to the agent with walker `own`, which holds `self`, in a cell. Returns how many are in
// reach.
int findNearest(int own, vec4 self, int cell) {
  Runs runs = LOAD_RUNS(cell, row, buckets);
  int seen = 0;
  // A key is a power, but for its lowest bits, and who of the runs it is of, so that minima and maxima sort
  // them. One more is kept than is asked for, to tell whether it could as well be among these.
  const int nobody = 0x7FFFFFFF, keyed = 1 << NEIGHBOUR_KEY_BITS;
  int keys[NEIGHBOURS + 1];
  [[unroll]] for (int k = 0; k <= NEIGHBOURS; ++k) keys[k] = nobody;
  for (int i = 0; i < runs.count; ++i) {
    int at = walkerIn(runs, i);
    bool inReach;
    int power = powerOf(LOAD4(walkers, at), self, inReach);
    inReach = inReach && at != own;
    int key = inReach ? (power >> dropped) * keyed + i : nobody;
    seen += inReach ? 1 : 0;
    [[unroll]] for (int k = NEIGHBOURS; k > 0; --k) keys[k] = min(keys[k], max(keys[k - 1], key));
    keys[0] = min(keys[0], key);
  }
  bool alike[NEIGHBOURS];
  [[unroll]] for (int k = 0; k < NEIGHBOURS; ++k) {
    alike[k] = keys[k + 1] != nobody && keys[k] >> NEIGHBOUR_KEY_BITS == keys[k + 1] >> NEIGHBOUR_KEY_BITS;
    nearest[k] = keys[k] == nobody ? -1 : walkerIn(runs, keys[k] & (keyed - 1));
  }
  bool unsorted = false;
  [[unroll]] for (int k = 0; k < NEIGHBOURS - 1; ++k) unsorted = unsorted || alike[k];
  bool unsure = alike[NEIGHBOURS - 1] || runs.count > keyed;
  RARELY(unsorted && !unsure) sortNearest(self);
  RARELY(unsure) findNearestExactly(runs, own, self);
  return seen;
}
