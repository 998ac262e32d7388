#pragma once

#include <functional>
#include <vector>

#include "bench/crowd/contest.h"
#include "bench/crowd/turns.h"
#include "skitter/heightfield.h"
#include "skitter/scene.h"

namespace skitter::bench {

// A crowd in which agents have about ten others in reach, however many there are: a herd on flat ground, in
// rows, whose agents go where they like.
struct AvoidCrowd {
  Scene scene;
  Heightfield ground;
  double spacing = 0;  // metres between agents of a row
};
// With the rig of the first herd of `from`, and its seed. Throws Error(input) where the rig cannot be read.
AvoidCrowd avoidCrowdOf(const Scene& from, uint32_t agents);

// The device's grid and stage avoid against opponents who do the same, and against one that does it by the
// algorithm of van den Berg et al. 2011, all of the same agents as they are after some ticks of walking.
struct AvoidMatch {
  uint64_t agents = 0;
  double spacing = 0;                // of AvoidCrowd
  double density = 0;                // agents per footprint's area, as they began
  double inReach = 0;                // others, of an agent on average
  double keptClear = 0;              // of these, that it keeps clear of, on average
  std::vector<Result> results = {};  // the device's first
};

// Turn by turn in one run. Whose stage is the device's is held against the reference, of a sample of agents,
// and against the device, of all of them; whose answer is another one against what its method promises, of
// the sample. Ways of CPU time and stages as contest().
AvoidMatch avoidContest(Device&, const AvoidCrowd&, const ContestOptions&,
                        const std::function<void(double)>& step, const std::function<bool()>& stopped);

// How much more the last match's agents cost each than the first one's, of those who were in both, by
// CPU time where `cpu`, else by the wall's clock.
struct Growth {
  std::string name;
  uint64_t from = 0, to = 0;  // agents
  double ratio = 0;
};
std::vector<Growth> growthOf(const std::vector<AvoidMatch>& matches, bool cpu);

}  // namespace skitter::bench
