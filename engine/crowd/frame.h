#pragma once

#include "crowd/herd.h"
#include "crowd/stage_id.h"

// How a tick is recorded.
namespace skitter::crowd {

// What foothold and ik list is cleared; the counts since the start stay.
void clearLists(const Crowd::Impl& crowd, vk::CommandBuffer cmd);
// Nobody is awake until `wake` says so.
void clearAwake(const Crowd::Impl& crowd, vk::CommandBuffer cmd);

// The stages of one tick, of all kinds.
class Frame {
 public:
  // Most stages that a tick may have, for timers.
  static constexpr uint32_t mostStages = 16;

  Frame(const Crowd::Impl& crowd, uint64_t tick, vk::CommandBuffer cmd)
      : crowd_(crowd), tick_(tick), cmd_(cmd) {}
  // The name of the stage where a kind has it, else nullptr. The crowd's own.
  const char* nameOf(StageSet stage) const;
  // Records the stage of every kind that has it, without a barrier after it.
  void record(StageSet stage) const;

 private:
  void dispatch(const Kind& kind, const Page& page, size_t stage) const;
  void dispatchListed(const Kind& kind, const Page& page, size_t stage) const;

  const Crowd::Impl& crowd_;
  uint64_t tick_;
  vk::CommandBuffer cmd_;
};

}  // namespace skitter::crowd
