#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "crowd/regait.h"
#include "skitter/leg_state.h"
#include "skitter/records.h"

namespace skitter::crowd {

// Which of an agent's legs are hurt, as its record has it: its first two vec4, less the gait's groups.
struct Damage {
  uint32_t lost = 0, stuck = 0, lame = 0;          // masks of legs
  std::array<uint8_t, shared::MOST_LEGS> bones{};  // of a lost leg the first bone that is lost; else 0

  LegState of(uint32_t leg) const;
  void set(uint32_t leg, LegState state, uint32_t bone);
  bool isNone() const { return lost == 0 && stuck == 0 && lame == 0; }
  LegPattern pattern() const { return {.idle = lost | stuck, .lame = lame}; }
  bool operator==(const Damage&) const = default;

  static constexpr size_t floats = 8;
  std::array<float, floats> values() const;
  static Damage ofValues(std::span<const float> values);
};

// The agent's `hurt` record.
std::vector<float> hurtRecord(const Damage& damage, const Regait& gait);

}  // namespace skitter::crowd
