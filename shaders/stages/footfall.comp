#version 460
#extension GL_GOOGLE_include_directive : require
#ifdef OF_TURNS
#include "stages/awake.glsl"
#else
#include "stages/stage.glsl"
#endif
#include "lib/rarely.glsl"

LOAD4_BUFFER(BINDING_BODY, bodies);
LOAD4_BUFFER(BINDING_FOOT, feet);
LOAD4_BUFFER(BINDING_TIP, tips);
LOAD4_BUFFER(BINDING_FLIGHT, flights);
STORE4_BUFFER(BINDING_FLIGHT_OUT, flightsOut);
STORE4_BUFFER(BINDING_FOOTFALL_OUT, footfalls);
#include "stages/counters.glsl"

void main() {
#ifdef OF_TURNS
  int record = legAt(int(gl_GlobalInvocationID.x));
  if (record < 0) return;
#else
  int record = int(gl_GlobalInvocationID.x);
#endif
  int agent = agentOfRecord(record, LEGS), leg = legOfRecord(record, LEGS);
#ifndef OF_TURNS
  if (agent >= int(constants.count)) return;
#endif
  vec4 body = LOAD4(bodies, agent * BODY_STRIDE);
  vec3 tip = LOAD4(tips, record).xyz + body.xyz;
  bool planted = LOAD4(feet, record).w >= 1.0;
  vec4 before = LOAD4(flights, record);
  STORE4(flightsOut, record, vec4(tip, planted ? 0.0 : 1.0));

  RARELY(planted && before.w == 1.0) {
    uint place = atomicAdd(counters[COUNTER_FOOTFALLS], 1u);
    if (place >= constants.room) {
      countForHerd(true, agent, ROW_FOOTFALLS_DROPPED);
      break;
    }
    // The body may have changed its tile; nothing moves half a tile in a tick.
    vec3 way = tip - before.xyz;
    way.xz -= TILE_SIZE * round(way.xz / TILE_SIZE);
    vec2 world = worldOf(tip, tileOf(body.w));
    int at = int(place) * FOOTFALL_STRIDE;
    STORE4(footfalls, at, vec4(world.x, tip.y, world.y, length(way) / parameters.dt));
    STORE4(footfalls, at + 1, vec4(float(constants.first) + float(agent), float(leg), constants.tick, 0.0));
  }
}
