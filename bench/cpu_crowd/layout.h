#pragma once

#include "bench/cpu_crowd/rotation.h"
#include "skitter/records.h"

namespace skitter::cpu_crowd {

// The herd's state in rows of F, a row a number: with Lanes a block is as many agents as a register holds
// floats, with float it is one. Rows have the meaning and the units of engine/include/skitter/records.h. They
// are floats throughout, so that an agent can be taken out of its block and put back.

template <class F>
struct Agent {
  // goal
  F targetX, targetZ, otherX, otherZ, wantedSpeed, arrival, kind;
  // steer
  F velocityX, velocityZ;
  // body
  Vec3<F> local;
  F headingX, tileX, tileZ, headingZ, speed;
  Quaternion<F> orientation;
  F turnRate, still, follow, surfaceSpeed;
  // gait; masks of legs
  F phase, lift, reaim, stepTicks, halfStride, cycle, air;
};

// positions tile-local in x and z
template <class F>
struct Step {
  Vec3<F> landing;
  F tileX;
  Vec3<F> liftOff;
  F tileZ;
  Vec3<F> lift;
  F firstTick;
  Vec3<F> startTangent;
  F ticks;  // negative: the landing is a last resort
};

template <class F>
struct Foot {
  Vec3<F> target;
  F progress;
};

template <class F, int N>
struct Chain {
  F x[N], y[N];  // directions
  Vec3<F> tip;   // from the root, in model space, a share of the reach
  F error;       // of the tip to its target, likewise
};

// The same leg of all agents of a block.
template <class F, int N>
struct Leg {
  Step<F> step;
  Foot<F> foot;
  Chain<F, N> chain;
};

template <class F>
struct BonePose {
  Quaternion<F> rotation;
  Vec3<F> position;
};

// A point of a step relative to the agent's position, along world axes.
template <class F>
Vec3<F> relative(const Vec3<F>& point, const Step<F>& step, const Agent<F>& agent) {
  return {point.x + (step.tileX - agent.tileX) * shared::TILE_SIZE - agent.local.x, point.y - agent.local.y,
          point.z + (step.tileZ - agent.tileZ) * shared::TILE_SIZE - agent.local.z};
}

}  // namespace skitter::cpu_crowd
