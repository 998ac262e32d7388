// Whom the stages from body to pose run over: everybody, or where agents may sleep, or blocks have rates of their own,
// the blocks that `wake` listed. Stages that say who sleeps (LISTED) run over whole blocks.
#ifndef AWAKE_GLSL
#define AWAKE_GLSL
#include "stages/stage.glsl"

layout(constant_id = CONSTANT_SLEEP) const int SLEEP = SLEEP_NEVER;
LOAD4_BUFFER(BINDING_AWAKE, awake);

// The agent in a place among those, or -1: there is none, or it sleeps.
int agentAt(int place) {
  if (SLEEP == SLEEP_NEVER) return place < int(constants.count) ? place : -1;
  vec4 block = LOAD4(awake, place / BLOCK);
  int lane = place % BLOCK;
  tickOver(LEVELS ? max(block.z, 1.0) : 1.0);
#ifdef LISTED
  uint lanes = uint(block.w);
#else
  uint lanes = uint(block.y);
#endif
  return (lanes >> lane & 1u) != 0u ? int(block.x) * BLOCK + lane : -1;
}

// The record of the leg in a place among theirs, block by block as the records are, or -1.
int legAt(int place) {
  int agent = agentAt(agentOfRecord(place, LEGS));
  return agent < 0 ? -1 : SLEEP == SLEEP_NEVER ? place : legRecord(agent, legOfRecord(place, LEGS), LEGS);
}

#endif
