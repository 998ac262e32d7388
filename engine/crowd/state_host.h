#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "crowd/herd.h"
#include "crowd/state_head.h"

// A state keeps what the host knows of a crowd. Each `...Of` reads it for a state, and each `give...` puts it
// back.
namespace skitter::crowd {

// The checksum covers all that the simulation knows of a kind's rig and its clips. The records are of no use
// with others.
uint32_t fingerprintOf(const Kind& kind);
std::vector<uint32_t> fingerprintsOf(const std::vector<Kind>& kinds);

// There is one for each of the kind's places.
std::vector<uint32_t> generationsOf(const Crowd::Impl& crowd, uint32_t kind);
// It is true where everybody is there who was there at first, and nobody else.
bool isFirstGeneration(const Crowd::Impl& crowd, uint32_t kind);
void giveGenerations(Crowd::Impl& crowd, uint32_t kind, std::span<const uint32_t> all);

std::vector<StateChange> changesOf(const Kind& kind);
void giveChanges(const std::vector<StateChange>& all, Kind& kind);

std::vector<StateThreat> threatsOf(const Crowd::Impl& crowd);
void giveThreats(const std::vector<StateThreat>& all, Crowd::Impl& crowd);

std::vector<StateSeries> seriesOf(const Crowd::Impl& crowd);
void giveSeries(const std::vector<StateSeries>& all, Crowd::Impl& crowd);

// Damage and loads come from the records, or from the changes that wait to be written.
void giveDamages(const Crowd::Impl& crowd, const std::vector<StateChange>& waiting, Kind& kind);

}  // namespace skitter::crowd
