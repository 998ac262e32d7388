#ifndef HURT_GLSL
#define HURT_GLSL
// Which legs of an agent are hurt, and the gait that it has for it (docs/damage.md): of herds that can be hurt, whose
// entry points are made with HURT.
#ifdef HURT
#include "lib/gait.glsl"
#ifdef REACTS
#include "lib/react.glsl"
LOAD4_BUFFER(BINDING_REACTION, reactions);
LOAD4_BUFFER(BINDING_CARRIED, loads);
#endif

LOAD4_BUFFER(BINDING_HURT, hurts);

struct Hurt {
  uint lost, idle;  // masks of legs; idle ones do not carry
  float groups;
  vec3 shift;   // of the homes, model space
  float speed;  // share of the desired velocity
#ifdef REACTS
  float hurry;  // m/s that a push adds to how fast the feet must move
  bool stumbles;
#endif
};

Hurt hurtOf(int agent) {
  vec4 masks = LOAD4(hurts, agent * hurtStride(LEGS)), body = LOAD4(hurts, agent * hurtStride(LEGS) + 2);
#ifdef REACTS
  return Hurt(uint(masks.x), uint(masks.x) | uint(masks.y), masks.w, body.xyz, body.w, 0.0, false);
#else
  return Hurt(uint(masks.x), uint(masks.x) | uint(masks.y), masks.w, body.xyz, body.w);
#endif
}

// The same with what react says of this tick (docs/stages/react.md), of a body that is so turned.
#ifdef REACTS
Hurt hurtNow(int agent, vec4 orientation) {
  Hurt hurt = hurtOf(agent);
  Reaction r = LOAD_REACTION(agent);
  bool fallen = isFallen(r.phase);
  vec3 ahead = rotateBack(orientation, vec3(r.velocity.x, 0.0, r.velocity.y)) *
               pendulumTime(parameters, LOAD4(loads, agent * CARRIED_STRIDE));
  hurt.idle |= fallen ? (1u << LEGS) - 1u : 0u;
  hurt.shift += fallen ? vec3(0.0) : vec3(ahead.x, 0.0, ahead.z);
  hurt.hurry = fallen ? 0.0 : length(r.velocity);
  hurt.stumbles = r.phase == REACTION_STUMBLING;
  return hurt;
}
#else
#define hurtNow(agent, orientation) hurtOf(agent)
#endif

// Group, lag, neighbours, and how many times as long as others its step lasts.
#define HURT_LEG(agent, leg) LOAD4(hurts, (agent) * hurtStride(LEGS) + HURT_LEGS + (leg))

bool carries(int agent, int leg) {
  vec4 masks = LOAD4(hurts, agent * hurtStride(LEGS));
  return ((uint(masks.x) | uint(masks.y)) >> leg & 1u) == 0u;
}
bool isLost(int agent, int leg) { return (uint(LOAD4(hurts, agent * hurtStride(LEGS)).x) >> leg & 1u) != 0u; }

// The first bone of a leg that is lost; BONES where none is.
int lostFrom(int agent, int leg) {
  vec4 bones = LOAD4(hurts, agent * hurtStride(LEGS) + 1);
  int six = leg / HURT_BONES_LEGS;
  float packed = six < 2 ? (six == 0 ? bones.x : bones.y) : (six == 2 ? bones.z : bones.w);
  return isLost(agent, leg) ? packedBone(packed, leg) : BONES;
}

// Ticks of a leg's step.
float slowTicks(float ticks, float slowness) { return floor(slowness * ticks + 0.5); }

// The cycle has room for the slowest leg in every group.
Stride strideOfHurt(Parameters q, Body body, int agent, Hurt hurt) {
  float slowest = 1.0;
  for (int leg = 0; leg < LEGS; ++leg)
    slowest = max(slowest, (hurt.idle >> leg & 1u) == 0u ? HURT_LEG(agent, leg).w : 1.0);
#ifdef REACTS
  float surfaceSpeed = body.surfaceSpeed + hurt.hurry;
#else
  float surfaceSpeed = body.surfaceSpeed;
#endif
  Stride s = strideFor(q, surfaceSpeed, body.turnRate, hurt.groups);
  s.cycle = max(s.cycle, hurt.groups * slowTicks(s.ticks, slowest) * q.dt * q.windowSlack);
  float v = surfaceSpeed + abs(body.turnRate) * q.homeRadius;
  s.halfStride = clamp(0.5 * v * (s.cycle - s.swing), q.halfStrideStill, q.halfStrideMax);
  s.spread = q.lagShare * (1.0 / hurt.groups - s.swing / s.cycle);
  return s;
}

// Guards what is for legs that carry alone; others have no such guard.
#define WHERE_CARRIES(hurt, leg) if (((hurt).idle >> (leg) & 1u) == 0u)
#else
#define WHERE_CARRIES(hurt, leg)
#endif

#endif
