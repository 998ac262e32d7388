#include "cpu_reference/stages/gait_key_poses.h"
#include "cpu_reference/stages/tolerances_key_poses.h"
#include "skitter/records.h"
#include "validation/checks.h"
#include "validation/convert.h"
#include "validation/fields.h"

namespace skitter::validation {

void checkKeyPoseGait(const Setting& setting, const Moment& moment, Judge& judge) {
  const reference::AgentBody body = bodyOf(moment.after, moment.agent);
  const reference::Gait before = gaitOf(moment.before, moment.agent);
  const reference::Gait got = gaitOf(moment.after, moment.agent);
  const double stride = setting.keyPoses.stride;
  const double expected = reference::wheelPhase(setting.tuning, stride, body, before.phase);
  Sample sample;
  sample.finite("gait", records(moment.after.gait, moment.agent, shared::GAIT_STRIDE));
  const double apart = std::abs(expected - got.phase);
  sample.compare("phase", std::min(apart, std::abs(1 - apart)),
                 reference::tolerance::wheel(setting.tuning, stride, body), {expected, 0, 0, 0},
                 {got.phase, 0, 0, 0});
  sample.compare("phase outside [0, 1)", got.phase >= 0 && got.phase < 1 ? 0 : 1, 0, {expected, 0, 0, 0},
                 {got.phase, 0, 0, 0});
  compareFields(reference::Gait{}, got, sample);
  sample.same("masks", 0, got.lift | got.reaim);
  judge.add(moment.n, moment.number(), -1, sample);
}

}  // namespace skitter::validation
