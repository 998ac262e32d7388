#pragma once

#include <optional>

#include "cpu_reference/clips/table.h"
#include "cpu_reference/types.h"

namespace skitter::reference {

// Decisions that the caller takes instead of the rule, to recompute the other side of a tie.
struct ClipChoices {
  std::optional<int> winner;  // among the costs
  std::optional<bool> idle;   // v_e < clipIdle
  std::optional<bool> faded;  // w = 1
};

struct ClipResult {
  Play play;
  int winner = 0;
  std::vector<double> costs;  // of each clip, hysteresis included
  double idleMargin = 0;      // m/s between v_e and clipIdle
  double fadeMargin = 0;      // of w + clipFade and 1
};

// `body` is the new one.
ClipResult clip(const Tuning& tuning, const ClipTable& table, const AgentBody& body, const Play& previous,
                const ClipChoices& choices = {});

// Sets frame and fraction from the time.
void findFrame(const ClipTable& table, Play::Played& played);

}  // namespace skitter::reference
