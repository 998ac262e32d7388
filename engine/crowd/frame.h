#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "crowd/herd.h"
#include "crowd/stage_id.h"

// How a tick is recorded.
namespace skitter::crowd {

// What foothold and ik list is cleared; the counts since the start stay.
void clearLists(std::span<const Kind> kinds, vk::CommandBuffer cmd);
// Nobody is awake until `wake` says so.
void clearAwake(const Crowd::Impl& crowd, std::span<const Kind> kinds, vk::CommandBuffer cmd);

// Which of the kind's stages solves legs that it is given a list of, from where their chains are; none where
// nothing goes on from chains, or the solver has no second dispatch.
std::optional<size_t> solverOf(const Kind& kind);

// Chains that start at rest reach their feet in so many solves.
constexpr int settleIterations = 6;

// The stages of one tick, of some or all of the crowd's kinds.
class Frame {
 public:
  // Most stages that a tick may have, for timers.
  static constexpr uint32_t mostStages = 20;

  Frame(const Crowd::Impl& crowd, std::span<const Kind> kinds, uint64_t tick, vk::CommandBuffer cmd)
      : crowd_(crowd), kinds_(kinds), tick_(tick), cmd_(cmd) {}
  // The name of the stage where a kind has it, else nullptr. The crowd's own.
  const char* nameOf(StageSet stage) const;
  // Records the stage of every kind that has it, without a barrier after it.
  void record(StageSet stage) const;
  // Solves the legs that the page's list has for ik's second dispatch, from where their chains are.
  void solveListed(const Kind& kind, const Page& page) const;

 private:
  void dispatch(const Kind& kind, const Page& page, size_t stage) const;
  void dispatchListed(const Kind& kind, const Page& page, size_t stage) const;

  const Crowd::Impl& crowd_;
  std::span<const Kind> kinds_;
  uint64_t tick_;
  vk::CommandBuffer cmd_;
};

}  // namespace skitter::crowd
