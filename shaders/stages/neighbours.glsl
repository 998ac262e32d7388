// The agents near an agent, found by the crowd's grid (docs/stages/avoid.md): for stages of herds that avoid.
#include "lib/avoid.glsl"
#include "lib/cells.glsl"
#include "lib/rarely.glsl"

LOAD4_BUFFER(BINDING_CELL, cells);
LOAD4_BUFFER(BINDING_PLACE, places);
LOAD4_BUFFER(BINDING_WALKER, walkers);

int buckets = int(constants.every), row = int(constants.watched), look = int(constants.room);
float metres = constants.sleepTime;

int numberOf(int agent) { return int(constants.first) + agent; }

// The nearest to an agent, and how many are in reach.
Nearest nearestTo(int number, vec4 self, int bucket, out int seen) {
  Nearest nearest = nobodyNear();
  Runs runs = LOAD_RUNS(bucket, row, buckets);
  int count = agentsIn(runs);
  seen = 0;
  for (int i = 0; i < count; ++i) {
    vec4 other = LOAD4(places, placeIn(runs, i));
    int x = abs(int(other.x - self.x)), z = abs(int(other.y - self.y)), radii = int(other.z + self.z);
    int reach = radii + look, distance2 = x * x + z * z, who = int(other.w);
    // Where x or z is beyond reach, the square may be beyond an int.
    bool inReach = who != number && max(x, z) <= reach && distance2 <= reach * reach;
    int power = distance2 - radii * radii;
    seen += inReach ? 1 : 0;
    RARELY(inReach && isBefore(power, who, nearest.power[NEIGHBOURS - 1], nearest.number[NEIGHBOURS - 1]))
      insertNearest(nearest, power, who);
  }
  return nearest;
}
