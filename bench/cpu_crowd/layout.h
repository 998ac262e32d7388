#pragma once

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include "bench/cpu_crowd/rotation.h"
#include "cpu_reference/fields.h"
#include "skitter/records.h"

namespace skitter::cpu_crowd {

// The herd's state in rows of F, a row a number: with Lanes a block is as many agents as a register holds
// floats, with float it is one. Rows have the meaning and the units of include/skitter/records.h. They
// are floats throughout, so that an agent can be taken out of its block and put back.

template <class F>
struct Pair {
  F x, z;
};

// The rows of a field of a record, by its type in the table of fields (cpu_reference/fields.h).
template <class F, class Type>
struct RowsOf {
  using Rows = F;
};
template <class F>
struct RowsOf<F, glm::dvec2> {
  using Rows = Pair<F>;
};
template <class F>
struct RowsOf<F, glm::dvec3> {
  using Rows = Vec3<F>;
};
template <class F>
struct RowsOf<F, glm::dquat> {
  using Rows = Quaternion<F>;
};
#define SKITTER_ROWS(type, name, initial, place, roundings) typename RowsOf<F, type>::Rows name;

template <class F>
struct Agent {
  // goal
  F targetX, targetZ, otherX, otherZ, wantedSpeed, arrival, kind;
  // steer
  F velocityX, velocityZ;
  SKITTER_BODY_FIELDS(SKITTER_ROWS)
  F tileX, tileZ;
  SKITTER_GAIT_FIELDS(SKITTER_ROWS)

  Vec3<F> local() const { return {localX, y, localZ}; }
};

// positions tile-local in x and z
template <class F>
struct Step {
  SKITTER_STEP_FIELDS(SKITTER_ROWS)
  SKITTER_ARC_FIELDS(SKITTER_ROWS)
  F tileX, tileZ;
  F ticks;  // negative: the landing is a last resort
};

template <class F>
struct Foot {
  SKITTER_FOOT_FIELDS(SKITTER_ROWS)
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
  SKITTER_POSE_FIELDS(SKITTER_ROWS)
};

// A point of a step relative to the agent's position, along world axes.
template <class F>
Vec3<F> relative(const Vec3<F>& point, const Step<F>& step, const Agent<F>& agent) {
  return {point.x + (step.tileX - agent.tileX) * shared::TILE_SIZE - agent.localX, point.y - agent.y,
          point.z + (step.tileZ - agent.tileZ) * shared::TILE_SIZE - agent.localZ};
}

}  // namespace skitter::cpu_crowd
