#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "crowd/herd.h"
#include "crowd/stage_id.h"
#include "skitter/crowd.h"
#include "skitter/scene.h"
#include "validation/lockstep/rate_check.h"
#include "validation/replay.h"

// A whole crowd against the reference: the loop of `skitter validate` and of skitter.validate().
namespace skitter::validation {

// Throws Error(input) for a scene without agents, and for a stage that no herd of it has compared; `what` is
// where the stages were asked for, for the message.
void expectComparable(const Scene& scene, std::span<const crowd::StageId> stages, const char* what);

// Replays every herd of a crowd, size by size (crowd::allRuns), tick by tick. A crowd without
// CrowdOptions::footfalls leaves footfall out. Herds may come and go between end() and begin(), and by
// events.
class Lockstep {
 public:
  // The reference takes about a millisecond for an agent. Of more agents of one size in a herd every so
  // many-th one is compared, others in each tick.
  static constexpr uint32_t agentsATick = 1024;

  // Before the first tick, of `dt` seconds, of a crowd that was made of the scene, and that outlives this.
  // Compares the stages in `only`; empty: all.
  Lockstep(Crowd& crowd, const Scene& scene, float dt, std::vector<crowd::StageId> only = {});
  ~Lockstep();

  // To be called before a tick is recorded. What the scene has for that tick happens now; the states of what
  // is compared, size by size of the herds that are there (crowd::allRuns), then show what agents were told.
  const std::vector<HerdState>& begin();
  // Between begin() and the tick: as Crowd::editHeights.
  void edit(uint32_t x0, uint32_t z0, uint32_t columns, uint32_t rows, std::span<const float> heights);
  // To be called when the tick has finished; the states after it.
  const std::vector<HerdState>& end();

  // By stage, all sizes of herds that have places in one, also of herds that are gone; the worst gives a
  // stage's error. Messages name it, and agents by their numbers in the herd.
  std::vector<StageResult> results() const;
  // A sample of the herds that are there has failed already.
  bool hasRefused() const;

 private:
  // A herd's agents of one size.
  struct Compared {
    crowd::RunKey key;
    std::string name;
    bool hasPlaces;
    bool isBrief;  // it was not there from the first tick to the last
    std::unique_ptr<Replay> replay;
    uint32_t wayRevision = 0;  // of the fields or trails that the replay has
  };

  std::vector<HerdState> download() const;
  void letEventsHappen();
  void followHerds();
  void followWays();

  Crowd& crowd_;
  uint64_t seed_;
  std::vector<crowd::StageId> only_;
  uint32_t revision_ = 0;  // of the herds that are compared
  bool hasBegun_ = false;
  std::vector<AgentSample> samples_;  // of each size of each herd, in this tick
  std::vector<HerdState> before_, after_;
  Surroundings around_;
  std::optional<RateCheck> rates_;  // where there are levels of rate
  std::vector<Compared> compared_;  // those that are there, as crowd::allRuns
  std::vector<Compared> gone_;
};

}  // namespace skitter::validation
