// Lines between an agent and its neighbours, on whose near side its feet land (docs/stages/foothold.md), for herds that
// avoid.
#include "stages/neighbours.glsl"

const int OTHERS_TIMES = 3;
const float OTHERS_MARGIN = 0.6;    // of the footprint
const float OTHERS_WEIGHT = 100.0;  // of the square of leg lengths beyond a line

// Between the agent and each neighbour at each time: n from one to the other, and the most that n . q may be of a place
// q, relative to the body.
vec3 lines[NEIGHBOURS * OTHERS_TIMES];

// For a foot that lands after `landing` seconds and stands for `stance`.
void drawLines(int agent, float landing, float stance) {
  vec4 place = LOAD4(places, numberOf(agent));
  int own = int(place.x);
  vec4 self = LOAD4(walkers, own), going = LOAD4(walkers, own + int(place.z));
  findNearest(own, self, int(place.y));
  [[unroll]] for (int k = 0; k < NEIGHBOURS; ++k) {
    bool there = nearest[k] >= 0;
    int at = max(nearest[k], 0);
    vec4 other = LOAD4(walkers, at), moves = LOAD4(walkers, at + int(place.z));
    vec2 between = (other.xy - self.xy) * metres;
    float radii = (self.z + other.z) * metres, share = self.z / (self.z + other.z);
    float margin = OTHERS_MARGIN * self.z * metres;
    [[unroll]] for (int i = 0; i < OTHERS_TIMES; ++i) {
      float time = landing + 0.5 * stance * float(i);
      vec2 d = between + time * (moves.xy - going.xy);
      float apart = length(d);
      vec2 n = d * (1.0 / max(apart, 1e-6));
      float most = max(apart, radii) * share + time * dot(n, going.xy) - margin;
      lines[k * OTHERS_TIMES + i] = there ? vec3(n, most) : vec3(0.0);
    }
  }
}

// The cost of a place, relative to the body along world axes.
float costOfOthers(vec2 place, float inverseSquare) {
  float beyond = 0.0;
  [[unroll]] for (int i = 0; i < NEIGHBOURS * OTHERS_TIMES; ++i)
    beyond = max(beyond, dot(lines[i].xy, place) - lines[i].z);
  return OTHERS_WEIGHT * beyond * beyond * inverseSquare;
}
