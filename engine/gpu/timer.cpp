#include "gpu/timer.h"

#include <algorithm>
#include <cassert>
#include <cstring>

namespace skitter::gpu {

StageTimer::StageTimer(const Context& context, uint32_t maxStages, bool enabled)
    : context_(&context), maxStages_(maxStages) {
  entries_.reserve(maxStages);
  if (!enabled || !context.timestamps() || maxStages == 0) return;
  pool_ = guarded("the stage timer", [&] {
    return vk::raii::QueryPool(
        context.device(),
        vk::QueryPoolCreateInfo{.queryType = vk::QueryType::eTimestamp, .queryCount = 2 * maxStages});
  });
  context.name(*pool_, "stage timer");
}

void StageTimer::reset(vk::CommandBuffer cmd) {
  entries_.clear();
  if (measures()) cmd.resetQueryPool(*pool_, 0, 2 * maxStages_);
}

void StageTimer::begin(vk::CommandBuffer cmd, const char* stage) {
  if (!context_) return;
  context_->beginLabel(cmd, stage);
  if (!measures()) return;
  assert(entries_.size() < maxStages_);
  const auto query = uint32_t(2 * entries_.size());
  entries_.push_back({stage, false});
  // After all earlier work, or this stage would be charged with the tail of the one before.
  cmd.writeTimestamp2(vk::PipelineStageFlagBits2::eAllCommands, *pool_, query);
}

void StageTimer::end(vk::CommandBuffer cmd, [[maybe_unused]] const char* stage) {
  if (!context_) return;
  if (measures()) {
    const auto open =
        std::find_if(entries_.rbegin(), entries_.rend(), [](const Entry& e) { return !e.ended; });
    assert(open != entries_.rend() && std::strcmp(open->stage, stage) == 0);
    open->ended = true;
    const auto query = uint32_t(2 * (entries_.rend() - open - 1) + 1);
    cmd.writeTimestamp2(vk::PipelineStageFlagBits2::eAllCommands, *pool_, query);
  }
  context_->endLabel(cmd);
}

std::vector<StageTime> StageTimer::milliseconds() const {
  if (!measures() || entries_.empty()) return {};
  std::vector<uint64_t> ticks(2 * entries_.size());
  const vk::Result result = guarded("the stage timer", [&] {
    return (*context_->device())
        .getQueryPoolResults(*pool_, 0, uint32_t(ticks.size()), ticks.size() * sizeof(uint64_t), ticks.data(),
                             sizeof(uint64_t), vk::QueryResultFlagBits::e64);
  });
  if (result != vk::Result::eSuccess) {
    throw deviceError("the stage timer: " + vk::to_string(result));
  }
  const uint32_t bits = context_->limits().timestampBits;
  const uint64_t mask = bits >= 64 ? ~0ull : (1ull << bits) - 1;
  std::vector<StageTime> times;
  for (size_t i = 0; i < entries_.size(); ++i) {
    assert(entries_[i].ended);
    const uint64_t elapsed = (ticks[2 * i + 1] - ticks[2 * i]) & mask;
    times.push_back({entries_[i].stage, double(elapsed) * context_->limits().timestampPeriod * 1e-6});
  }
  return times;
}

}  // namespace skitter::gpu
