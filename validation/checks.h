#pragma once

#include "cpu_reference/stages/navigate.h"
#include "validation/replay.h"

// What the check of each stage, in check_X.cpp, is given, and the table of them all (checks.cpp).
namespace skitter::validation {

// The two states around tick n, the agent to look at, and who is around it.
struct Moment {
  uint64_t n;
  const HerdState& before;
  const HerdState& after;
  size_t agent;  // of those that the states hold
  const Surroundings& around;
  uint64_t span = 1;  // ticks since the agent's last one; more than 1 only where there are levels of rate
  // Times in ticks of the agent's own: n, and of a step.
  double now() const { return static_cast<double>(n) / static_cast<double>(span); }
  reference::Step stepOf(const HerdState& state, size_t leg) const;
  // Among all whom these are a sample of.
  size_t number() const { return after.sample.first + agent * after.sample.stride; }
};

// The agent as others see it, where its herd avoids. Throws Error(input) where the surroundings lack it.
const reference::Walker& selfAround(const Setting& setting, const Moment& moment);

// The facts by which navigate decides whether the agent sleeps.
reference::Rest restOf(const Setting& setting, const Moment& moment);

// A sleeper's records must be those of before the tick, bit for bit; adds what is not.
void checkKept(const Setting& setting, const Moment& moment, Record record, Judge& judge);

// The reaction of an agent that is pushed but has no tick of its own now.
void checkPushed(const Setting& setting, const Moment& moment, const glm::dvec2& push, Judge& judge);

// A field against fast marching over the same costs.
Sample compareWay(const reference::WayField& field);

// An agent that forages, as stage navigate has it.
void checkForage(const Setting& setting, const Moment& moment, Judge& judge);
// The trail of its colony, where the states hold all of that.
void checkTrail(const Setting& setting, uint64_t n, const HerdState& before, const HerdState& after,
                Judge& judge);

// What holds a stage of some controllers against the reference: adds a sample an agent, a leg or, for clips,
// a joint to its judge.
struct Check {
  crowd::StageId stage;
  std::vector<Controller> of;
  void (*check)(const Setting& setting, const Moment& moment, Judge& judge);
  std::vector<Record> writes = {};  // that a sleeper keeps; none: it takes part in the stage as ever
};
// The checks of a controller's stages, in the order in which a tick makes them; of those in `only` unless
// that is empty.
std::vector<const Check*> checksOf(Controller controller, std::span<const crowd::StageId> only = {});
// Whether the states lack what the stage writes, since nobody asked for it.
bool isLeftOut(crowd::StageId stage, const HerdState& before, const HerdState& after);

// `count` records of `stride` vec4 beginning with record `index`.
inline std::span<const float> records(const std::vector<float>& buffer, size_t index, int stride,
                                      size_t count = 1) {
  const size_t floats = 4 * static_cast<size_t>(stride);
  return {buffer.data() + index * floats, count * floats};
}

}  // namespace skitter::validation
