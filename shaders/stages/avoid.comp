#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#ifdef LISTED
#include "stages/awake.glsl"
#else
#include "stages/stage.glsl"
#endif
#include "lib/avoid.glsl"
#include "lib/sum64.glsl"
#include "stages/neighbours.glsl"

LOAD4_BUFFER(BINDING_STEER, steers);
STORE4_BUFFER(BINDING_AVOID_OUT, avoidsOut);
LOAD4_BUFFER(BINDING_BODY, bodies);
layout(set = 0, binding = BINDING_CROWDING, std430) buffer CrowdingBlock { uint crowding[]; };
#include "stages/absent.glsl"
#ifdef WALLS
#include "shared/walls.h"
#include "lib/walls.glsl"

LOAD4_BUFFER(BINDING_WALL, walls);

// `place` and `radius` are the agent's, metres; beyond `sight` from its footprint no obstacle counts.
Walls wallsAround(vec2 place, float radius, float sight) {
  vec4 shape = LOAD4(walls, 0), corner = LOAD4(walls, 1);
  vec2 at = clamp(floor((place - corner.xy) * shape.z), vec2(0.0), shape.xy - 1.0);
  vec4 cell = LOAD4(walls, WALL_HEADS + int(at.y) * int(shape.x) + int(at.x));
  Walls found = noWalls(sight);
  NearestEdge nearest = noEdge();
  int first = int(cell.x), edges = int(cell.y);
  for (int i = 0; i < edges; ++i) {
    vec4 ends = LOAD4(walls, first + i * WALL_EDGE_STRIDE), kind = LOAD4(walls, first + i * WALL_EDGE_STRIDE + 1);
    approach(nearest, place, ends, kind.z != 0.0);
    if (kind.y != 0.0) {
      take(found, planeBeside(nearest, radius + kind.x));
      nearest = noEdge();
    }
  }
  return found;
}
#endif

// In each tick of a round some blocks look around: their numbers in the kind are so much more than a multiple of its
// ticks.
int roundTicks = int(constants.watched >> 8 & 15u), roundBlock = int(constants.watched >> 12 & 15u);
// Agents of the kind in front of the page, from where a round of blocks begins.
int roundSkip = int(constants.watched >> 16);

void main() {
  int place = int(gl_GlobalInvocationID.x);
#ifdef LISTED
  int agent = agentAt(place);
  if (agent < 0 || (agent + roundSkip) / BLOCK % roundTicks != roundBlock) return;
#else
  int agent = (place / BLOCK * roundTicks + roundBlock) * BLOCK + place % BLOCK - roundSkip;
  if (agent < 0 || agent >= int(constants.count)) return;
#endif
  // The decision holds until the agent looks around again.
  parameters.dt *= max(1.0, float(roundTicks) / tickSpan);
  if (absent(agent)) {
    STORE4(avoidsOut, agent, vec4(0.0, 0.0, 1.0, 0.0));
    return;
  }
  int number = numberOf(agent);
  vec4 steer = LOAD4(steers, agent), moving = LOAD4(bodies, agent * BODY_STRIDE + 1);
  vec4 stand = LOAD4(places, number);
  int own = int(stand.x);
  vec4 self = LOAD4(walkers, own), going = LOAD4(walkers, own + int(stand.z));
  int seen = findNearest(own, self, int(stand.y));
  RARELY(seen > NEIGHBOURS) ADD64(crowding, CROWDING_DROPPED, uint(seen - NEIGHBOURS));

  vec2 wanted = steer.xy;
  float speed = length(wanted), near = 0.0, right = 0.0, left = 0.0, most = AVOID_FREE * parameters.legLength;
  float room = roomOf(moving.z, speed);
  HalfPlane planes[NEIGHBOURS];
  CellSide sides[NEIGHBOURS];
  [[unroll]] for (int k = 0; k < NEIGHBOURS; ++k) {
    bool there = nearest[k] >= 0;
    int at = max(nearest[k], 0);
    vec4 other = LOAD4(walkers, at), moves = LOAD4(walkers, at + int(stand.z));
    int x = there ? int(other.x - self.x) : 1, z = there ? int(other.y - self.y) : 0;
    vec2 p = (other.xy - self.xy) * metres;
    // It is the root of a whole number, which is exact.
    float d = sqrt(float(x * x + z * z)) * metres, r = (other.z + self.z) * metres;
    float closeness = there ? closenessOf(d, r) : 0.0, turn = turnFrom(p, d, wanted, speed, closeness);
    near = max(near, closeness);
    right = max(right, turn);
    left = max(left, -turn);
    int who = int(other.w);
    float share = moves.z != 0.0 ? 0.5 : 1.0;
    planes[k] = halfPlaneOf(p, d, r, min(room, 1.0 + float(look) * metres / r), going.xy, going.xy - moves.xy, share,
                            partingLine(number, who));
    bool yields = moves.z == 0.0 || goesFirst(who, number, constants.tick);
    sides[k] = cellSideOf(p, d, r, float(min(self.z, other.z)) * metres, moves.xy, moves.z != 0.0, yields, parameters);
    sides[k].n = there ? sides[k].n : vec2(0.0);
    most = there ? min(most, speedToward(sides[k], moving.xy)) : most;
    // Nobody forbids anything.
    planes[k].n = there ? planes[k].n : vec2(0.0);
    planes[k].bound = there ? planes[k].bound : -1.0;
  }

  float aside = (right - left) * max(0.0, 1.0 - moving.z / max(speed, 1e-6));
  vec2 velocity = (wanted + aside * vec2(-wanted.y, wanted.x)) / sqrt(1.0 + aside * aside);
  bool forbidden = false;
  [[unroll]] for (int k = 0; k < NEIGHBOURS; ++k)
    forbidden = forbidden || planes[k].bound > dot(planes[k].n, velocity);
#ifdef WALLS
  Walls around = wallsAround(self.xy * metres, self.z * metres, float(look) * metres);
  [[unroll]] for (int k = 0; k < NEAREST_WALLS; ++k)
    forbidden = forbidden || around.planes[k].bound > dot(around.planes[k].n, velocity);
  RARELY(forbidden) velocity = solveAmongWalls(planes, around, velocity);
#else
  RARELY(forbidden) velocity = solvePlanes(planes, velocity);
#endif
  float fastest = max(speed, AVOID_PUSH_SPEED * parameters.legLength), moved = length(velocity);
  velocity *= moved > fastest ? fastest / moved : 1.0;
  moved = min(moved, fastest);
  float steady = AVOID_STEADY_SPEED * parameters.legLength * near;
  // Devices need not divide a number by itself exactly.
  velocity = near > 0.0 ? (velocity + steady * moving.xy) * (moved / max(moved + steady, 1e-6)) : velocity;
  [[unroll]] for (int sweep = 0; sweep < AVOID_CELL_SWEEPS; ++sweep) {
    velocity = ontoSides(sides, velocity);
#ifdef WALLS
    velocity = besideWalls(around, AVOID_PUSH_SPEED * parameters.legLength, velocity);
#endif
  }
  velocity = shortened(sides, velocity);
  bool asleep = steer.z != 0.0 && length(velocity) < 1e-2 * parameters.legLength;
  STORE4(avoidsOut, agent, vec4(velocity, asleep ? 1.0 + float(seen) : -float(seen), most));
}
