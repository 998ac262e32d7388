#pragma once

#include <cstdint>
#include <optional>

#include "app/run/damage.h"
#include "app/run/obstacle.h"
#include "gpu/submit.h"
#include "skitter/crowd.h"
#include "skitter/device.h"

namespace skitter::app {

// Looks at the agents of a run whose legs are hurt, from two seconds after its events have hurt the last one
// on. A second crowd, which nobody hurts, says how fast they would be; it costs as much as the first. Waits
// for the device after each tick. The crowd has feet.
class DamageWatch {
 public:
  // Whether the scene's events hurt legs.
  static bool isOf(const Scene& scene);

  // Of a crowd that begins. `options` are its own.
  DamageWatch(Device& device, const Heightfield& terrain, const Scene& scene, const CrowdOptions& options,
              double dt, const std::optional<Obstacle>& obstacle);
  // Of one that goes on from a state: what it would be without damage is not known.
  DamageWatch(Device& device, const Scene& scene, double dt);

  // After each tick, before anything is said for the next one.
  void look(const Crowd& crowd);
  DamageFigures figures() const { return tally_.figures(); }

 private:
  void stepWhole();
  void lookAt(const Crowd& crowd, uint32_t herd);

  double dt_;
  uint64_t since_;  // the first tick that counts
  gpu::CommandRing ring_;
  std::optional<Crowd> whole_;
  std::optional<Obstacle> obstacle_;  // in the way of `whole_`
  DamageTally tally_;
};

}  // namespace skitter::app
