#include "crowd/damage.h"

#include <algorithm>

namespace skitter::crowd {
namespace {

// Where the masks and the bones are among the values.
constexpr size_t firstBones = 4;

uint32_t maskOf(float value) { return static_cast<uint32_t>(value); }

}  // namespace

LegState Damage::of(uint32_t leg) const {
  const uint32_t bit = 1u << leg;
  return (lost & bit) != 0    ? LegState::lost
         : (stuck & bit) != 0 ? LegState::stuck
         : (lame & bit) != 0  ? LegState::lame
                              : LegState::whole;
}

void Damage::set(uint32_t leg, LegState state, uint32_t bone) {
  const uint32_t bit = 1u << leg;
  for (uint32_t* mask : {&lost, &stuck, &lame}) *mask &= ~bit;
  bones[leg] = state == LegState::lost ? static_cast<uint8_t>(bone) : uint8_t{0};
  if (state == LegState::lost) lost |= bit;
  if (state == LegState::stuck) stuck |= bit;
  if (state == LegState::lame) lame |= bit;
}

std::array<float, Damage::floats> Damage::values() const {
  std::array<float, floats> values{static_cast<float>(lost), static_cast<float>(stuck),
                                   static_cast<float>(lame), 0};
  std::array<uint32_t, 4> packed{};
  for (size_t leg = 0; leg < bones.size(); ++leg)
    packed[leg / shared::HURT_BONES_LEGS] |= uint32_t{bones[leg]} << 4 * (leg % shared::HURT_BONES_LEGS);
  std::ranges::transform(packed, values.begin() + firstBones,
                         [](uint32_t number) { return static_cast<float>(number); });
  return values;
}

Damage Damage::ofValues(std::span<const float> values) {
  Damage damage{.lost = maskOf(values[0]), .stuck = maskOf(values[1]), .lame = maskOf(values[2])};
  for (size_t leg = 0; leg < damage.bones.size(); ++leg)
    damage.bones[leg] = static_cast<uint8_t>(
        shared::packedBone(values[firstBones + leg / shared::HURT_BONES_LEGS], static_cast<int>(leg)));
  return damage;
}

std::vector<float> hurtRecord(const Damage& damage, const Regait& gait) {
  const std::array<float, Damage::floats> values = damage.values();
  std::vector<float> record(values.begin(), values.end());
  record[3] = static_cast<float>(gait.groups);
  record.insert(record.end(), {gait.shift.x, gait.shift.y, gait.shift.z, gait.speed});
  for (const LegTurn& leg : gait.legs)
    record.insert(record.end(), {static_cast<float>(leg.group) + leg.within, leg.lag,
                                 static_cast<float>(leg.neighbours), leg.slowness});
  return record;
}

}  // namespace skitter::crowd
