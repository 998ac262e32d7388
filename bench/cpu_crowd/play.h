#pragma once

#include "bench/cpu_crowd/layout.h"
#include "bench/cpu_crowd/rig.h"

namespace skitter::cpu_crowd {

// A clip as an agent plays it.
template <class F>
struct Played {
  F clip, time, rate, frame, fraction;
};

// play, as in include/skitter/records.h
template <class F>
struct Play {
  Played<F> to, from;
  F weight;
};

template <class F>
struct ClipHead {
  F first, frames, seconds, speed;
};

template <class F>
ClipHead<F> headOf(const ClipTable& table, const F& clip) {
  ClipHead<F> head{F(0), F(0), F(0), F(0)};
  for (size_t c = 0; c < table.clips.size(); ++c) {
    const ClipTable::Clip& one = table.clips[c];
    const auto is = absolute(clip - float(c)) < F(0.5f);
    head.first = select(is, F(one.first), head.first);
    head.frames = select(is, F(one.frames), head.frames);
    head.seconds = select(is, F(one.seconds), head.seconds);
    head.speed = select(is, F(one.speed), head.speed);
  }
  return head;
}

template <class F>
void advance(const shared::Parameters& q, const ClipHead<F>& clip, const F& speed, Played<F>& played) {
  const auto moves = F(0) < clip.speed;
  played.rate = select(moves, smaller(speed / larger(clip.speed, 1e-20f), q.clipRateMost), F(1));
  const F time = played.time + played.rate * q.dt;
  const F inside = time - roundDown(time / larger(clip.seconds, 1e-6f)) * clip.seconds;
  played.time = smaller(larger(inside, 0), clip.seconds);
}

// How ill a clip suits a speed, as a ratio: 2 to the power of docs/stages/clip.md's cost, which orders clips
// alike.
template <class F>
F misfitOf(const shared::Parameters& q, const ClipTable& table, float clipSpeed, const F& speed) {
  constexpr float kNever = 1e30f, kLast = 1e18f;
  const auto idle = speed < F(q.clipIdle);
  if (clipSpeed == 0) return select(idle, F(1), F(kNever));
  const F at = larger(speed, 1e-6f), ratio = larger(at * (1 / clipSpeed), F(clipSpeed) / at);
  return table.standing ? select(idle, ratio * kLast, ratio) : ratio;
}

// The last frame that has begun. Time goes on, so the search begins at the frame of the last tick.
template <class F>
void findFrame(const ClipTable& table, const ClipHead<F>& clip, Played<F>& played) {
  const F last = clip.first + clip.frames - 1.0f;
  const auto inside = (clip.first <= played.frame) & (played.frame <= last);
  F frame = select(inside, played.frame, clip.first);
  frame = select(played.time < gather(table.times.data(), frame), clip.first, frame);
  for (;;) {
    const F next = smaller(frame + 1.0f, last);
    const auto later = (frame < last) & (gather(table.times.data(), next) <= played.time);
    if (!any(later)) break;
    frame = select(later, next, frame);
  }
  const F since = played.time - gather(table.times.data(), frame);
  played.frame = frame;
  played.fraction = smaller(larger(since * gather(table.perSecond.data(), frame), 0), 1);
}

template <class F>
[[gnu::flatten]] void clip(const World& world, const Agent<F>& a, Play<F>& play) {
  const shared::Parameters& q = world.q;
  const ClipTable& table = world.clips;
  const F speed = a.surfaceSpeed + absolute(a.turnRate) * q.homeRadius;
  ClipHead<F> to = headOf(table, play.to.clip), from = headOf(table, play.from.clip);
  advance(q, to, speed, play.to);
  advance(q, from, speed, play.from);
  play.weight = smaller(F(1), play.weight + q.clipFade);

  const float favour = std::exp2(-q.clipHysteresis);
  F least(3e38f), best = play.to.clip;
  for (size_t c = 0; c < table.clips.size(); ++c) {
    const F misfit = misfitOf(q, table, table.clips[c].speed, speed);
    const auto played = absolute(play.to.clip - float(c)) < F(0.5f);
    const F cost = select(played, misfit * favour, misfit);
    best = select(cost < least, F(float(c)), best);
    least = smaller(cost, least);
  }
  const auto changes = (F(0.5f) < absolute(best - play.to.clip)) & (F(1) <= play.weight);
  if (any(changes)) {
    const ClipHead<F> next = headOf(table, best);
    const F phase = play.to.time / larger(to.seconds, 1e-6f);
    const auto bothMove = (F(0) < next.speed) & (F(0) < to.speed);
    play.from.clip = select(changes, play.to.clip, play.from.clip);
    play.from.time = select(changes, play.to.time, play.from.time);
    play.from.rate = select(changes, play.to.rate, play.from.rate);
    play.from.frame = select(changes, play.to.frame, play.from.frame);
    play.to.clip = select(changes, best, play.to.clip);
    play.to.time = select(changes, select(bothMove, phase * next.seconds, F(0)), play.to.time);
    play.weight = select(changes, F(0), play.weight);
    to = headOf(table, play.to.clip);
    from = headOf(table, play.from.clip);
  }
  findFrame(table, to, play.to);
  findFrame(table, from, play.from);
}

}  // namespace skitter::cpu_crowd
