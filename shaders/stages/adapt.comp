#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Trial and error (docs/stages/adapt.md).
#define HURT
#include "stages/awake.glsl"
#include "shared/adapt.h"
#include "lib/rarely.glsl"
#include "lib/support.glsl"

layout(constant_id = CONSTANT_CANDIDATES) const int CANDIDATES = 1;

LOAD4_BUFFER(BINDING_STEER, steers);
LOAD4_BUFFER(BINDING_BODY, bodies);
LOAD4_BUFFER(BINDING_FOOT, feet);
LOAD4_BUFFER(BINDING_TIP, tips);
LOAD4_BUFFER(BINDING_GAIT_MAP, gaitMap);
LOAD4_BUFFER(BINDING_SEARCH, searches);
STORE4_BUFFER(BINDING_SEARCH_OUT, searchesOut);
STORE4_BUFFER(BINDING_HURT_OUT, hurtsOut);
#include "stages/hurt.glsl"

struct Search {
  uint idle, lame;  // that it has noticed
  float does, trials;
  float candidate, clock;
  float best, bestFitness;
  float wanted, progress, unstable;
};

#define MAP_STRIDE gaitMapStride(LEGS)

Search searchOf(int agent) {
  vec4 a = LOAD4(searches, agent * SEARCH_STRIDE), b = LOAD4(searches, agent * SEARCH_STRIDE + 1);
  vec4 c = LOAD4(searches, agent * SEARCH_STRIDE + 2);
  return Search(uint(a.x), uint(a.y), a.z, a.w, b.x, b.y, b.z, b.w, c.x, c.y, c.z);
}
void store(int agent, Search s) {
  int at = agent * SEARCH_STRIDE;
  STORE4(searchesOut, at, vec4(float(s.idle), float(s.lame), s.does, s.trials));
  STORE4(searchesOut, at + 1, vec4(s.candidate, s.clock, s.best, s.bestFitness));
  STORE4(searchesOut, at + 2, vec4(s.wanted, s.progress, s.unstable, 0.0));
}

// The agent's trials, whose latest is not stored yet. They are no arguments, for a function copies its own.
int trialCount = 0;
int candidates[SEARCH_MOST_TRIALS];
float fitnesses[SEARCH_MOST_TRIALS];
void loadTrials(int agent, int count) {
  trialCount = count;
  for (int i = 0; 2 * i < count; ++i) {
    vec4 two = LOAD4(searches, agent * SEARCH_STRIDE + SEARCH_TRIALS + i);
    candidates[2 * i] = int(two.x);
    fitnesses[2 * i] = two.y;
    candidates[2 * i + 1] = int(two.z);
    fitnesses[2 * i + 1] = two.w;
  }
}
void addTrial(int agent, int candidate, float fitness) {
  int last = trialCount++, even = last / 2 * 2;
  candidates[last] = candidate;
  fitnesses[last] = fitness;
  bool isEven = even == last;
  STORE4(searchesOut, agent * SEARCH_STRIDE + SEARCH_TRIALS + last / 2,
         vec4(float(candidates[even]), fitnesses[even], isEven ? 0.0 : float(candidate), isEven ? 0.0 : fitness));
}

float expectedOf(int candidate) { return LOAD4(gaitMap, candidate * MAP_STRIDE).z; }
float kernelOf(int a, int b) {
  vec4 four = LOAD4(gaitMap, gaitMapRow(a, CANDIDATES, LEGS) + b / 4);
  vec2 two = (b & 2) == 0 ? four.xy : four.zw;
  return (b & 1) == 0 ? two.x : two.y;
}

const int TRIANGLE = SEARCH_MOST_TRIALS * (SEARCH_MOST_TRIALS + 1) / 2;
int inTriangle(int row, int column) { return row * (row + 1) / 2 + column; }

// The Cholesky factor M of the kernel of the trials and their noise, with the reciprocals of its diagonal, and
// M^-1 of their surprises.
float factor[TRIANGLE];
float surprises[SEARCH_MOST_TRIALS];
void factorise() {
  for (int i = 0; i < trialCount; ++i) {
    float surprise = fitnesses[i] - expectedOf(candidates[i]);
    for (int j = 0; j <= i; ++j) {
      float left = kernelOf(candidates[i], candidates[j]) + (i == j ? ADAPT_NOISE : 0.0);
      for (int m = 0; m < j; ++m) left -= factor[inTriangle(i, m)] * factor[inTriangle(j, m)];
      left = i == j ? inversesqrt(max(left, 0.5 * ADAPT_NOISE)) : left * factor[inTriangle(j, j)];
      factor[inTriangle(i, j)] = left;
      surprise = j < i ? surprise - left * surprises[j] : surprise * left;
    }
    surprises[i] = surprise;
  }
}

// How good a candidate may be.
float u[SEARCH_MOST_TRIALS];
float boundOf(int candidate) {
  float mean = expectedOf(candidate), variance = kernelOf(candidate, candidate);
  for (int i = 0; i < trialCount; ++i) {
    float left = kernelOf(candidates[i], candidate);
    for (int m = 0; m < i; ++m) left -= factor[inTriangle(i, m)] * u[m];
    left *= factor[inTriangle(i, i)];
    mean += left * surprises[i];
    variance -= left * left;
    u[i] = left;
  }
  return mean + ADAPT_EXPLORATION * sqrt(max(variance, 0.0));
}

bool wasTried(int candidate) {
  bool was = false;
  for (int i = 0; i < trialCount; ++i) was = was || candidates[i] == candidate;
  return was;
}

void choose(inout Search s) {
  factorise();
  vec4 best = LOAD4(gaitMap, 1);
  float highest = -3e38, most = LOAD4(gaitMap, 0).w;
  // Before any trial all bounds are as far from what is expected.
  int next = trialCount > 0 ? -1 : int(best.w);
  for (int c = 0; trialCount > 0 && c < CANDIDATES; ++c) {
    float bound = boundOf(c);
    if (bound <= highest || wasTried(c)) continue;
    next = c;
    highest = bound;
  }
  bool ends = trialCount > 0 && (trialCount == SEARCH_MOST_TRIALS || s.bestFitness >= ADAPT_GOOD_ENOUGH * most ||
                                 s.bestFitness >= highest);
  s.does = ends ? SEARCH_SETTLED : SEARCH_SEARCHES;
  s.candidate = ends ? s.best : float(next);
}

float marginAt(int agent, Body body) {
  vec2 centre = rotate(body.orientation, vec3(0.0, parameters.bodyHeight, 0.0)).xz, q[LEGS];
  uint planted = 0u;
  for (int leg = 0; leg < LEGS; ++leg) {
    int record = legRecord(agent, leg, LEGS);
    q[leg] = LOAD4(tips, record).xz - centre;
    planted |= LOAD4(feet, record).w >= 1.0 ? 1u << leg : 0u;
  }
  return marginOfPlanted(q, planted, parameters.legLength);
}

// How much slower lame legs make an agent.
float shareOfLame(Search s) {
  float legs = float(LEGS - bitCount(s.idle)), lame = float(bitCount(s.lame & ~s.idle));
  return 1.0 - lame / (2.0 * max(legs, 1.0));
}

// A tick of a trial. Whether it ends.
bool tryOn(int agent, vec2 velocity, float speed, inout Search s) {
  Body body = LOAD_BODY(agent);
  float dt = parameters.dt;
  s.clock += dt;
  if (s.clock > ADAPT_SETTLE_SECONDS + 0.5 * dt) {
    s.wanted += shareOfLame(s) * speed * dt;
    s.progress += body.speed * dot(body.heading, velocity / speed) * dt;
    s.unstable += marginAt(agent, body) < ADAPT_SAFE_MARGIN * parameters.legLength ? dt : 0.0;
  }
  return s.clock >= ADAPT_SETTLE_SECONDS + ADAPT_COUNTED_SECONDS - 0.5 * dt;
}

void conclude(int agent, inout Search s) {
  float counted = s.clock - ADAPT_SETTLE_SECONDS;
  float fitness = clamp(s.progress / s.wanted, 0.0, 1.0) * (1.0 - clamp(s.unstable / counted, 0.0, 1.0));
  loadTrials(agent, int(s.trials));
  addTrial(agent, int(s.candidate), fitness);
  bool isBest = s.trials == 0.0 || fitness > s.bestFitness;
  s.best = isBest ? s.candidate : s.best;
  s.bestFitness = isBest ? fitness : s.bestFitness;
  s.trials += 1.0;
  s.clock = s.wanted = s.progress = s.unstable = 0.0;
}

// Steps of lame legs last longer.
void takeGait(int agent, vec4 masks, Search s) {
  int from = int(s.candidate) * MAP_STRIDE, to = agent * hurtStride(LEGS);
  vec4 head = LOAD4(gaitMap, from);
  STORE4(hurtsOut, to, vec4(masks.xyz, head.x));
  STORE4(hurtsOut, to + 2, vec4(LOAD4(gaitMap, from + 1).xyz, head.y * shareOfLame(s)));
  for (int leg = 0; leg < LEGS; ++leg) {
    vec4 turn = LOAD4(gaitMap, from + GAIT_MAP_LEGS + leg);
    turn.w *= (s.lame >> leg & 1u) != 0u ? LAME_SLOWNESS : 1.0;
    STORE4(hurtsOut, to + HURT_LEGS + leg, turn);
  }
}

void main() {
  int agent = agentAt(int(gl_GlobalInvocationID.x));
  if (agent < 0) return;
  vec4 masks = LOAD4(hurts, agent * hurtStride(LEGS));
  uint idle = uint(masks.x) | uint(masks.y), lame = uint(masks.z);
  Search s = searchOf(agent);
  bool notices = s.idle != idle || s.lame != lame, chooses = false;
  vec2 velocity = LOAD4(steers, agent).xy;
  float speed = length(velocity);
  bool tries = !notices && s.does == SEARCH_SEARCHES && speed >= ADAPT_LEAST_SPEED * parameters.legLength;
  RARELY(notices) {
    s = Search(idle, lame, SEARCH_AT_EASE, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
    for (int i = SEARCH_TRIALS; i < SEARCH_STRIDE; ++i) STORE4(searchesOut, agent * SEARCH_STRIDE + i, vec4(0.0));
    chooses = (idle | lame) != 0u && LEGS - bitCount(idle) >= FEWEST_THAT_WALK;
  }
  RARELY(tries) chooses = tryOn(agent, velocity, speed, s);
  bool concludes = tries && chooses;
  RARELY(concludes) conclude(agent, s);
  RARELY(chooses) choose(s);
  bool changes = notices || s.does == SEARCH_SEARCHES, hasItsOwn = s.does != SEARCH_AT_EASE;
  changes = changes || concludes;
  RARELY(changes) store(agent, s);
  RARELY(hasItsOwn) takeGait(agent, masks, s);
}
