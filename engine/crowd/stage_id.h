#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>

#include "skitter/enum_names.h"

// The stages of a tick (docs/stages.md), as plain data.
namespace skitter::crowd {

// Every stage, in the order in which they run.
// clang-format off
#define SKITTER_STAGES(STAGE) \
  STAGE(navigate) STAGE(avoid) STAGE(wake) STAGE(adapt) STAGE(react) STAGE(body) STAGE(clip) STAGE(gait) STAGE(foothold) STAGE(swing) \
  STAGE(ik) STAGE(pose) STAGE(measure) STAGE(footfall)
// clang-format on

enum class StageId : uint8_t {
#define SKITTER_STAGE(name) name,
  SKITTER_STAGES(SKITTER_STAGE)
#undef SKITTER_STAGE
};
inline constexpr std::array allStages = {
#define SKITTER_STAGE(name) StageId::name,
    SKITTER_STAGES(SKITTER_STAGE)
#undef SKITTER_STAGE
};
constexpr const char* nameOf(StageId stage) {
#define SKITTER_STAGE(name) #name,
  constexpr std::array names = {SKITTER_STAGES(SKITTER_STAGE)};
#undef SKITTER_STAGE
  return names[static_cast<size_t>(stage)];
}

// What one shader makes: a stage, or several at once.
class StageSet {
 public:
  constexpr StageSet(StageId stage) : bits_(1u << static_cast<unsigned>(stage)) {}
  constexpr StageSet(std::initializer_list<StageId> stages) {
    for (const StageId stage : stages) bits_ |= StageSet(stage).bits_;
  }
  constexpr bool has(StageId stage) const { return (bits_ & StageSet(stage).bits_) != 0; }
  constexpr bool operator==(const StageSet&) const = default;
  // "navigate+body+gait"
  std::string name() const {
    std::string names;
    for (const StageId stage : allStages)
      if (has(stage)) names += (names.empty() ? "" : "+") + std::string(nameOf(stage));
    return names;
  }

 private:
  uint32_t bits_ = 0;
};

// Whether a stage of that name is the other, or makes it among others, as "body+gait" does.
constexpr bool makes(std::string_view stage, std::string_view part) {
  for (size_t plus; (plus = stage.find('+')) != stage.npos; stage.remove_prefix(plus + 1))
    if (stage.substr(0, plus) == part) return true;
  return stage == part;
}

}  // namespace skitter::crowd
