#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "crowd/clip_records.h"
#include "crowd/edit.h"
#include "crowd/key_poses.h"
#include "crowd/stage.h"
#include "crowd/tuning.h"
#include "gpu/buffer.h"
#include "gpu/image.h"
#include "gpu/kernel.h"
#include "gpu/timer.h"
#include "shared/bindings.h"
#include "shared/parameters.h"
#include "skitter/crowd.h"
#include "skitter/records.h"

// What a crowd is made of on the device; the stages and the renderer read it.
namespace skitter::crowd {

// A run of a kind's agents whose records fit the device's bindings.
struct Page : ForRecords<gpu::Buffer> {
  uint32_t firstAgent = 0;
  uint32_t agents = 0;
  gpu::Buffer footfall;  // none unless footfalls are kept
  uint32_t footfallRoom = 0;
  gpu::Buffer awake;                    // blocks with somebody awake, where agents may sleep
  gpu::Buffer list;                     // legs that begin a step this tick
  gpu::Buffer counters;                 // indirect arguments and counts
  gpu::Buffer histogram;                // of reach errors
  std::vector<gpu::Bindings> bindings;  // one a stage
};

// What equal herds have in common, and their agents: herd after herd in the same pages, so that a tick's
// dispatches do not grow with their number.
struct Kind {
  std::vector<uint64_t> firstAgents;  // the first agent of each of its herds
  uint64_t agents = 0;
  int herdSteps = 0;  // 2 to their power is at least the number of herds in a page
  Rig rig;
  Controller controller = Controller::adaptive;
  int legs = 0, bones = 0, groups = 0;  // bones of the longest chain
  IkPlan ik{};
  Tuning tuning;
  ClipSet clipSet;  // without its frames: what a picture and a tool need
  ClipRecords clips;
  gpu::Buffer clipHeads, clipTimes, clipRows, clipLegs, clipBones;
  KeyPoses keyPoses;  // of controller key-poses
  gpu::Buffer keyBuffer;
  bool reachTriggered = false;  // legs step when out of reach, without a rhythm
  shared::Parameters parameters{};
  gpu::HostBuffer parameterBlock;  // Parameters; written once, before the first tick
  std::vector<float> rigRecords;   // as uploaded to rigBuffer
  gpu::Buffer rigBuffer;
  std::vector<ReadyStage> stages;  // of the controller, those that were asked for
  std::vector<Page> pages;

  // The place among the kind's herds of the one that an agent is of.
  uint32_t herdOf(uint64_t agent) const;
};

// A herd of the scene: a run of its kind's agents.
struct Herd {
  uint32_t kind = 0;   // which of the crowd's
  uint32_t place = 0;  // among the kind's herds
  uint32_t firstAgent = 0, agents = 0;
};

}  // namespace skitter::crowd

namespace skitter {

struct Crowd::Impl {
  const gpu::Context* context = nullptr;
  CrowdOptions options;
  Heightfield terrain;  // heights in memory too: cameras and tools look up the ground
  gpu::Image heights;   // R32F, columns x rows, in state sampled; what every stage and the picture read
  std::vector<crowd::Kind> kinds;
  std::vector<crowd::Herd> herds;  // as in the scene
  uint32_t watchEvery = 1;         // measure watches one agent of this many
  crowd::HeightEdits edits;
  uint64_t watchUntil = 0;  // the last tick in which gait looks at the ground; 0: never
  uint64_t tick = 0;
  float dt = 0;  // of the first tick; 0 before it
  gpu::StageTimer timer;

  crowd::Kind& kindOf(uint32_t herd) { return kinds[herds.at(herd).kind]; }
  const crowd::Kind& kindOf(uint32_t herd) const { return kinds[herds.at(herd).kind]; }
};

inline Crowd::Impl& implOf(Crowd& crowd) { return *crowd.impl_; }
inline const Crowd::Impl& implOf(const Crowd& crowd) { return *crowd.impl_; }

}  // namespace skitter
