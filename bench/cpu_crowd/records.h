#pragma once

#include "bench/cpu_crowd/leg_solver.h"
#include "bench/cpu_crowd/play.h"
#include "skitter/crowd.h"
#include "skitter/records.h"

// One agent's records in the device's layout (include/skitter/records.h), to and from the herd's own.
namespace skitter::cpu_crowd {

inline float* recordAt(std::vector<float>& buffer, size_t index, int stride) {
  return buffer.data() + 4 * index * size_t(stride);
}
inline const float* recordAt(const std::vector<float>& buffer, size_t index, int stride) {
  return buffer.data() + 4 * index * size_t(stride);
}

inline void take(const float* from, float& to) { to = from[0]; }
inline void take(const float* from, Pair<float>& to) { to = {from[0], from[1]}; }
inline void take(const float* from, Vec3<float>& to) { to = {from[0], from[1], from[2]}; }
inline void take(const float* from, Quaternion<float>& to) { to = {from[0], from[1], from[2], from[3]}; }
inline void put(float from, float* to) { to[0] = from; }
inline void put(const Pair<float>& from, float* to) { to[0] = from.x, to[1] = from.z; }
inline void put(const Vec3<float>& from, float* to) { to[0] = from.x, to[1] = from.y, to[2] = from.z; }
inline void put(const Quaternion<float>& from, float* to) {
  to[0] = from.x, to[1] = from.y, to[2] = from.z, to[3] = from.w;
}
#define SKITTER_TAKE(type, name, initial, place, roundings) take(record + (place), to.name);
#define SKITTER_PUT(type, name, initial, place, roundings) put(from.name, record + (place));

inline Agent<float> readAgent(const HerdState& state, size_t agent) {
  const float* goal = recordAt(state.goal, agent, shared::GOAL_STRIDE);
  const float* steer = recordAt(state.steer, agent, shared::STEER_STRIDE);
  Agent<float> to;
  to.targetX = goal[0], to.targetZ = goal[1], to.otherX = goal[2], to.otherZ = goal[3];
  to.wantedSpeed = goal[4], to.arrival = goal[5], to.kind = goal[6];
  to.velocityX = steer[0], to.velocityZ = steer[1];
  const float* record = recordAt(state.body, agent, shared::BODY_STRIDE);
  SKITTER_BODY_FIELDS(SKITTER_TAKE)
  to.tileX = shared::tileX(record[3]), to.tileZ = shared::tileZ(record[3]);
  record = recordAt(state.gait, agent, shared::GAIT_STRIDE);
  SKITTER_GAIT_FIELDS(SKITTER_TAKE)
  return to;
}

// Numbers of a record that no field has are zero already.
inline void writeAgent(const Agent<float>& from, size_t agent, HerdState& state) {
  const float goal[] = {from.targetX,     from.targetZ, from.otherX, from.otherZ,
                        from.wantedSpeed, from.arrival, from.kind};
  std::copy(std::begin(goal), std::end(goal), recordAt(state.goal, agent, shared::GOAL_STRIDE));
  float* record = recordAt(state.steer, agent, shared::STEER_STRIDE);
  record[0] = from.velocityX, record[1] = from.velocityZ;
  record = recordAt(state.body, agent, shared::BODY_STRIDE);
  SKITTER_BODY_FIELDS(SKITTER_PUT)
  record[3] = shared::packedTile(from.tileX, from.tileZ);
  record = recordAt(state.gait, agent, shared::GAIT_STRIDE);
  SKITTER_GAIT_FIELDS(SKITTER_PUT)
}

// Where a tip is in the device's records: relative to the agent, world axes.
inline Vec3<float> tipInWorld(const LegModel& leg, const Quaternion<float>& orientation,
                              const Vec3<float>& tip) {
  return matrixOf(orientation) * (leg.root + tip * leg.reach);
}

template <int N>
Leg<float, N> readLeg(const HerdState& state, size_t agent, size_t l, size_t legs, int bones) {
  const size_t leg = agent * legs + l;
  Leg<float, N> read{};
  Step<float>& to = read.step;
  const float* record = recordAt(state.arc, leg, shared::ARC_STRIDE);
  SKITTER_ARC_FIELDS(SKITTER_TAKE)
  record = recordAt(state.step, leg, shared::STEP_STRIDE);
  SKITTER_STEP_FIELDS(SKITTER_TAKE)
  const float tile = recordAt(state.body, agent, shared::BODY_STRIDE)[3];
  const float x = shared::tileX(tile), z = shared::tileZ(tile);
  const float apart = shared::tilesApart(shared::tileOfTicks(record[7]), shared::stepTile(x, z));
  to.tileX = x + shared::apartX(apart), to.tileZ = z + shared::apartZ(apart);
  to.ticks = std::copysign(shared::ticksOf(record[7]), record[7]);
  const float* directions = recordAt(state.chain, leg, shared::chainStride(bones));
  for (int b = 0; b < bones; ++b) {
    read.chain.x[b] = directions[2 * b];
    read.chain.y[b] = directions[2 * b + 1];
  }
  read.foot.progress = std::clamp((float(state.tick) - to.firstTick) / std::abs(to.ticks), 0.0f, 1.0f);
  const float* told = state.miss.data() + 2 * shared::missPair(int(agent), int(l), int(legs));
  read.chain.error = told[1] == float(state.tick) ? told[0] : 0;
  return read;
}

template <int N>
void writeLeg(const Leg<float, N>& leg, const LegModel& model, float missLeast, size_t agent, size_t l,
              size_t legs, int bones, HerdState& state) {
  const size_t index = agent * legs + l;
  const auto writeStep = [&](const Step<float>& from) {
    float* record = recordAt(state.step, index, shared::STEP_STRIDE);
    SKITTER_STEP_FIELDS(SKITTER_PUT)
    record[7] = shared::packedTicks(from.ticks, shared::stepTile(from.tileX, from.tileZ));
    record = recordAt(state.arc, index, shared::ARC_STRIDE);
    SKITTER_ARC_FIELDS(SKITTER_PUT)
  };
  const auto writeFoot = [&](const Foot<float>& from) {
    float* record = recordAt(state.foot, index, shared::FOOT_STRIDE);
    SKITTER_FOOT_FIELDS(SKITTER_PUT)
  };
  writeStep(leg.step);
  writeFoot(leg.foot);
  const Chain<float, N>& chain = leg.chain;
  float* directions = recordAt(state.chain, index, shared::chainStride(bones));
  for (int b = 0; b < bones; ++b) {
    directions[2 * b] = chain.x[b];
    directions[2 * b + 1] = chain.y[b];
  }
  const float tip[] = {chain.tip.x, chain.tip.y, chain.tip.z, chain.error * model.reach};
  std::copy(std::begin(tip), std::end(tip), recordAt(state.tip, index, shared::TIP_STRIDE));
  float* told = state.miss.data() + 2 * shared::missPair(int(agent), int(l), int(legs));
  told[0] = leg.foot.progress >= 1 && chain.error > missLeast ? chain.error : 0;
  told[1] = float(state.tick);
}

inline void writePose(const BonePose<float>& from, size_t entry, HerdState& state) {
  float* record = recordAt(state.pose, entry, shared::POSE_STRIDE);
  SKITTER_POSE_FIELDS(SKITTER_PUT)
}

inline Play<float> readPlay(const HerdState& state, size_t agent) {
  const float* p = recordAt(state.play, agent, shared::PLAY_STRIDE);
  return {{p[0], p[1], p[5], p[8], p[9]}, {p[2], p[3], p[6], p[10], p[11]}, p[4]};
}

inline void writePlay(const Play<float>& play, size_t agent, HerdState& state) {
  const auto &to = play.to, &from = play.from;
  const float record[] = {to.clip,   to.time, from.clip, from.time,   play.weight, to.rate,
                          from.rate, 0,       to.frame,  to.fraction, from.frame,  from.fraction};
  std::copy(std::begin(record), std::end(record), recordAt(state.play, agent, shared::PLAY_STRIDE));
}

inline void writeMatrices(const ClipTable& table, const Line* planes, size_t agent, HerdState& state) {
  const size_t joints = size_t(table.joints);
  for (size_t j = 0; j < joints; ++j) {
    float* record = recordAt(state.pose, agent * joints + j, shared::MATRIX_STRIDE);
    for (size_t row = 0; row < 3; ++row)
      std::copy_n(planes[row * table.lines].at + 4 * j, 4, record + 4 * row);
  }
}

}  // namespace skitter::cpu_crowd
