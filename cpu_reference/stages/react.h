#pragma once

#include <array>
#include <optional>
#include <span>

#include "cpu_reference/stages/gait.h"
#include "cpu_reference/types.h"

namespace skitter::reference {

// React decides each of these by a number that is above a threshold or not; its unit stands beside it.
enum class ReactDecision {
  losesGround,  // metres
  isCaught,     // metres
  falls,        // seconds
  isFree,       // of a push: metres a second
  hasRisen,     // metres
  isBlocked,    // metres
  touches,      // metres
  isSlow,       // metres a second
  isCalm,       // radians a second
  hasLain,      // seconds
  isUpright,    // radians
};
inline constexpr size_t reactDecisions = static_cast<size_t>(ReactDecision::isUpright) + 1;

struct ReactResult {
  Reaction reaction;
  // How far each was from falling the other way; infinite where it was not asked for.
  std::array<double, reactDecisions> margins;
  glm::dmat3 frame{1};                  // of a fallen body
  std::array<glm::dvec2, 10> looked{};  // where the ground below it was looked up, world
  size_t lookups = 0;
};

// Bit d: decision d falls the other way than the rule has it, to recompute the other side of a tie.
using ReactFlips = uint32_t;

// `creature` is as it is hurt, `body` and `before` are of the last tick, `push` is what the host says of this
// one, `idleBefore` the last tick's Gait::idle, `tick` n.
ReactResult react(const Tuning& tuning, const Heights& heights, const Creature& creature,
                  const AgentBody& body, const Reaction& before, std::span<const Step> steps,
                  std::span<const double> misses, double tick, const std::optional<glm::dvec2>& push,
                  WatchedGround watched, uint32_t idleBefore, ReactFlips flips = 0);

// An agent that has no tick of its own now, as a push leaves it.
Reaction pushed(const Tuning& tuning, const Creature& creature, const Reaction& before,
                const glm::dvec2& push);

// T_c is the time constant of the pendulum. `centre` is the creature's.
double pendulumTime(const Tuning& tuning, const glm::dvec3& centre);

// R_0 of a body that stands on `up` and is tipped over toward `way`.
glm::dmat3 tippedFrame(const glm::dvec3& up, const glm::dvec2& heading, const glm::dvec2& way, double tilt);

// A loose body after the tick.
AgentBody looseBody(const Tuning& tuning, const AgentBody& previous, const Reaction& reaction);

// The creature as the later stages have it: legs of a fallen one do not carry, homes are ahead of who is
// pushed. `orientation` is the new body's.
Creature reactingCreature(const Tuning& tuning, const Creature& hurt, const Reaction& reaction,
                          const glm::dquat& orientation);

// Where the foot of a folding leg goes: `foot` is its target as ever. `home` is the rig's.
Foot foldedFoot(const Tuning& tuning, const Heights& heights, const glm::dvec3& root, const glm::dvec3& home,
                const AgentBody& body, const Foot& foot, double fold);

}  // namespace skitter::reference
