#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "crowd/regait.h"
#include "gpu/buffer.h"
#include "gpu/kernel.h"
#include "shared/adapt.h"
#include "skitter/crowd.h"
#include "skitter/evolve.h"

namespace skitter::evolve {

// What a trial counted (docs/evolve.md). Lengths are metres.
struct TrialFigures {
  double samples = 0, distance = 0, cycles = 0, unstable = 0;
  double slip = 0, error = 0, least = 0;
  std::vector<float> shares = {};  // of the samples in which each leg stood
};

// What a creature in a trial is.
struct TrialTask {
  uint32_t idle = 0;
  crowd::Regait gait;
};

// A herd on flat ground that tries one gait per agent, again and again.
class Trials {
 public:
  static constexpr double settleSeconds = double{shared::ADAPT_SETTLE_SECONDS};
  static constexpr double wantedSeconds = double{shared::ADAPT_COUNTED_SECONDS};
  static constexpr uint32_t ticksOfSample = 2;
  static constexpr double safeMargin = double{shared::ADAPT_SAFE_MARGIN};  // leg lengths

  Trials(Device& device, const Rig& rig, uint32_t agents, float dt, const TrialShader& shader = {});

  // Each task from where everybody begins, at most `agents` of them. Waits for the device.
  std::vector<TrialFigures> run(std::span<const TrialTask> tasks);

  // As run(), piece by piece, for a reference to follow: what was sampled last is in records().
  void begin(std::span<const TrialTask> tasks);
  void tick();
  void sample();
  // Of each agent, shared::trialStride(legs) vec4.
  std::vector<float> records() const;

  Crowd& crowd() { return crowd_; }
  uint32_t settleTicks() const { return settleTicks_; }
  uint32_t samples() const { return samples_; }
  double seconds() const;         // of a trial
  double countedSeconds() const;  // of these

 private:
  // Where a record's bytes lie that agents begin with.
  struct Beginning {
    const gpu::Buffer* to;
    gpu::Buffer from;
  };
  struct Page {
    std::vector<Beginning> beginnings;
    gpu::HostBuffer hurts, read;
    gpu::Buffer trial;
    gpu::Bindings bindings;
    uint32_t agents = 0;
  };

  void standAtTheOrigin();
  void makePages(const TrialShader& shader);
  void write(std::span<const TrialTask> tasks);
  void recordBeginning(vk::CommandBuffer cmd) const;
  void recordSample(vk::CommandBuffer cmd, bool begins) const;
  void recordReading(vk::CommandBuffer cmd) const;
  std::vector<float> readBack() const;

  const gpu::Context* context_;
  float dt_;
  uint32_t settleTicks_, samples_;
  bool begins_ = true;  // the next sample counts nothing
  Crowd crowd_;
  gpu::Kernel kernel_;
  std::vector<Page> pages_;
};

// A share from 0 to 1. `legs` of the rig carry, `seconds` were counted, of which creatures wanted to go at
// `wanted` leg lengths per second.
double fitnessOf(const TrialFigures& figures, double legLength, size_t legs, double seconds, double wanted);

// A scene of one herd that can be hurt, and that goes along +z at `speed` leg lengths per second, on flat
// ground of `side` leg lengths.
Scene walkOf(const Rig& rig, uint32_t agents, double speed);
Heightfield flatGround(const Rig& rig, double side);
// Without its skin and its table.
Rig bareRig(const Rig& rig);

}  // namespace skitter::evolve
