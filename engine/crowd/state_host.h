#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "crowd/herd.h"
#include "crowd/state_head.h"

// What the host knows of a crowd, to a state and back.
namespace skitter::crowd {

// Of all that the simulation knows of a kind's rig and its clips: what the records are of no use without.
uint32_t fingerprintOf(const Kind& kind);
std::vector<uint32_t> fingerprintsOf(const std::vector<Kind>& kinds);

// Of each of the kind's places.
std::vector<uint32_t> generationsOf(const Crowd::Impl& crowd, uint32_t kind);
// Whether everybody is there who was there at first, and nobody else.
bool isFirstGeneration(const Crowd::Impl& crowd, uint32_t kind);
void giveGenerations(Crowd::Impl& crowd, uint32_t kind, std::span<const uint32_t> all);

std::vector<StateChange> changesOf(const Kind& kind);
void giveChanges(const std::vector<StateChange>& all, Kind& kind);

std::vector<StateThreat> threatsOf(const Crowd::Impl& crowd);
void giveThreats(const std::vector<StateThreat>& all, Crowd::Impl& crowd);

std::vector<StateSeries> seriesOf(const Crowd::Impl& crowd);
void giveSeries(const std::vector<StateSeries>& all, Crowd::Impl& crowd);

// Damage and loads, as the records have them or as wait to be written.
void giveDamages(const Crowd::Impl& crowd, const std::vector<StateChange>& waiting, Kind& kind);

}  // namespace skitter::crowd
