#pragma once

#include "bench/cpu_crowd/leg_solver.h"
#include "bench/cpu_crowd/play.h"
#include "skitter/crowd.h"
#include "skitter/records.h"

// One agent's records in the device's layout (engine/include/skitter/records.h), to and from the herd's own.
namespace skitter::cpu_crowd {

inline float* recordAt(std::vector<float>& buffer, size_t index, int stride) {
  return buffer.data() + 4 * index * size_t(stride);
}
inline const float* recordAt(const std::vector<float>& buffer, size_t index, int stride) {
  return buffer.data() + 4 * index * size_t(stride);
}

inline Agent<float> readAgent(const HerdState& state, size_t agent) {
  const float* goal = recordAt(state.goal, agent, shared::GOAL_STRIDE);
  const float* steer = recordAt(state.steer, agent, shared::STEER_STRIDE);
  const float* b = recordAt(state.body, agent, shared::BODY_STRIDE);
  const float* gait = recordAt(state.gait, agent, shared::GAIT_STRIDE);
  Agent<float> a;
  a.targetX = goal[0], a.targetZ = goal[1], a.otherX = goal[2], a.otherZ = goal[3];
  a.wantedSpeed = goal[4], a.arrival = goal[5], a.kind = goal[6];
  a.velocityX = steer[0], a.velocityZ = steer[1];
  a.local = {b[0], b[1], b[2]};
  a.tileX = shared::tileX(b[3]), a.tileZ = shared::tileZ(b[3]);
  a.headingX = b[4], a.headingZ = b[5], a.speed = b[6];
  a.orientation = {b[8], b[9], b[10], b[11]};
  a.turnRate = b[12], a.still = b[13], a.follow = b[14], a.surfaceSpeed = b[15];
  a.phase = gait[0], a.lift = gait[1], a.reaim = gait[2], a.stepTicks = gait[3];
  a.halfStride = gait[4], a.cycle = gait[5], a.air = gait[6];
  return a;
}

inline void writeAgent(const Agent<float>& a, size_t agent, HerdState& state) {
  const auto put = [&](std::vector<float>& buffer, int stride, std::initializer_list<float> values) {
    std::copy(values.begin(), values.end(), recordAt(buffer, agent, stride));
  };
  put(state.goal, shared::GOAL_STRIDE,
      {a.targetX, a.targetZ, a.otherX, a.otherZ, a.wantedSpeed, a.arrival, a.kind, 0});
  put(state.steer, shared::STEER_STRIDE, {a.velocityX, a.velocityZ, 0, 0});
  put(state.body, shared::BODY_STRIDE,
      {a.local.x, a.local.y, a.local.z, shared::packedTile(a.tileX, a.tileZ), a.headingX, a.headingZ, a.speed,
       0, a.orientation.x, a.orientation.y, a.orientation.z, a.orientation.w, a.turnRate, a.still, a.follow,
       a.surfaceSpeed});
  put(state.gait, shared::GAIT_STRIDE,
      {a.phase, a.lift, a.reaim, a.stepTicks, a.halfStride, a.cycle, a.air, 0});
}

// Where a tip is in the device's records: relative to the agent, world axes.
inline Vec3<float> tipInWorld(const LegModel& leg, const Quaternion<float>& orientation,
                              const Vec3<float>& tip) {
  return matrixOf(orientation) * (leg.root + tip * leg.reach);
}

template <int N>
Leg<float, N> readLeg(const HerdState& state, size_t agent, size_t l, size_t legs, int bones) {
  const size_t leg = agent * legs + l;
  const float* s = recordAt(state.step, leg, shared::STEP_STRIDE);
  const float* arc = recordAt(state.arc, leg, shared::ARC_STRIDE);
  const float tile = recordAt(state.body, agent, shared::BODY_STRIDE)[3];
  const float x = shared::tileX(tile), z = shared::tileZ(tile);
  const float apart = shared::tilesApart(shared::tileOfTicks(s[7]), shared::stepTile(x, z));
  const float* directions = recordAt(state.chain, leg, shared::chainStride(bones));
  Leg<float, N> to{};
  to.step = {{s[0], s[1], s[2]},       x + shared::apartX(apart),
             {s[4], s[5], s[6]},       z + shared::apartZ(apart),
             {arc[0], arc[1], arc[2]}, s[3],
             {arc[4], arc[5], arc[6]}, std::copysign(shared::ticksOf(s[7]), s[7])};
  for (int b = 0; b < bones; ++b) {
    to.chain.x[b] = directions[2 * b];
    to.chain.y[b] = directions[2 * b + 1];
  }
  to.foot.progress =
      std::clamp((float(state.tick) - to.step.firstTick) / std::abs(to.step.ticks), 0.0f, 1.0f);
  const float* told = state.miss.data() + 2 * shared::missPair(int(agent), int(l), int(legs));
  to.chain.error = told[1] == float(state.tick) ? told[0] : 0;
  return to;
}

template <int N>
void writeLeg(const Leg<float, N>& from, const LegModel& model, float missLeast, size_t agent, size_t l,
              size_t legs, int bones, HerdState& state) {
  const size_t leg = agent * legs + l;
  const Step<float>& s = from.step;
  const float step[] = {s.landing.x, s.landing.y,
                        s.landing.z, s.firstTick,
                        s.liftOff.x, s.liftOff.y,
                        s.liftOff.z, shared::packedTicks(s.ticks, shared::stepTile(s.tileX, s.tileZ))};
  std::copy(std::begin(step), std::end(step), recordAt(state.step, leg, shared::STEP_STRIDE));
  const float arc[] = {s.lift.x,         s.lift.y,         s.lift.z,         0,
                       s.startTangent.x, s.startTangent.y, s.startTangent.z, 0};
  std::copy(std::begin(arc), std::end(arc), recordAt(state.arc, leg, shared::ARC_STRIDE));
  const Foot<float>& f = from.foot;
  const float foot[] = {f.target.x, f.target.y, f.target.z, f.progress};
  std::copy(std::begin(foot), std::end(foot), recordAt(state.foot, leg, shared::FOOT_STRIDE));
  float* directions = recordAt(state.chain, leg, shared::chainStride(bones));
  for (int b = 0; b < bones; ++b) {
    directions[2 * b] = from.chain.x[b];
    directions[2 * b + 1] = from.chain.y[b];
  }
  const float tip[] = {from.chain.tip.x, from.chain.tip.y, from.chain.tip.z, from.chain.error * model.reach};
  std::copy(std::begin(tip), std::end(tip), recordAt(state.tip, leg, shared::TIP_STRIDE));
  float* told = state.miss.data() + 2 * shared::missPair(int(agent), int(l), int(legs));
  told[0] = f.progress >= 1 && from.chain.error > missLeast ? from.chain.error : 0;
  told[1] = float(state.tick);
}

inline void writePose(const BonePose<float>& pose, size_t entry, HerdState& state) {
  const float record[] = {pose.rotation.x, pose.rotation.y, pose.rotation.z, pose.rotation.w,
                          pose.position.x, pose.position.y, pose.position.z, 0};
  std::copy(std::begin(record), std::end(record), recordAt(state.pose, entry, shared::POSE_STRIDE));
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
