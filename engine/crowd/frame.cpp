#include "crowd/frame.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>

#include "crowd/grid.h"
#include "crowd/page.h"
#include "crowd/watch.h"
#include "gpu/barrier.h"

namespace skitter::crowd {
namespace {

uint32_t invocations(const Kind& kind, const Page& page, Stage::Over over, float dt) {
  const uint32_t agents = wholeBlocks(page.agents);
  switch (over) {
    case Stage::Over::joints:
      return page.agents * static_cast<uint32_t>(kind.clips.joints);
    case Stage::Over::legs:
    case Stage::Over::everyLeg:
      return agents * static_cast<uint32_t>(kind.legs);
    case Stage::Over::blocks:
      return agents / shared::BLOCK;
    case Stage::Over::lookers:
      return lookersOf(page, dt);
    case Stage::Over::everyone:
    case Stage::Over::agents:
    case Stage::Over::listed:
    case Stage::Over::watched:
      break;
  }
  return page.agents;
}

// Where the counters have the dispatch over those who are awake.
uint64_t awakeArguments(Stage::Over over) {
  return sizeof(uint32_t) * (over == Stage::Over::agents ? shared::COUNTER_AWAKE_AGENTS_X
                             : over == Stage::Over::legs ? shared::COUNTER_AWAKE_LEGS_X
                                                         : shared::COUNTER_AWAKE_JOINTS_X);
}

// In the ticks after an edit of the heights gait looks at the ground under every foot, and nobody sleeps.
bool watchesGround(const Crowd::Impl& crowd) {
  return crowd.watchUntil > 0 && crowd.tick <= crowd.watchUntil;
}

shared::TickConstants constantsOf(const Crowd::Impl& crowd, const Kind& kind, const Page& page,
                                  const Stage& stage, uint64_t tick) {
  const Stage::Over over = stage.over;
  if (over == Stage::Over::watched) {
    const Watch watch = watchAt(tick, crowd.watchEvery, page);
    return {watch.count, static_cast<float>(tick), watch.first, crowd.watchEvery, watch.watched, 0, 0};
  }
  if (over == Stage::Over::blocks && crowd.rates) return crowd.rates->constantsOf(crowd, page, tick);
  if (stage.seesCrowd) return crowd.grid->constantsOf(crowd, kind, page, stage, tick);
  const bool isForaging = stage.makes == StageId::navigate && kind.trails != nullptr;
  return {page.agents,
          static_cast<float>(tick),
          page.firstAgent,
          kind.avoids ? roundTicksOf(crowd.dt) : 1,
          isForaging ? ForageNumbers::leaveOf(*kind.wayfaring->forage, double{crowd.dt}) : 0,
          page.footfallRoom,
          !crowd.options.sleep || watchesGround(crowd) ? std::numeric_limits<float>::infinity()
                                                       : kind.parameters.sleepTime};
}

// The counters of a page in front of its herds' rows, as a tick begins: nobody is listed.
constexpr vk::DispatchIndirectCommand nobody{0, 1, 1};
struct Lists {
  vk::DispatchIndirectCommand foothold = nobody;
  uint32_t listed = 0, footfalls = 0;
  vk::DispatchIndirectCommand ik = nobody;
  uint32_t ikListed = 0;
};
struct Awake {
  vk::DispatchIndirectCommand agents = nobody, legs = nobody, joints = nobody;
  uint32_t blockCount = 0, agentCount = 0;
};

constexpr bool isCounter(size_t offset, int counter) { return offset == counter * sizeof(uint32_t); }
static_assert(isCounter(offsetof(Lists, foothold), shared::COUNTER_DISPATCH_X));
static_assert(isCounter(offsetof(Lists, listed), shared::COUNTER_LISTED));
static_assert(isCounter(offsetof(Lists, footfalls), shared::COUNTER_FOOTFALLS));
static_assert(isCounter(offsetof(Lists, ik), shared::COUNTER_IK_DISPATCH_X));
static_assert(isCounter(offsetof(Lists, ikListed), shared::COUNTER_IK_LISTED));
static_assert(isCounter(sizeof(Lists) + offsetof(Awake, agents), shared::COUNTER_AWAKE_AGENTS_X));
static_assert(isCounter(sizeof(Lists) + offsetof(Awake, legs), shared::COUNTER_AWAKE_LEGS_X));
static_assert(isCounter(sizeof(Lists) + offsetof(Awake, joints), shared::COUNTER_AWAKE_JOINTS_X));
static_assert(isCounter(sizeof(Lists) + offsetof(Awake, blockCount), shared::COUNTER_AWAKE_BLOCKS));
static_assert(isCounter(sizeof(Lists) + offsetof(Awake, agentCount), shared::COUNTER_AWAKE));
static_assert(isCounter(sizeof(Lists) + sizeof(Awake), shared::COUNTER_ROWS));

}  // namespace

void clearLists(std::span<const Kind> kinds, vk::CommandBuffer cmd) {
  const Lists none;
  for (const Kind& kind : kinds)
    for (const Page& page : kind.pages) cmd.updateBuffer(page.counters.handle(), 0, sizeof none, &none);
}

void clearAwake(const Crowd::Impl& crowd, std::span<const Kind> kinds, vk::CommandBuffer cmd) {
  const Awake none;
  for (const Kind& kind : kinds) {
    if (!kind.rests(crowd.options)) continue;
    for (const Page& page : kind.pages) {
      cmd.updateBuffer(page.counters.handle(), sizeof(Lists), sizeof none, &none);
      cmd.fillBuffer(page.awake.handle(), 0, VK_WHOLE_SIZE, 0);
    }
  }
}

std::optional<size_t> solverOf(const Kind& kind) {
  for (size_t i = 0; i < kind.stages.size(); ++i) {
    const ReadyStage& stage = kind.stages[i];
    const auto binds = [&](uint32_t binding) {
      return std::ranges::find(stage.bindings, binding, &gpu::BindingDecl::binding) != stage.bindings.end();
    };
    // planted goes on from clips, and only legs that it does not solve keep their chains.
    const bool goesOn = binds(shared::BINDING_CHAIN) && !binds(shared::BINDING_START);
    if (stage.makes.has(StageId::ik) && stage.listed && goesOn) return i;
  }
  return {};
}

const char* Frame::nameOf(StageSet made) const {
  for (const Kind& kind : kinds_)
    for (const ReadyStage& stage : kind.stages)
      if (stage.makes == made) return stage.first.name().c_str();
  return nullptr;
}

void Frame::record(StageSet made) const {
  const auto eachPage = [&](const auto& record) {
    for (const Kind& kind : kinds_)
      for (size_t i = 0; i < kind.stages.size(); ++i)
        if (kind.stages[i].makes == made)
          for (const Page& page : kind.pages) record(kind, page, i);
  };
  eachPage([&](const Kind& kind, const Page& page, size_t i) { dispatch(kind, page, i); });
  // What the first dispatches left out.
  bool listed = false;
  eachPage([&](const Kind& kind, const Page& page, size_t i) {
    if (!kind.stages[i].listed) return;
    if (!std::exchange(listed, true)) gpu::computeToIndirectAndCompute(cmd_);
    dispatchListed(kind, page, i);
  });
}

void Frame::dispatch(const Kind& kind, const Page& page, size_t index) const {
  const ReadyStage& stage = kind.stages[index];
  const gpu::Kernel& kernel = stage.afterEdit && watchesGround(crowd_) ? stage.afterEdit : stage.first;
  const shared::TickConstants constants = constantsOf(crowd_, kind, page, stage, tick_);
  const auto push = gpu::bytesOf(constants);
  if (stage.over == Stage::Over::listed)
    kernel.dispatchIndirect(cmd_, page.bindings[index], push, page.counters);
  else if (kind.rests(crowd_.options) && stage.isOfTheAwake())
    kernel.dispatchIndirect(cmd_, page.bindings[index], push, page.counters, awakeArguments(stage.over));
  else
    kernel.dispatch(cmd_, page.bindings[index], push,
                    gpu::groupsFor(invocations(kind, page, stage.over, crowd_.dt), shared::WORK_GROUP));
}

void Frame::solveListed(const Kind& kind, const Page& page) const {
  if (const std::optional<size_t> ik = solverOf(kind)) dispatchListed(kind, page, *ik);
}

void Frame::dispatchListed(const Kind& kind, const Page& page, size_t index) const {
  const ReadyStage& stage = kind.stages[index];
  const shared::TickConstants constants = constantsOf(crowd_, kind, page, stage, tick_);
  stage.listed.dispatchIndirect(cmd_, page.bindings[index], gpu::bytesOf(constants), page.counters,
                                static_cast<uint64_t>(stage.listedArguments) * sizeof(uint32_t));
}

}  // namespace skitter::crowd
