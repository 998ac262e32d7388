#include "assets/clips/clip_stance.h"

#include <algorithm>
#include <cmath>

namespace skitter {
namespace {

constexpr double leastRange = 0.02;  // leg lengths: a foot that moves less up and down never lifts
constexpr double leastSpeed = 0.05;  // leg lengths a second: slower is standing

// What a foot may do and still stand: its height above its lowest, a share of its range, and its speed
// forward, a share of its greatest.
struct Limits {
  double height, forward;
};
constexpr Limits begins{0.15, 0.15}, stays{0.25, 0.3};

struct Foot {
  std::vector<double> y, z, advance;  // the last the speed along z
  double low = 0, range = 0;
};

// The seconds from the frame before to the frame after.
double around(const Clip& clip, size_t frame) {
  const size_t before = frame > 0 ? frame - 1 : 0, after = std::min(frame + 1, clip.frames() - 1);
  return static_cast<double>(clip.times[after]) - static_cast<double>(clip.times[before]);
}

Foot footOf(const Clip& clip, size_t legs, size_t leg) {
  Foot foot;
  for (size_t frame = 0; frame < clip.frames(); ++frame) {
    foot.y.push_back(static_cast<double>(clip.feet[frame * legs + leg].y));
    foot.z.push_back(static_cast<double>(clip.feet[frame * legs + leg].z));
  }
  for (size_t frame = 0; frame < clip.frames(); ++frame) {
    const size_t before = frame > 0 ? frame - 1 : 0, after = std::min(frame + 1, clip.frames() - 1);
    const double seconds = around(clip, frame);
    foot.advance.push_back(seconds > 0 ? (foot.z[after] - foot.z[before]) / seconds : 0);
  }
  foot.low = *std::min_element(foot.y.begin(), foot.y.end());
  foot.range = *std::max_element(foot.y.begin(), foot.y.end()) - foot.low;
  return foot;
}

// The flags of one foot. `forward` is 1, or -1 for a creature that walks backward.
void markStance(Clip& clip, const Foot& foot, double forward, size_t legs, size_t leg) {
  double fastest = 0;
  for (const double advance : foot.advance) fastest = std::max(fastest, forward * advance);
  bool stands = false;
  // Twice through, because clips loop.
  for (size_t k = 0; k < 2 * clip.frames(); ++k) {
    const size_t f = k % clip.frames();
    const Limits& limits = stands ? stays : begins;
    stands = foot.y[f] - foot.low <= limits.height * foot.range &&
             forward * foot.advance[f] <= limits.forward * fastest;
    clip.stance[f * legs + leg] = stands;
  }
}

// An interval in which a foot stands.
struct Stance {
  double backward = 0, seconds = 0;  // its speed, and how long
};

// The middle one by time: feet that roll on or off the ground pull a mean down.
double median(std::vector<Stance> stances) {
  std::sort(stances.begin(), stances.end(),
            [](const Stance& a, const Stance& b) { return a.backward < b.backward; });
  double seconds = 0, sum = 0;
  for (const Stance& stance : stances) seconds += stance.seconds;
  for (const Stance& stance : stances) {
    sum += stance.seconds;
    if (2 * sum >= seconds) return stance.backward;
  }
  return 0;
}

}  // namespace

void findStance(Clip& clip, size_t legs, double legLength) {
  clip.stance.assign(clip.frames() * legs, 1);
  std::vector<Foot> feet;
  for (size_t leg = 0; leg < legs; ++leg) feet.push_back(footOf(clip, legs, leg));
  const auto lifts = [&](const Foot& foot) { return foot.range >= leastRange * legLength; };

  // Low feet go backward, unless the creature does.
  double way = 0;
  for (const Foot& foot : feet) {
    for (size_t f = 0; lifts(foot) && f < clip.frames(); ++f) {
      if (foot.y[f] <= foot.low + begins.height * foot.range) way += foot.advance[f] * around(clip, f) / 2;
    }
  }
  for (size_t leg = 0; leg < legs; ++leg) {
    if (lifts(feet[leg])) markStance(clip, feet[leg], way > 0 ? -1 : 1, legs, leg);
  }

  std::vector<Stance> stances;
  double seconds = 0, height = 0, lowest = legs > 0 ? HUGE_VAL : 0;
  for (size_t leg = 0; leg < legs; ++leg) {
    const Foot& foot = feet[leg];
    lowest = std::min(lowest, foot.low);
    for (size_t f = 0; f + 1 < clip.frames(); ++f) {
      const double dt = static_cast<double>(clip.times[f + 1]) - static_cast<double>(clip.times[f]);
      if (!clip.stance[f * legs + leg] || !clip.stance[(f + 1) * legs + leg] || !(dt > 0)) continue;
      stances.push_back({(foot.z[f] - foot.z[f + 1]) / dt, dt});
      height += 0.5 * (foot.y[f] + foot.y[f + 1]) * dt;
      seconds += dt;
    }
  }
  const double speed = median(std::move(stances));
  clip.speed = std::fabs(speed) < leastSpeed * legLength ? 0.0f : static_cast<float>(speed);
  clip.ground = static_cast<float>(seconds > 0 ? height / seconds : lowest);
}

}  // namespace skitter
