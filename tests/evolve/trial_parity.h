#pragma once

#include <string>
#include <vector>

#include "evolve/trials.h"

namespace skitter::test {

// Rigs, patterns and gaits that differ in every way, drawn by the seed.
std::vector<evolve::TrialTask> drawnTasks(const Rig& rig, uint32_t count, uint64_t seed);

// Empty, or in what the device's records and the reference's first differ: over two trials, of which each
// settles for some ticks and is then sampled so often. The reference takes each step from the device's
// record.
std::string differenceOf(evolve::Trials& trials, const std::vector<evolve::TrialTask>& tasks, uint32_t settle,
                         uint32_t samples);

}  // namespace skitter::test
