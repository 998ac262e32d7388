#pragma once

#include <algorithm>
#include <bit>

#include "bench/cpu_crowd/body.h"
#include "bench/cpu_crowd/clip_herd.h"
#include "bench/cpu_crowd/foothold.h"
#include "bench/cpu_crowd/kernel.h"
#include "bench/cpu_crowd/laps.h"
#include "bench/cpu_crowd/leg_solver.h"
#include "bench/cpu_crowd/navigate.h"
#include "bench/cpu_crowd/parts.h"
#include "bench/cpu_crowd/pose.h"
#include "bench/cpu_crowd/records.h"

namespace skitter::cpu_crowd {

// An adaptive herd. Its stages follow each other group by group; only foothold waits for the rest of its
// part.
template <class F, int N>
class HerdKernel final : public Kernel {
 public:
  HerdKernel(const World& world, const HerdState& start, const Options& options)
      : world_(world),
        agents_(start.agents),
        legs_(world.legs.size()),
        blocks_(Parts<F>::blocks(agents_)),
        agentBlocks_(blocks_),
        legBlocks_(blocks_ * legs_),
        poses_(options.poses ? blocks_ * poseCount() : 0),
        scratch_(size_t(options.threads)) {
    for (Scratch& scratch : scratch_) {
      scratch.begins.resize(Parts<F>::kPart * kAgents * legs_);
      scratch.rare.resize(kAgents * legs_);
    }
    // Idle lanes of the last block repeat its last agent.
    for (size_t i = 0; i < blocks_ * kAgents; ++i) {
      const size_t agent = std::min(i, agents_ - 1), block = i / kAgents;
      const int at = int(i % kAgents);
      copyLane<float, F>(readAgent(start, agent), 0, agentBlocks_[block], at);
      for (size_t l = 0; l < legs_; ++l) {
        Leg<float, kBones<N>> leg = readLeg<kBones<N>>(start, agent, l, legs_, world_.bones);
        leg.chain.tip = tipOf(world_.legs[l], directionsOf<float, N>(world_.legs[l], leg.chain));
        copyLane<float, F>(leg, 0, legsOf(block)[l], at);
      }
    }
  }

  size_t parts() const override { return Parts<F>::count(blocks_); }

  void tick(uint64_t n, size_t part, int thread, bool timed) override {
    Scratch& scratch = scratch_[size_t(thread)];
    const float tick = float(n);
    Laps laps(timed ? &scratch.seconds : nullptr);
    scratch.begun = 0;
    Parts<F>::eachGroup(part, blocks_, [&](size_t first, size_t last) {
      laps.stage(kNavigate, first, last, [&](size_t b) { navigate(world_, agentBlocks_[b]); });
      laps.stage(kBody, first, last, [&](size_t b) { body(world_, tick, agentBlocks_[b], legsOf(b)); });
      laps.stage(kGait, first, last, [&](size_t b) { gaitBlock(tick, b, scratch); });
    });
    beginSteps(tick, scratch);
    laps.end(kFoothold);
    Parts<F>::eachGroup(part, blocks_, [&](size_t first, size_t last) {
      laps.stage(kSwing, first, last, [&](size_t b) { swingBlock(tick, b); });
      laps.stage(kIk, first, last, [&](size_t b) { ikBlock(b, scratch); });
      if (poses_.empty()) return;
      laps.stage(kPose, first, last, [&](size_t b) { poseBlock(b); });
    });
    settleStreams();
  }

  void beginSteps(uint64_t n, size_t legs) override {
    Scratch& scratch = scratch_[0];
    for (size_t next = 0; next < legs;) {
      for (scratch.begun = 0; next < legs && scratch.begun < scratch.begins.size(); ++next) {
        const size_t agent = next / legs_;
        scratch.begins[scratch.begun++] = {agent / kAgents, uint16_t(next % legs_), uint16_t(agent % kAgents),
                                           false};
      }
      beginSteps(float(n), scratch);
    }
  }

  void read(HerdState& state) const override {
    for (size_t agent = 0; agent < agents_; ++agent) {
      const size_t block = agent / kAgents;
      const int at = int(agent % kAgents);
      Agent<float> a;
      copyLane<F, float>(agentBlocks_[block], at, a, 0);
      writeAgent(a, agent, state);
      for (size_t l = 0; l < legs_; ++l) {
        Leg<float, kBones<N>> leg;
        copyLane<F, float>(legBlocks_[block * legs_ + l], at, leg, 0);
        leg.chain.tip = tipInWorld(world_.legs[l], a.orientation, leg.chain.tip);
        writeLeg(leg, world_.legs[l], world_.q.missLeast, agent, l, legs_, world_.bones, state);
      }
      if (poses_.empty()) continue;
      for (size_t i = 0; i < poseCount(); ++i) {
        BonePose<float> pose;
        copyLane<F, float>(poses_[block * poseCount() + i], at, pose, 0);
        writePose(pose, agent * poseCount() + i, state);
      }
    }
  }

  size_t bytes() const override {
    return (agentBlocks_.size() * sizeof(agentBlocks_[0]) + legBlocks_.size() * sizeof(legBlocks_[0]) +
            poses_.size() * sizeof(BonePose<F>)) /
           (blocks_ * kAgents);
  }

  std::vector<StageSeconds> stageSeconds() const override {
    return sumOf(scratch_, {"navigate", "body", "gait", "foothold", "swing", "ik", "pose"});
  }

 private:
  enum { kNavigate, kBody, kGait, kFoothold, kSwing, kIk, kPose };
  static constexpr size_t kAgents = Parts<F>::kAgents;

  // A leg that begins a step, or is aimed anew.
  struct Place {
    size_t block;
    uint16_t leg, lane;
    bool reaim;
  };
  // A leg, of one block, that needs more than ik's usual step.
  struct Rare {
    size_t leg;
    int lane;
    Chain<float, kBones<N>> chain;  // as it was
  };
  struct alignas(64) Scratch {
    std::vector<Place> begins;
    std::vector<Rare> rare;
    size_t begun = 0, listed = 0;
    Seconds seconds{};
  };

  Leg<F, kBones<N>>* legsOf(size_t block) { return &legBlocks_[block * legs_]; }
  size_t poseCount() const { return 1 + legs_ * size_t(world_.bones); }

  void gaitBlock(float tick, size_t block, Scratch& scratch) {
    Begun begun;
    gait(world_, tick, agentBlocks_[block], legsOf(block), begun);
    for (size_t l = 0; l < legs_; ++l) {
      for (uint64_t all = begun.lift[l] | begun.reaim[l]; all != 0; all &= all - 1) {
        const int at = std::countr_zero(all);
        scratch.begins[scratch.begun++] = {block, uint16_t(l), uint16_t(at), (begun.reaim[l] >> at & 1) != 0};
      }
    }
  }

  void beginSteps(float tick, Scratch& scratch) {
    Beginning<F> b;
    for (size_t i = 0; i < scratch.begun; i += kAgents) {
      const size_t count = std::min(kAgents, scratch.begun - i);
      for (size_t k = 0; k < kAgents; ++k) {
        const Place& place = scratch.begins[i + std::min(k, count - 1)];
        const LegModel& leg = world_.legs[place.leg];
        copyLane<F, F>(agentBlocks_[place.block], place.lane, b.agent, int(k));
        copyLane<F, F>(legsOf(place.block)[place.leg].step, place.lane, b.step, int(k));
        copyLane<float, F>(leg.root, 0, b.root, int(k));
        copyLane<float, F>(leg.home, 0, b.home, int(k));
        lane(b.reach, int(k)) = leg.reach;
        lane(b.reaim, int(k)) = place.reaim ? 1 : 0;
      }
      foothold(world_, tick, b);
      for (size_t k = 0; k < count; ++k) {
        const Place& place = scratch.begins[i + k];
        copyLane<F, F>(b.step, int(k), legsOf(place.block)[place.leg].step, place.lane);
      }
    }
  }

  void swingBlock(float tick, size_t block) {
    Leg<F, kBones<N>>* legs = legsOf(block);
    for (size_t l = 0; l < legs_; ++l) swing(tick, agentBlocks_[block], legs[l].step, legs[l].foot);
  }

  void ikBlock(size_t block, Scratch& scratch) {
    Leg<F, kBones<N>>* legs = legsOf(block);
    const Mat3<F> r = matrixOf(agentBlocks_[block].orientation);
    scratch.listed = 0;
    for (size_t l = 0; l < legs_; ++l) {
      const auto list = [&](uint64_t lanes) {
        for (; lanes != 0; lanes &= lanes - 1) {
          Rare& rare = scratch.rare[scratch.listed++];
          rare.leg = l;
          rare.lane = std::countr_zero(lanes);
          copyLane<F, float>(legs[l].chain, rare.lane, rare.chain, 0);
        }
      };
      ikQuick<F, N>(world_, world_.legs[l], r, legs[l].foot, legs[l].chain, list);
    }
    for (size_t i = 0; i < scratch.listed; ++i) {
      Rare& rare = scratch.rare[i];
      Leg<F, kBones<N>>& leg = legs[rare.leg];
      Mat3<float> turn;
      Foot<float> foot;
      copyLane<F, float>(r, rare.lane, turn, 0);
      copyLane<F, float>(leg.foot, rare.lane, foot, 0);
      ikWhole<N>(world_, world_.legs[rare.leg], turn, foot, rare.chain);
      copyLane<float, F>(rare.chain, 0, leg.chain, rare.lane);
    }
  }

  void poseBlock(size_t block) {
    const Agent<F>& a = agentBlocks_[block];
    const Mat3<F> r = matrixOf(a.orientation);
    BonePose<F>* poses = &poses_[block * poseCount()];
    stream(poses++, a.orientation, Vec3<F>{F(0), F(0), F(0)});
    for (size_t l = 0; l < legs_; ++l, poses += world_.bones)
      pose<F, N>(world_.legs[l], world_.bones, a, r, legsOf(block)[l].chain, poses);
  }

  const World& world_;
  size_t agents_, legs_, blocks_;
  std::vector<Agent<F>> agentBlocks_;
  std::vector<Leg<F, kBones<N>>> legBlocks_;
  std::vector<BonePose<F>> poses_;
  std::vector<Scratch> scratch_;
};

// With the number of bones compiled in where all legs have it and rigs are made so, else 0.
template <class F>
std::unique_ptr<Kernel> kernelOf(const World& world, const HerdState& start, const Options& options) {
  if (!world.clips.clips.empty()) return std::make_unique<ClipKernel<F>>(world, start, options);
  const auto all = [&](int n) {
    return std::all_of(world.legs.begin(), world.legs.end(),
                       [n](const LegModel& leg) { return int(leg.bones.size()) == n; });
  };
  if (all(3)) return std::make_unique<HerdKernel<F, 3>>(world, start, options);
  if (all(4)) return std::make_unique<HerdKernel<F, 4>>(world, start, options);
  return std::make_unique<HerdKernel<F, 0>>(world, start, options);
}

}  // namespace skitter::cpu_crowd
