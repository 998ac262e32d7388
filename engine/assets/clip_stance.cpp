#include "clip_stance.h"

#include <algorithm>
#include <cmath>

namespace skitter {
namespace {

constexpr double leastRange = 0.02;                  // leg lengths: a foot that moves less up and down never lifts
constexpr double standHeight = 0.15, liftHeight = 0.3;  // shares of a foot's range
constexpr double standSpeed = 0.15, liftSpeed = 0.3;    // shares of its greatest speed forward
constexpr double leastSpeed = 0.05;                  // leg lengths a second: slower is standing

struct Foot {
  std::vector<double> y, z, velocity;  // along z
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
    foot.velocity.push_back(seconds > 0 ? (foot.z[after] - foot.z[before]) / seconds : 0);
  }
  foot.low = *std::min_element(foot.y.begin(), foot.y.end());
  foot.range = *std::max_element(foot.y.begin(), foot.y.end()) - foot.low;
  return foot;
}

}  // namespace

void findStance(Clip& clip, size_t legs, double legLength) {
  clip.stance.assign(clip.frames() * legs, 1);
  std::vector<Foot> feet;
  for (size_t leg = 0; leg < legs; ++leg) feet.push_back(footOf(clip, legs, leg));
  const auto lifts = [&](const Foot& foot) { return foot.range >= leastRange * legLength; };

  // Low feet go backward, unless the creature does.
  double path = 0;
  for (const Foot& foot : feet) {
    for (size_t f = 0; lifts(foot) && f < clip.frames(); ++f) {
      if (foot.y[f] < foot.low + liftHeight * foot.range) path += foot.velocity[f] * around(clip, f) / 2;
    }
  }
  const double forward = path > 0 ? -1 : 1;
  for (size_t leg = 0; leg < legs; ++leg) {
    const Foot& foot = feet[leg];
    if (!lifts(foot)) continue;
    double fast = 0;
    for (const double velocity : foot.velocity) fast = std::max(fast, forward * velocity);
    bool stands = false;
    for (size_t k = 0; k < 2 * clip.frames(); ++k) {
      const size_t f = k % clip.frames();
      const double height = foot.y[f] - foot.low, speed = forward * foot.velocity[f];
      stands = stands ? height <= liftHeight * foot.range && speed <= liftSpeed * fast
                      : height <= standHeight * foot.range && speed <= standSpeed * fast;
      clip.stance[f * legs + leg] = stands;
    }
  }

  double way = 0, seconds = 0, height = 0, lowest = legs > 0 ? HUGE_VAL : 0;
  for (size_t leg = 0; leg < legs; ++leg) {
    const Foot& foot = feet[leg];
    lowest = std::min(lowest, foot.low);
    for (size_t f = 0; f + 1 < clip.frames(); ++f) {
      if (!clip.stance[f * legs + leg] || !clip.stance[(f + 1) * legs + leg]) continue;
      const double dt = static_cast<double>(clip.times[f + 1]) - static_cast<double>(clip.times[f]);
      way += foot.z[f + 1] - foot.z[f];
      height += 0.5 * (foot.y[f] + foot.y[f + 1]) * dt;
      seconds += dt;
    }
  }
  const double speed = seconds > 0 ? -way / seconds : 0;
  clip.speed = std::fabs(speed) < leastSpeed * legLength ? 0.0f : static_cast<float>(speed);
  clip.ground = static_cast<float>(seconds > 0 ? height / seconds : lowest);
}

}  // namespace skitter
