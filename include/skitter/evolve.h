#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "skitter/device.h"
#include "skitter/export.h"
#include "skitter/rig.h"

// The search for gaits of a creature some of whose legs do not carry (docs/evolve.md).
namespace skitter {

// Another shader for shaders/evolve/trial.comp, compiled once for each load path (skitter/crowd.h), for
// experiments. Empty: the built-in one.
struct TrialShader {
  std::span<const uint8_t> texel = {}, storage = {};
};

struct EvolutionOptions {
  static constexpr uint32_t maxBatch = 1 << 18;
  static constexpr float minDt = 1.0f / 240, maxDt = 1.0f / 20;

  uint64_t seed = 1;
  uint32_t batch = 4096;    // candidates that are tried at once, 1 to maxBatch; it changes what is found
  float dt = 1.0f / 60;     // seconds per tick of a trial, minDt to maxDt
  TrialShader shader = {};  // read while the search is made
};

// How a gait walked for some time, by measure (docs/stages/measure.md). Lengths in leg lengths.
struct GaitJudgement {
  uint32_t idle = 0;      // mask of the legs that do not carry
  double speed = 0;       // mean, leg lengths per second
  double unstable = 0;    // share of ticks without static stability
  double margin = 0;      // mean stability margin
  double slip = 0;        // per stance
  double reachError = 0;  // the largest
};

// How creatures walk that lack the legs of a pattern each, for `seconds` on flat ground; each wants to go at
// Evolution::wantedSpeed. They have the gaits of `rig`: those of its table (Rig::gaits), and the rule's for
// patterns that it leaves out. In a pattern of 0 all legs carry. Ticks last `dt`. Waits for the device.
// Throws Error(input) for seconds of more than 20 or not above 0, for a dt out of the range of
// EvolutionOptions, and as a crowd does (skitter/crowd.h).
SKITTER_API std::vector<GaitJudgement> judgeGaits(Device& device, const Rig& rig,
                                                  std::span<const uint32_t> patterns, double seconds,
                                                  float dt = 1.0f / 60);
// The same of creatures that go on in their own gait, with the legs that are left.
SKITTER_API std::vector<GaitJudgement> judgeUnadapted(Device& device, const Rig& rig,
                                                      std::span<const uint32_t> patterns, double seconds,
                                                      float dt = 1.0f / 60);

// How a creature came through a loss that it did not know of, by trial and error over the map.
struct AdaptationReport {
  uint32_t lost = 0;     // mask of legs
  double bestKnown = 0;  // fitness of the best gait that the map has for these
  double found = 0;      // of the best that was tried
  uint32_t trials = 0;   // up to the first with 90 % of bestKnown; 0: none had it
  uint32_t used = 0;     // in all, until it thought that it had found a good one, or had tried 20
};

// One search, on one device. Not thread-safe. The same rig, options and batches give the same bits on a
// device, whether or not the search was stopped in between.
class SKITTER_API Evolution {
 public:
  // Leg lengths per second that creatures in trials want to go.
  static constexpr double wantedSpeed = 1.5;

  // Throws Error(input) for options out of their range and for a rig without a pattern to search, else as a
  // crowd does (skitter/crowd.h).
  Evolution(Device& device, const Rig& rig, const EvolutionOptions& options = {});
  // Goes on from the text of map(); `name` begins messages. The seed, batch and dt are the map's. Throws
  // Error(input), too, where it is damaged or another rig's.
  Evolution(Device& device, const Rig& rig, const std::string& map, const std::string& name,
            const TrialShader& shader = {});
  ~Evolution();
  Evolution(Evolution&&) noexcept;
  Evolution& operator=(Evolution&&) noexcept;

  // Draws a batch, tries it and lets it enter the map. Waits for the device.
  void step();

  const EvolutionOptions& options() const;
  uint64_t evaluations() const;   // so far, whole batches
  uint32_t patternCount() const;  // that are searched
  uint64_t cellCount() const;     // of the map
  uint64_t filledCount() const;   // cells with an elite
  double seconds() const;         // simulated of each trial
  // The best of each pattern, by pattern, those without a fitness left out: Rig::gaits.
  std::vector<RigGait> gaits() const;
  // The whole search as JSON, with which another one can go on.
  std::string map() const;

  // Creatures that lose one to three legs each, drawn by the seed, and are not told which: each tries gaits
  // of the map, of any pattern, at most 20 of them. Losses for which the map has no gait are left out. Waits
  // for the device.
  std::vector<AdaptationReport> adapt(uint32_t creatures, uint64_t seed) const;

  struct SKITTER_LOCAL Impl;

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace skitter
