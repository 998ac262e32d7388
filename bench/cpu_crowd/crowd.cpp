#include "bench/cpu_crowd/crowd.h"

#include "bench/cpu_baseline/lanes.h"
#include "bench/cpu_crowd/kernel.h"
#include "bench/cpu_crowd/pool.h"
#include "shared/ik_batch.h"
#include "skitter/error.h"
#include "skitter/records.h"

namespace skitter::cpu_crowd {
namespace {

void expectSize(const char* what, const std::vector<float>& records, size_t count, int stride) {
  const size_t expected = 4 * count * size_t(stride);
  if (records.size() == expected) return;
  throw inputError("CPU crowd: " + std::string(what) + " records: found " + std::to_string(records.size()) +
                   " floats, expected " + std::to_string(expected));
}

void check(const validation::HerdFacts& facts, const HerdState& start, const Options& options) {
  const bool clips = facts.controller == Controller::clip;
  if (!clips && facts.controller != Controller::adaptive)
    throw inputError(
        "CPU crowd: moves adaptive and clip herds alone; set the herd's controller to one of these");
  if (!clips && (facts.ik.solver != shared::SOLVER_FABRIK || facts.ik.polish < 1))
    throw inputError("CPU crowd: solves by active-set alone; set the herd's solver to it");
  if (options.threads < 1)
    throw inputError("CPU crowd: found " + std::to_string(options.threads) + " threads, expected at least 1");
  if (start.agents == 0) throw inputError("CPU crowd: found no agents, expected at least 1");
  const size_t agents = start.agents, legs = facts.rig.legs.size();
  expectSize("goal", start.goal, agents, shared::GOAL_STRIDE);
  expectSize("steer", start.steer, agents, shared::STEER_STRIDE);
  expectSize("body", start.body, agents, shared::BODY_STRIDE);
  expectSize("gait", start.gait, agents, shared::GAIT_STRIDE);
  for (size_t agent = 0; agent < agents; ++agent)
    if (start.body[4 * shared::BODY_STRIDE * agent + 7] != 0)
      throw inputError("CPU crowd: nobody is in place " + std::to_string(agent) +
                       "; set the herd's reserve to 0");
  if (clips) return expectSize("play", start.play, agents, shared::PLAY_STRIDE);
  expectSize("step", start.step, agents * legs, shared::STEP_STRIDE);
  expectSize("arc", start.arc, agents * legs, shared::ARC_STRIDE);
  expectSize("chain", start.chain, agents * legs, shared::chainStride(facts.rig.maxBones()));
  expectSize("miss", start.miss, agents, shared::missStride(int(legs)));
}

}  // namespace

struct CpuCrowd::Impl {
  World world;
  Options options;
  uint32_t agents;
  bool timed = false;
  uint64_t tick;  // the last one made
  std::unique_ptr<Kernel> kernel;
  Pool pool;

  Impl(const validation::HerdFacts& facts, const HerdState& start, const Options& chosen)
      : world(worldOf(facts)), options(chosen), agents(start.agents), tick(start.tick), pool(chosen.threads) {
    kernel = options.width == Width::simd ? simdKernel(world, start, options)
                                          : scalarKernel(world, start, options);
  }
};

CpuCrowd::CpuCrowd(const validation::HerdFacts& facts, const HerdState& start, const Options& options) {
  check(facts, start, options);
  impl_ = std::make_unique<Impl>(facts, start, options);
}

CpuCrowd::~CpuCrowd() = default;

void CpuCrowd::tick(uint64_t n) {
  Kernel& kernel = *impl_->kernel;
  impl_->tick = n;
  impl_->pool.run(kernel.parts(),
                  [&](size_t part, int thread) { kernel.tick(n, part, thread, impl_->timed); });
}

void CpuCrowd::beginSteps(uint64_t n, size_t legs) {
  const World& world = impl_->world;
  const size_t most = world.clips.clips.empty() ? impl_->agents * world.legs.size() : 0;
  if (legs > most)
    throw inputError("CPU crowd: found " + std::to_string(legs) +
                     " legs that begin a step, expected at most " + std::to_string(most));
  impl_->tick = n;
  impl_->kernel->beginSteps(n, legs);
}

void CpuCrowd::timeStages(bool on) { impl_->timed = on; }

HerdState CpuCrowd::state() const {
  const size_t agents = impl_->agents, legs = impl_->world.legs.size(), bones = size_t(impl_->world.bones);
  HerdState state;
  state.tick = impl_->tick;
  state.agents = impl_->agents;
  const auto make = [](std::vector<float>& records, size_t count, int stride) {
    records.resize(4 * count * size_t(stride));
  };
  make(state.goal, agents, shared::GOAL_STRIDE);
  make(state.steer, agents, shared::STEER_STRIDE);
  make(state.body, agents, shared::BODY_STRIDE);
  make(state.gait, agents, shared::GAIT_STRIDE);
  make(state.step, agents * legs, shared::STEP_STRIDE);
  make(state.arc, agents * legs, shared::ARC_STRIDE);
  make(state.foot, agents * legs, shared::FOOT_STRIDE);
  make(state.chain, agents * legs, shared::chainStride(int(bones)));
  make(state.tip, agents * legs, shared::TIP_STRIDE);
  make(state.miss, agents, shared::missStride(int(legs)));
  const ClipTable& clips = impl_->world.clips;
  if (!clips.clips.empty()) make(state.play, agents, shared::PLAY_STRIDE);
  if (impl_->options.poses && clips.clips.empty())
    make(state.pose, agents * (1 + legs * bones), shared::POSE_STRIDE);
  if (impl_->options.poses && !clips.clips.empty())
    make(state.pose, agents * size_t(clips.joints), shared::MATRIX_STRIDE);
  impl_->kernel->read(state);
  return state;
}

std::vector<StageSeconds> CpuCrowd::stageSeconds() const { return impl_->kernel->stageSeconds(); }

size_t CpuCrowd::bytesAnAgent() const { return impl_->kernel->bytes(); }

std::string buildDescription() {
  return "SIMD " SKITTER_SIMD_FLAGS "; scalar " SKITTER_SCALAR_FLAGS "; " SKITTER_BENCH_COMPILER ", " +
         std::to_string(baseline::kLanes) + " floats a register";
}

}  // namespace skitter::cpu_crowd
