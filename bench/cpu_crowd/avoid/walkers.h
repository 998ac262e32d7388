#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "bench/cpu_crowd/crowd.h"

// The opponents of the engine's grid and its stage avoid (docs/stages/avoid.md), and of both the algorithm of
// van den Berg et al. 2011.
namespace skitter::cpu_avoid {

// What the stage is given: all agents as the last tick left them, by their numbers. All of them are there,
// and have legs of one length. Each vector has a number for each agent.
struct Walkers {
  float quanta = 1024;   // in a metre
  int32_t look = 0;      // quanta beyond footprints
  float legLength = 1;   // metres
  float dt = 1.0f / 60;  // of a tick, seconds
  int64_t tick = 1;      // of the crowd, which decides whose turn it is
  int round = 1;         // ticks for which a velocity holds

  std::vector<float> tileX, tileZ, localX, localZ;  // of the body
  std::vector<float> headingX, headingZ, speed;     // of the body, m/s
  std::vector<float> wantedX, wantedZ;              // navigate's velocity, m/s
  std::vector<int32_t> radius;                      // of the footprint, quanta, at least 1
  std::vector<float> share;  // of a change that others take beside it: 0.5 where it avoids, else 1

  size_t size() const { return speed.size(); }
};

// Computes velocities that keep clear, in each tick anew from the same walkers.
class Avoider {
 public:
  explicit Avoider(size_t agents) : records_(4 * agents) {}
  virtual ~Avoider() = default;
  Avoider(const Avoider&) = delete;
  Avoider& operator=(const Avoider&) = delete;

  // One of so many parts looks around, which together are everybody. Allocates nothing. The number of threads
  // does not change a bit of the result.
  virtual void tick(size_t part, size_t parts) = 0;
  void tick() { tick(0, 1); }
  // Whether ticks from now on are timed stage by stage, at first not.
  void timeStages(bool on) { timed_ = on; }
  // Of all ticks so timed.
  virtual std::vector<cpu_crowd::StageSeconds> stageSeconds() const = 0;

  // Four floats an agent, as the avoid record has them: velocity x, z (m/s), minus the agents in reach, the
  // most speed along the heading (m/s); of the algorithm of the paper 0 and neighbours.
  const std::vector<float>& records() const { return records_; }
  // So that a tick that computes nothing is found out.
  void forget() { records_.assign(records_.size(), std::numeric_limits<float>::quiet_NaN()); }

 protected:
  std::vector<float> records_;
  bool timed_ = false;
};

// The walkers outlive what is made of them; `threads` is at least 1, the caller's among them.
//
// The engine's own: the same grid, and the same quadratic program with soft half-planes.
std::unique_ptr<Avoider> softAvoider(const Walkers& walkers, cpu_crowd::Width width, int threads);
// The paper's: a k-d tree, the ten nearest and linear programs (orca.h).
std::unique_ptr<Avoider> orcaAvoider(const Walkers& walkers, int threads);

}  // namespace skitter::cpu_avoid
