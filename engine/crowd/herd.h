#pragma once

#include <cstdint>
#include <memory>
#include <span>
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
  gpu::Buffer tint;                     // of each agent, where its kind is tinted; only pictures read it
  std::vector<gpu::Bindings> bindings;  // one a stage
};

// What equal herds have in common, and their agents: herd after herd in the same pages, so that a tick's
// dispatches do not grow with their number.
struct Kind {
  std::vector<uint64_t> firstAgents;  // the first agent of each of its herds
  uint64_t agents = 0;
  int herdSteps = 0;  // 2 to their power is at least the number of herds in a page
  float size = 1;
  Rig rig;  // of that size
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
  bool tinted = false;          // some herd of it has a colour or a tint of its own
  shared::Parameters parameters{};
  gpu::HostBuffer parameterBlock;  // Parameters; written once, before the first tick
  std::vector<float> rigRecords;   // as uploaded to rigBuffer
  gpu::Buffer rigBuffer;
  std::vector<ReadyStage> stages;  // of the controller, those that were asked for
  std::vector<Page> pages;

  // The place among the kind's herds of the one that an agent is of.
  uint32_t herdOf(uint64_t agent) const;
};

// A herd of the scene, or its agents of one size: a run of its kind's agents.
struct Herd {
  uint32_t kind = 0;   // which of the crowd's
  uint32_t place = 0;  // among the kind's herds
  uint32_t firstAgent = 0, agents = 0;
  uint32_t ofScene = 0;       // which of the scene's
  uint32_t firstOfScene = 0;  // the number of its first agent in that
};

}  // namespace skitter::crowd

namespace skitter {

struct Crowd::Impl {
  const gpu::Context* context = nullptr;
  CrowdOptions options;
  Heightfield terrain;  // heights in memory too: cameras and tools look up the ground
  gpu::Image heights;   // R32F, columns x rows, in state sampled; what every stage and the picture read
  std::vector<crowd::Kind> kinds;
  std::vector<crowd::Herd> herds;    // as in the scene, each size by itself
  std::vector<uint32_t> firstHerds;  // of these, the first of each herd of the scene; their number at the end
  uint32_t watchEvery = 1;           // measure watches one agent of this many
  crowd::HeightEdits edits;
  std::vector<Event> events;  // the scene's, by time
  uint64_t watchUntil = 0;  // the last tick in which gait looks at the ground; 0: never
  uint64_t tick = 0;
  float dt = 0;  // of the first tick; 0 before it
  gpu::StageTimer timer;

  // The sizes of a herd of the scene.
  std::span<const crowd::Herd> sizesOf(uint32_t herd) const {
    const uint32_t first = firstHerds.at(herd);
    return std::span(herds).subspan(first, firstHerds.at(herd + 1) - first);
  }
  // The one of them that an agent of the scene's herd is of; the last one for an agent that is not there.
  const crowd::Herd& sizeOf(uint32_t herd, uint32_t agent) const;
  const crowd::Kind& kindOf(const crowd::Herd& herd) const { return kinds[herd.kind]; }
  // The kind of the first size: but for lengths that of all others.
  const crowd::Kind& kindOf(uint32_t herd) const { return kindOf(sizesOf(herd).front()); }
};

inline Crowd::Impl& implOf(Crowd& crowd) { return *crowd.impl_; }
inline const Crowd::Impl& implOf(const Crowd& crowd) { return *crowd.impl_; }

}  // namespace skitter
