#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "crowd/herd.h"

namespace skitter::crowd {

// Each waits for the device.

// Of what Crowd::download gives, those records alone and how many agents there are.
HerdState downloadRecords(const Crowd::Impl& crowd, uint32_t herd, std::span<const Record> records,
                          const AgentSample& sample = {});

// The same of every herd, with one submission. The sample is of each herd.
std::vector<HerdState> downloadRecords(const Crowd::Impl& crowd, std::span<const Record> records,
                                       const AgentSample& sample = {});

// How many of the run's places somebody was in, in the last tick.
uint32_t presentIn(const Crowd::Impl& crowd, const SizeRun& run);

// As Crowd::download, of a herd's agents that have one size; they are counted from 0.
HerdState download(const Crowd::Impl& crowd, const SizeRun& run, const AgentSample& sample = {});
// The same of several runs at once, a sample for each or none: all agents.
std::vector<HerdState> download(const Crowd::Impl& crowd, std::span<const HerdRun> runs,
                                std::span<const AgentSample> samples = {});

}  // namespace skitter::crowd
