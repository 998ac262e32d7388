#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// wake where blocks tick at rates of their own (docs/levels.md): lists those whose turn it is, and says at which rate
// each goes on.
#ifndef REACTS
#define WITHOUT_PARAMETERS
#endif
#include "stages/stage.glsl"
#include "lib/rarely.glsl"
#include "lib/sum64.glsl"

layout(constant_id = CONSTANT_JOINTS) const int JOINTS = 1;
LOAD4_BUFFER(BINDING_BODY, bodies);
LOAD4_BUFFER(BINDING_RATE, rates);
STORE4_BUFFER(BINDING_RATE_OUT, ratesOut);
STORE4_BUFFER(BINDING_AWAKE_OUT, awakeOut);
layout(set = 0, binding = BINDING_COUNTERS, std430) buffer CountersBlock { uint counters[]; };
layout(set = 0, binding = BINDING_LEVELS, std430) buffer LevelsBlock { uint levels[]; };

#include "stages/absent.glsl"
#ifdef REACTS
#include "lib/react.glsl"
LOAD4_BUFFER(BINDING_PUSH, pushes);
LOAD4_BUFFER(BINDING_CARRIED, loads);
LOAD4_BUFFER(BINDING_REACTION, reactions);
STORE4_BUFFER(BINDING_REACTION_OUT, reactionsOut);

bool isPushed(int agent) { return LOAD4(pushes, agent).w == constants.tick; }

// Whether nobody is disturbed.
bool isCalm(int first, uint present) {
  bool calm = true;
  [[unroll]] for (int lane = 0; lane < BLOCK; ++lane) {
    int agent = (present >> lane & 1u) != 0u ? first + lane : 0;
    vec4 reaction = LOAD4(reactions, agent * REACTION_STRIDE);
    bool steady = reaction.x == REACTION_STEADY && reaction.z <= 0.0 && !isPushed(agent);
    calm = calm && ((present >> lane & 1u) == 0u || steady);
  }
  return calm;
}

// Agents that have no tick of their own now take a push all the same.
void takePushes(int first, uint present) {
  for (int lane = 0; lane < BLOCK; ++lane) {
    int agent = first + lane, at = agent * REACTION_STRIDE;
    if ((present >> lane & 1u) == 0u || !isPushed(agent)) continue;
    vec4 state = LOAD4(reactions, at), motion = LOAD4(reactions, at + 1);
    state.z = uniformParameters.disturbTime;
    motion.xy += LOAD4(pushes, agent).xy / (1.0 + LOAD4(loads, agent * CARRIED_STRIDE).w);
    STORE4(reactionsOut, at, state);
    STORE4(reactionsOut, at + 1, motion);
  }
}
#endif

uint groupsOf(uint invocations) { return (invocations + uint(WORK_GROUP) - 1u) / uint(WORK_GROUP); }

// The lanes in which somebody is.
uint presentOf(int first, int members) {
  uint present = (1u << members) - 1u;
  if (RESERVE)
    [[unroll]] for (int lane = 0; lane < BLOCK; ++lane)
      present &= ~(lane < members && absent(first + lane) ? 1u << lane : 0u);
  return present;
}

// From the camera to the nearest of those: whole numbers, which no device rounds.
uint nearestOf(int first, int last, uint present) {
  ivec3 camera = ivec3(uvec3(constants.every, constants.watched, constants.room));
  uint nearest = ~0u;
  [[unroll]] for (int lane = 0; lane < BLOCK; ++lane) {
    vec4 body = LOAD4(bodies, min(first + lane, last) * BODY_STRIDE);
    vec2 tile = tileOf(body.w) * (4.0 * TILE_SIZE);
    ivec3 place = ivec3(floor(4.0 * body.xyz) + vec3(tile.x, 0.0, tile.y));
    uvec3 apart = min(uvec3(abs(place - camera)), uvec3(LEVELS_FARTHEST));
    uint square = apart.x * apart.x + apart.y * apart.y + apart.z * apart.z;
    nearest = RESERVE && (present >> lane & 1u) == 0u ? nearest : min(nearest, square);
  }
  return max(nearest, uint(LEVELS_NEAREST));
}

int bucketOf(uint square) {
  int octave = findMSB(square) - findMSB(uint(LEVELS_NEAREST));
  return 8 * octave + int(square >> octave & 7u);
}
// The farthest distance in a bucket.
uint edgeOf(int bucket) { return (uint(9 + bucket % 8) << (bucket / 8)) - 1u; }

// How far each level may reach in the next tick, by the distances of the last one.
void findEdges(uint tick) {
  int from = LEVELS_HISTOGRAM + LEVELS_HISTOGRAM_STRIDE * int((tick + 1u) & 1u);
  int to = LEVELS_EDGE + LEVELS_EDGES * int((tick + 1u) & 1u);
  for (int level = 0; level < RATE_LEVELS - 1; ++level) {
    uint sum = 0u, edge = 0u;
    for (int bucket = 0; bucket < LEVELS_BUCKETS; ++bucket) {
      sum += levels[from + bucket];
      if (sum <= levels[LEVELS_MOST + level]) edge = edgeOf(bucket);
    }
    levels[to + level] = edge;
  }
}

void main() {
  int block = int(gl_GlobalInvocationID.x), count = int(constants.count), first = block * BLOCK;
  int flags = int(constants.sleepTime), members = clamp(count - first, 0, BLOCK), last = max(count - 1, 0);
  uint tick = uint(constants.tick), turn = tick + constants.first / uint(BLOCK) + uint(block);
  int edges = LEVELS_EDGE + LEVELS_EDGES * int(tick & 1u);
  uint present = presentOf(first, members), agents = uint(bitCount(present));
  uint nearest = nearestOf(first, last, present);
  int level = int(LOAD4(rates, min(first, last)).x);
  // A level reaches to a distance; who is slower comes back within a fifth less of its square.
  int least = 0, most = 0;
  [[unroll]] for (int k = 0; k < RATE_LEVELS - 1; ++k) {
    uint far = min(levels[LEVELS_FAR + k], levels[edges + k]);
    least += nearest > far ? 1 : 0;
    most += nearest > far - far / 5u ? 1 : 0;
  }
  bool hasTurn = (turn & ((1u << level) - 1u)) == 0u;
  int wanted = (flags & LEVELS_HAS_CAMERA) != 0 ? clamp(level, least, most) : 0;
#ifdef REACTS
  bool calm = isCalm(first, present);
  wanted = calm ? wanted : 0;
  RARELY(!calm && !hasTurn) takePushes(first, present);
#endif
  wanted = min(wanted, flags / LEVELS_SLOWEST);
  int next = hasTurn ? (turn == 0u ? wanted : min(wanted, findLSB(turn))) : level;

  // Before its first tick nobody has a rate.
  RARELY(members > 0 && tick > 0u) {
    atomicAdd(levels[LEVELS_HISTOGRAM + LEVELS_HISTOGRAM_STRIDE * int(tick & 1u) + bucketOf(nearest)], agents);
    atomicAdd(levels[LEVELS_AGENTS + next], agents);
  }
  RARELY(members > 0 && hasTurn && tick > 0u) {
    ADD64(levels, LEVELS_TICKS + 2 * level, agents);
    for (int lane = 0; lane < members; ++lane)
      STORE4(ratesOut, first + lane,
             vec4(float(next), float(level), constants.tick, LOAD4(rates, first + lane).w));
  }
  RARELY(members > 0 && hasTurn) {
    uint place = atomicAdd(counters[COUNTER_AWAKE_BLOCKS], 1u), lanes = (place + 1u) * uint(BLOCK);
    atomicAdd(counters[COUNTER_AWAKE], agents);
    STORE4(awakeOut, place, vec4(float(block), float(present), float(1u << level), float((1u << members) - 1u)));
    atomicMax(counters[COUNTER_AWAKE_AGENTS_X], groupsOf(lanes));
    atomicMax(counters[COUNTER_AWAKE_LEGS_X], groupsOf(lanes * uint(LEGS)));
    atomicMax(counters[COUNTER_AWAKE_JOINTS_X], groupsOf(lanes * uint(JOINTS)));
  }
  RARELY((flags & LEVELS_IS_FIRST) != 0 && block == 0 && tick > 0u) findEdges(tick);
}
