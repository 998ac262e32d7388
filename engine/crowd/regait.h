#pragma once

#include <compare>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "skitter/rig.h"
#include "skitter/tuning.h"

namespace skitter::crowd {

// Masks of legs: those that do not carry, and those that are lame.
struct LegPattern {
  uint32_t idle = 0, lame = 0;

  auto operator<=>(const LegPattern&) const = default;
};

// A leg's place in a gait.
struct LegTurn {
  int group = 0;
  float within = 0;  // how much later than its group's the leg's turn begins, in turns, 0 to less than 1
  float lag = 0;     // as LegOrder
  uint32_t neighbours = 0;  // bit m: leg m must stand while this one is in the air
  float slowness = 1;       // how many times as long as others its step lasts
};

// The gait of a creature with some legs that do not carry (docs/damage.md).
struct Regait {
  int groups = 1;
  glm::vec3 shift{0};  // of the homes, model space, metres
  float speed = 1;     // share of the desired velocity
  // The fitness that it should have on flat ground (docs/evolve.md#fitness): of a table the one that was
  // found, by rule the share of the velocity, less that of the time without support.
  float worth = 1;
  std::vector<LegTurn> legs;
};

// By rule: the legs that carry regroup so that the body's centre stays inside of the support polygon and no
// leg is stretched too far, at one leg length per second or as much of it as that allows. The rig's own gait
// where all carry.
Regait regaitByRule(const Rig& rig, const Tuning& tuning, const LegPattern& pattern);

// As the rig's table has it for the pattern or for its mirror image (docs/evolve.md); else by rule.
Regait regaitFor(const Rig& rig, const Tuning& tuning, const LegPattern& pattern);

// The share of the time for which each leg stands, at a wish of so many leg lengths per second; idle legs
// have 0.
std::vector<float> standingShares(const Tuning& tuning, const Regait& gait, uint32_t idle, double wanted);

// How much lower the body must be for every leg that carries to reach its home, shifted by so much (model x
// and z, metres), as well as the rig's legs reach theirs, or comfortably. Metres.
float loweringFor(const Rig& rig, const Tuning& tuning, const LegPattern& pattern, const glm::vec2& shift);

// What a gait of a table is for a pattern whose idle legs are the gait's. Lame legs are slower, as by rule.
Regait regaitOf(const Rig& rig, const RigGait& gait, const LegPattern& pattern);

}  // namespace skitter::crowd
