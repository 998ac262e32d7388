#pragma once

#include <cstdint>

namespace skitter::app {

// How many ticks a frame of a window makes.
class Pace {
 public:
  // `ticksPerFrame` at speed 1.
  Pace(double ticksPerFrame, bool paused) : ticksPerFrame_(ticksPerFrame), paused_(paused) {}

  void pause() { paused_ = !paused_; }
  void step();  // one tick, and pauses
  void faster();
  void slower();
  void forget();  // what is due

  bool paused() const { return paused_; }
  double speed() const;  // 1/16, 1/8, .. 16
  // Ticks of the next frame.
  uint64_t ticks();

 private:
  static constexpr int most_ = 4;
  double ticksPerFrame_;
  bool paused_;
  int doublings_ = 0;
  uint64_t steps_ = 0;
  double owed_ = 0;  // of a tick, less than 1
};

}  // namespace skitter::app
