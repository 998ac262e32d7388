#include "cpu_reference/stages/clip.h"

#include <algorithm>

namespace skitter::reference {
namespace {

void advance(const Tuning& tuning, const ClipTable& table, double pace, Play::Played& played) {
  const ClipTable::Clip& clip = table.clips[static_cast<size_t>(played.clip)];
  played.rate = clip.speed > 0 ? std::min(pace / clip.speed, tuning.clipRateMost) : 1;
  played.time += played.rate * tuning.dt;
  played.time -= clip.seconds > 0 ? std::floor(played.time / clip.seconds) * clip.seconds : played.time;
}

double costOf(const ClipTable& table, const ClipTable::Clip& clip, double pace, bool idle) {
  if (!(clip.speed > 0)) return idle ? 0 : 2000;
  const bool canStand =
      std::any_of(table.clips.begin(), table.clips.end(), [](const auto& c) { return !(c.speed > 0); });
  const double apart = std::abs(std::log2(std::max(pace, 1e-6) / clip.speed));
  return idle && canStand ? 1000 + apart : apart;
}

// The faded clip begins where the other one is in its own cycle.
void switchTo(const ClipTable& table, int winner, Play& play) {
  const ClipTable::Clip& old = table.clips[static_cast<size_t>(play.to.clip)];
  const ClipTable::Clip& next = table.clips[static_cast<size_t>(winner)];
  play.from = play.to;
  play.to.clip = winner;
  play.to.time = old.speed > 0 && next.speed > 0 ? play.from.time / old.seconds * next.seconds : 0;
  play.weight = 0;
}

}  // namespace

void findFrame(const ClipTable& table, Play::Played& played) {
  const ClipTable::Clip& clip = table.clips[static_cast<size_t>(played.clip)];
  const size_t last = clip.firstFrame + clip.frames - 1;
  played.frame = clip.firstFrame;
  while (played.frame < last && table.frames[played.frame + 1].time <= played.time) ++played.frame;
  played.fraction = 0;
  if (played.frame == last) return;
  const double begin = table.frames[played.frame].time, end = table.frames[played.frame + 1].time;
  played.fraction = (played.time - begin) / (end - begin);
}

ClipResult clip(const Tuning& tuning, const ClipTable& table, const AgentBody& body, const Play& previous,
                const ClipChoices& choices) {
  ClipResult result;
  result.play = previous;
  Play& play = result.play;
  const double pace = body.pace(tuning);
  advance(tuning, table, pace, play.to);
  advance(tuning, table, pace, play.from);
  const double risen = play.weight + tuning.clipFade;
  result.fadeMargin = std::abs(risen - 1);
  play.weight = std::min(1.0, risen);

  result.idleMargin = std::abs(pace - tuning.clipIdle);
  const bool idle = choices.idle.value_or(pace < tuning.clipIdle);
  for (size_t c = 0; c < table.clips.size(); ++c) {
    const double favour = static_cast<int>(c) == play.to.clip ? tuning.clipHysteresis : 0;
    result.costs.push_back(costOf(table, table.clips[c], pace, idle) - favour);
  }
  const auto least = std::min_element(result.costs.begin(), result.costs.end());
  result.winner = choices.winner.value_or(static_cast<int>(least - result.costs.begin()));
  if (result.winner != play.to.clip && choices.faded.value_or(risen >= 1)) {
    switchTo(table, result.winner, play);
  }
  findFrame(table, play.to);
  findFrame(table, play.from);
  return result;
}

}  // namespace skitter::reference
