#include "cpu_reference/stages/clip.h"
#include "cpu_reference/stages/tolerances_clip.h"
#include "skitter/records.h"
#include "validation/checks.h"
#include "validation/convert.h"
#include "validation/convert_clip.h"

namespace skitter::validation {
namespace {

namespace tolerance = reference::tolerance;
using reference::ClipTable;
using reference::Play;

struct PlayVerdict {
  Sample sample;
  bool tie = false;
};

// One of the two clips. `time` bounds its time; `before` is the floats of its clip and its frame.
void compare(const Setting& setting, const char* which, const Play::Played& expected, const Play::Played& got,
             double timeBound, double clipWritten, double frameWritten, PlayVerdict& verdict) {
  Sample& sample = verdict.sample;
  const ClipTable::Clip& clip = setting.clips.clips[static_cast<size_t>(expected.clip)];
  sample.same(which, expected.clip, clipWritten);
  // Just below its end one side may have begun the clip anew: the place in the cycle is what must agree.
  double apart = std::abs(expected.time - got.time);
  if (apart > timeBound && std::abs(clip.seconds - apart) <= timeBound) {
    apart = std::abs(clip.seconds - apart);
    verdict.tie = true;
  }
  sample.compare("time, s", apart, timeBound, {expected.time, 0, 0, 0}, {got.time, 0, 0, 0});
  sample.compare("time outside the clip, s", std::max({0.0, -got.time, got.time - clip.seconds}), 0,
                 {expected.time, 0, 0, 0}, {got.time, 0, 0, 0});
  sample.compare("rate", std::abs(expected.rate - got.rate), 8 * tolerance::roundoff * expected.rate,
                 {expected.rate, 0, 0, 0}, {got.rate, 0, 0, 0});
  // A time that is known to the bit has one frame.
  Play::Played framed = expected;
  framed.time = got.time;
  reference::findFrame(setting.clips, framed);
  sample.same("frame", static_cast<double>(framed.frame), frameWritten);
  sample.compare("fraction to the next frame", std::abs(framed.fraction - got.fraction), tolerance::fraction,
                 {framed.fraction, 0, 0, 0}, {got.fraction, 0, 0, 0});
}

PlayVerdict compare(const Setting& setting, const Moment& moment, const Play& previous,
                    const reference::ClipResult& result) {
  const auto written = records(moment.after.play, moment.agent, shared::PLAY_STRIDE);
  const Play got = playOf(moment.after, moment.agent, setting.clips);
  const Play& expected = result.play;
  const auto secondsOf = [&](int clip) { return setting.clips.clips[static_cast<size_t>(clip)].seconds; };
  PlayVerdict verdict;
  verdict.sample.finite("play", written);
  const bool switched = expected.weight == 0;
  double to = tolerance::clipTime(setting.tuning, previous.to.time, expected.to.rate);
  double from = tolerance::clipTime(setting.tuning, previous.from.time, expected.from.rate);
  if (switched) {
    from = to;
    const double longer = secondsOf(expected.to.clip), shorter = secondsOf(expected.from.clip);
    to = shorter > 0 ? to * longer / shorter + 8 * tolerance::roundoff * longer : 0;
  }
  compare(setting, "clip", expected.to, got.to, to, written[0], written[8], verdict);
  compare(setting, "clip faded from", expected.from, got.from, from, written[2], written[10], verdict);
  verdict.sample.compare("weight", std::abs(expected.weight - got.weight), tolerance::fade,
                         {expected.weight, 0, 0, 0}, {got.weight, 0, 0, 0});
  return verdict;
}

}  // namespace

void checkClip(const Setting& setting, const Moment& moment, Judge& judge) {
  const reference::AgentBody body = bodyOf(moment.after, moment.agent);
  const Play previous = playOf(moment.before, moment.agent, setting.clips);
  const Play got = playOf(moment.after, moment.agent, setting.clips);
  const auto run = [&](const reference::ClipChoices& choices) {
    return reference::clip(setting.tuning, setting.clips, body, previous, choices);
  };
  const reference::ClipResult result = run({});
  const PlayVerdict verdict = compare(setting, moment, previous, result);
  if (verdict.sample.passes()) {
    return judge.add(moment.n, moment.number(), -1, verdict.sample, verdict.tie);
  }

  // A speed at the idle threshold, a fade that ends in this tick or the next, two clips that suit as well.
  const bool idleTie = result.idleMargin <= tolerance::pace(setting.tuning, body);
  const bool fadeTie = result.fadeMargin <= tolerance::fade;
  for (int choice = 0; choice < 4; ++choice) {
    reference::ClipChoices choices;
    if (idleTie) choices.idle = (choice & 1) != 0;
    if (fadeTie) choices.faded = (choice & 2) != 0;
    const reference::ClipResult ruled = run(choices);
    const double most = ruled.costs[static_cast<size_t>(got.to.clip)];
    const double least = ruled.costs[static_cast<size_t>(ruled.winner)];
    if (most - least <= tolerance::clipCost(most) + tolerance::clipCost(least)) choices.winner = got.to.clip;
    const PlayVerdict other = compare(setting, moment, previous, run(choices));
    if (other.sample.passes()) return judge.add(moment.n, moment.number(), -1, other.sample, true);
  }
  judge.add(moment.n, moment.number(), -1, verdict.sample);
}

}  // namespace skitter::validation
