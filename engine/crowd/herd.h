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
#include "shared/records.h"
#include "skitter/crowd.h"

// What a crowd is made of on the device; the stages and the renderer read it.
namespace skitter::crowd {

// A run of agents whose records fit the device's bindings. Layouts: shaders/shared/records.h.
struct Page {
  uint32_t firstAgent = 0;
  uint32_t agents = 0;
  gpu::Buffer goal, steer, body, gait, step, foot, chain;
  gpu::Buffer arc;               // where feet are swung by steps
  gpu::Buffer miss;              // where ik tells of it
  gpu::Buffer tip;               // of one agent alone unless somebody looks at feet
  gpu::Buffer pose;              // none unless poses are wanted
  gpu::Buffer metric, watch;     // none unless fidelity is measured
  gpu::Buffer play, start, fix;  // where clips are played, the latter two where they are planted
  gpu::Buffer spring;            // of controller pose
  gpu::Buffer flight, footfall;  // none unless footfalls are kept
  uint32_t footfallRoom = 0;
  gpu::Buffer awake;                    // blocks with somebody awake, where agents may sleep
  gpu::Buffer list;                     // legs that begin a step this tick
  gpu::Buffer counters;                 // indirect arguments and counts
  gpu::Buffer histogram;                // of reach errors
  std::vector<gpu::Bindings> bindings;  // one a stage
};

struct Herd {
  Rig rig;
  Controller controller = Controller::adaptive;
  int legs = 0, bones = 0, groups = 0;  // bones of the longest chain
  IkPlan ik{};
  ClipSet clipSet;  // without its frames: what a picture and a tool need
  ClipRecords clips;
  gpu::Buffer clipHeads, clipTimes, clipRows, clipLegs, clipBones;
  KeyPoses keyPoses;  // of controller pose
  gpu::Buffer keyBuffer;
  bool reachTriggered = false;  // legs step when out of reach, without a rhythm
  shared::Parameters parameters{};
  gpu::HostBuffer parameterBlock;  // Parameters; written once, before the first tick
  std::vector<float> rigRecords;   // as uploaded to rigBuffer
  gpu::Buffer rigBuffer;
  std::vector<Stage> stages;             // of the controller, those that were asked for
  std::vector<gpu::Kernel> kernels;      // one a stage, specialised
  std::vector<gpu::Kernel> restKernels;  // one a stage: for what that leaves out (Stage::rest), mostly none
  gpu::Kernel watchingGait;              // gait in the ticks after an edit of the heights
  std::vector<Page> pages;
};

}  // namespace skitter::crowd

namespace skitter {

struct Crowd::Impl {
  const gpu::Context* context = nullptr;
  CrowdOptions options;
  Heightfield terrain;  // heights in memory too: cameras and tools look up the ground
  gpu::Image heights;   // R32F, columns x rows, in state sampled; what every stage and the picture read
  std::vector<crowd::Herd> herds;
  uint32_t watchEvery = 1;  // measure watches one agent of this many
  crowd::HeightEdits edits;
  uint64_t watchUntil = 0;  // the last tick in which gait looks at the ground; 0: never
  uint64_t tick = 0;
  float dt = 0;  // of the first tick; 0 before it
  gpu::StageTimer timer;
};

}  // namespace skitter
