#ifndef GAIT_STAGE_GLSL
#define GAIT_STAGE_GLSL
// Stage gait, for entry points that make it alone or together with body; they declare its bindings.
#include "lib/gait.glsl"
#include "stages/rig_legs.glsl"
#include "stages/ground.glsl"
#include "lib/hermite.glsl"
#include "stages/hurt.glsl"

// In the ticks after an edit of the heights; else no height is looked up here.
layout(constant_id = CONSTANT_WATCH) const int WATCH = 0;
// Not a uniform: branched on by itself, lavapipe inlines its value and rebuilds the kernel in every dispatch.
layout(constant_id = CONSTANT_REACH) const int REACH = 0;

// Height of the ground above a point relative to the body.
float above(vec3 point, Body body) {
  vec2 world = worldOf(body.local, body.tile) + point.xz;
  return groundAt(world).x - (body.local.y + point.y);
}

void makeGait(int agent, Body body) {
#ifdef HURT
  Hurt hurt = hurtNow(agent, body.orientation);
  Stride stride = strideOfHurt(parameters, body, agent, hurt);
  float groups = hurt.groups;
  // A leg that carries again hangs in the air, and comes down by a step.
  uint rises = uint(LOAD4(gaits, agent * GAIT_STRIDE + 1).w) & ~hurt.idle;
  hurt.idle |= rises;
#else
  Stride stride = strideFor(parameters, body.surfaceSpeed, body.turnRate, float(GROUPS));
  const float groups = float(GROUPS);
#endif
  float stance = stride.cycle - stride.swing;
  float phase = LOAD4(gaits, agent * GAIT_STRIDE).x + parameters.dt / stride.cycle;
  phase -= floor(phase);

  mat3 orientation = matrixOf(body.orientation);
  uint air = 0u, wants = 0u, reaim = 0u;
  // The leg that must lift and has stood longest goes first, and its neighbours wait for it.
  uint first = 0u, yields = 0u;
  float stoodSince = 3e38;
  bool settled = body.still >= parameters.settleTime;
  float inverseHalfStride = 1.0 / stride.halfStride, liftShare = REACH != 0 ? REACH_SHARE : parameters.liftShare;
  float rootShare2 = squared(parameters.rootShare), stretchLift2 = squared(parameters.stretchLift),
        strayShare2 = squared(parameters.strayShare), liftShare2 = squared(liftShare),
        reaimDistance2 = squared(parameters.reaimDistance);
  [[unroll]] for (int leg = 0; leg < LEGS; ++leg) {
    int record = legRecord(agent, leg, LEGS);
    Step s = LOAD_STEP(record);
    vec4 root = RIG_LEG(leg, 0), home = RIG_LEG(leg, 1), order = RIG_LEG(leg, 2);
#ifdef HURT
    vec4 own = HURT_LEG(agent, leg);
    home = vec4(home.xyz + hurt.shift, own.x);
    order.xy = own.yz;
    stance = stride.cycle - slowTicks(stride.ticks, own.w) * parameters.dt;
#endif
    float flown = thisTick - 1.0 - s.firstTick;
    float u = stepProgress(s, thisTick - 1.0);
    vec3 landing = fromStep(s.landing, s, body.local, body.tile);
    vec3 foot = landing * orientation;
    bool moved = WATCH != 0 && abs(above(landing, body)) > parameters.groundTolerance;
    WHERE_CARRIES(hurt, leg)
    if (u >= 1.0) {
      // Distances are compared by their squares.
      vec3 arm = (foot - root.xyz) * order.z;
      vec2 astray = (foot.xz - home.xz) * inverseHalfStride;
      float stretch = dot(arm, arm), off = dot(astray, astray);
      bool must = stretch < rootShare2 || stretch > stretchLift2 || off > strayShare2 ||
                  LOAD_MISS(agent, leg) > parameters.errorLift;
      bool far = off > liftShare2;
      bool open = REACH != 0 || windowOpen(parameters, phase, home.w, order.x, stride, groups);
#ifdef REACTS
      open = open || hurt.stumbles;
#endif
      wants |= !settled && open && (far || must || s.lastResort) ? 1u << leg : 0u;
      // Who stands still steps only off ground that moves.
      must = moved || (!settled && (must || (REACH != 0 && far)));
      if (must && s.firstTick + s.ticks < stoodSince) {
        stoodSince = s.firstTick + s.ticks;
        first = 1u << leg;
        yields = uint(order.y);
      }
    } else {
      air |= 1u << leg;
      vec3 predicted = predictLanding(home.xyz, body.turnRate, body.surfaceSpeed, (s.ticks - flown) * parameters.dt, stance);
      vec2 apart = predicted.xz - foot.xz;
      bool strayed = dot(apart, apart) > reaimDistance2;
      bool anew = strayed && u < parameters.reaimLatest;
      if (WATCH != 0) {
        Swing flight = swingOf(s, LOAD_ARC(record), body.local, body.tile);
        float way = easedTime(u, startRate(flight));
        for (int i = 0; i < AHEAD; ++i) {
          vec3 ahead = swingPoint(flight, mix(way, 1.0, float(i) / float(AHEAD)));
          moved = moved || above(ahead, body) > parameters.groundTolerance;
        }
      }
      reaim |= (anew || moved) && flown >= 4.0 ? 1u << leg : 0u;
    }
  }

#ifdef HURT
  air |= rises;
#endif
  uint lift = (yields & air) == 0u ? first : 0u;
  wants &= ~yields;
  [[unroll]] for (int leg = 0; leg < LEGS; ++leg) {
#ifdef HURT
    uint neighbours = uint(HURT_LEG(agent, leg).z);
#else
    uint neighbours = uint(RIG_LEG(leg, 2).y);
#endif
    lift |= (neighbours & (air | lift)) == 0u ? wants & (1u << leg) : 0u;
  }

  float idle = 0.0;
#ifdef HURT
  lift |= rises;
  reaim |= rises;
  idle = float(hurt.idle & ~rises);
#endif
  STORE4_TWO(gaitsOut, agent * GAIT_STRIDE, vec4(phase, float(lift), float(reaim), stride.ticks),
             vec4(stride.halfStride, stride.cycle, float(air), idle));

  // Few legs begin a step in a tick: they are listed, and foothold runs over the list alone.
  uint begin = lift | reaim;
  if (begin != 0u) {
    uint next = atomicAdd(counters[COUNTER_LISTED], bitCount(begin));
    atomicMax(counters[COUNTER_DISPATCH_X], (next + bitCount(begin) + WORK_GROUP - 1u) / WORK_GROUP);
    for (; begin != 0u; begin &= begin - 1u) {
      int leg = findLSB(begin);
      uint entry = uint(legRecord(agent, leg, LEGS)) * 2u + ((reaim >> leg) & 1u);
      list[next] = LEVELS ? entry + uint(LIST_LEVEL) * uint(findMSB(uint(tickSpan))) : entry;
      ++next;
    }
  }
}

#endif
