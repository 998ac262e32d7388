#pragma once

#include <algorithm>

#include "bench/cpu_crowd/body.h"
#include "bench/cpu_crowd/kernel.h"
#include "bench/cpu_crowd/laps.h"
#include "bench/cpu_crowd/navigate.h"
#include "bench/cpu_crowd/parts.h"
#include "bench/cpu_crowd/pose_clip.h"
#include "bench/cpu_crowd/records.h"

namespace skitter::cpu_crowd {

// A herd that plays clips. Its feet are what measure would look at, and are left out with it, as on a device.
template <class F>
class ClipKernel final : public Kernel {
 public:
  ClipKernel(const World& world, const HerdState& start, const Options& options)
      : world_(world),
        agents_(start.agents),
        blocks_(Parts<F>::blocks(agents_)),
        agentBlocks_(blocks_),
        plays_(blocks_),
        poses_(options.poses ? agents_ * poseLines() : 0),
        scratch_(size_t(options.threads)) {
    // Idle lanes of the last block repeat its last agent.
    for (size_t i = 0; i < blocks_ * kAgents; ++i) {
      const size_t agent = std::min(i, agents_ - 1);
      copyLane<float, F>(readAgent(start, agent), 0, agentBlocks_[i / kAgents], int(i % kAgents));
      copyLane<float, F>(readPlay(start, agent), 0, plays_[i / kAgents], int(i % kAgents));
    }
  }

  size_t parts() const override { return Parts<F>::count(blocks_); }

  void tick(uint64_t, size_t part, int thread, bool timed) override {
    Laps laps(timed ? &scratch_[size_t(thread)].seconds : nullptr);
    Parts<F>::eachGroup(part, blocks_, [&](size_t first, size_t last) {
      laps.stage(kNavigate, first, last, [&](size_t b) { navigate(world_, agentBlocks_[b]); });
      laps.stage(kBody, first, last, [&](size_t b) { blindBody(world_, agentBlocks_[b]); });
      laps.stage(kClip, first, last, [&](size_t b) { clip(world_, agentBlocks_[b], plays_[b]); });
      if (poses_.empty()) return;
      laps.stage(kPose, first, last, [&](size_t b) { poseBlock(b); });
    });
    settleStreams();
  }

  void beginSteps(uint64_t, size_t) override {}  // no leg of a clip steps

  void read(HerdState& state) const override {
    for (size_t agent = 0; agent < agents_; ++agent) {
      const size_t block = agent / kAgents;
      Agent<float> a;
      Play<float> play;
      copyLane<F, float>(agentBlocks_[block], int(agent % kAgents), a, 0);
      copyLane<F, float>(plays_[block], int(agent % kAgents), play, 0);
      writeAgent(a, agent, state);
      writePlay(play, agent, state);
      if (!poses_.empty()) writeMatrices(world_.clips, &poses_[agent * poseLines()], agent, state);
    }
  }

  size_t bytes() const override {
    return (agentBlocks_.size() * (sizeof(Agent<F>) + sizeof(Play<F>)) + poses_.size() * sizeof(Line)) /
           (blocks_ * kAgents);
  }

  std::vector<StageSeconds> stageSeconds() const override {
    return sumOf(scratch_, {"navigate", "body", "clip", "pose"});
  }

 private:
  enum { kNavigate, kBody, kClip, kPose };
  static constexpr size_t kAgents = Parts<F>::kAgents;

  struct alignas(64) Scratch {
    Seconds seconds{};
  };

  size_t poseLines() const { return 3 * world_.clips.lines; }

  void poseBlock(size_t block) {
    const Mat3<F> turns = matrixOf(agentBlocks_[block].orientation);
    const size_t first = block * kAgents, count = std::min(kAgents, agents_ - first);
    for (size_t i = 0; i < count; ++i) {
      Mat3<float> r;
      Play<float> play;
      copyLane<F, float>(turns, int(i), r, 0);
      copyLane<F, float>(plays_[block], int(i), play, 0);
      poseClip<F>(world_.clips, play, r, &poses_[(first + i) * poseLines()]);
    }
  }

  const World& world_;
  size_t agents_, blocks_;
  std::vector<Agent<F>> agentBlocks_;
  std::vector<Play<F>> plays_;
  std::vector<Line> poses_;
  std::vector<Scratch> scratch_;
};

}  // namespace skitter::cpu_crowd
