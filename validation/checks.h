#pragma once

#include "validation/replay.h"

// One check a stage and what it can be; each adds a sample an agent or a leg to its judge.
namespace skitter::validation {

// The two states around tick n, and the agent to look at.
struct Moment {
  uint64_t n;
  const HerdState& before;
  const HerdState& after;
  size_t agent;  // of those that the states hold
  size_t number() const { return after.sample.first + agent * after.sample.stride; }  // in the herd
};

// A sleeper's records must be those of before the tick, bit for bit; adds what is not.
void checkKept(const Setting& setting, const Moment& moment, Record record, Judge& judge);

void checkNavigate(const Setting& setting, const Moment& moment, Judge& judge);
void checkBody(const Setting& setting, const Moment& moment, Judge& judge);
void checkBlindBody(const Setting& setting, const Moment& moment, Judge& judge);
void checkClip(const Setting& setting, const Moment& moment, Judge& judge);
void checkGait(const Setting& setting, const Moment& moment, Judge& judge);
void checkLoopGait(const Setting& setting, const Moment& moment, Judge& judge);
void checkKeyPoseGait(const Setting& setting, const Moment& moment, Judge& judge);
void checkFoothold(const Setting& setting, const Moment& moment, Judge& judge);
void checkSwing(const Setting& setting, const Moment& moment, Judge& judge);
void checkLoopSwing(const Setting& setting, const Moment& moment, Judge& judge);
void checkClipSwing(const Setting& setting, const Moment& moment, Judge& judge);
void checkPlantedSwing(const Setting& setting, const Moment& moment, Judge& judge);
void checkKeyPoseSwing(const Setting& setting, const Moment& moment, Judge& judge);
void checkIk(const Setting& setting, const Moment& moment, Judge& judge);
void checkPlantedIk(const Setting& setting, const Moment& moment, Judge& judge);
void checkPose(const Setting& setting, const Moment& moment, Judge& judge);
// A sample a joint, in place of a leg.
void checkClipPose(const Setting& setting, const Moment& moment, Judge& judge);
void checkPlantedPose(const Setting& setting, const Moment& moment, Judge& judge);
void checkMeasure(const Setting& setting, const Moment& moment, Judge& judge);
void checkFootfall(const Setting& setting, const Moment& moment, Judge& judge);

// `count` records of `stride` vec4 beginning with record `index`.
inline std::span<const float> records(const std::vector<float>& buffer, size_t index, int stride,
                                      size_t count = 1) {
  const size_t floats = 4 * static_cast<size_t>(stride);
  return {buffer.data() + index * floats, count * floats};
}

}  // namespace skitter::validation
