#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "crowd/kinds.h"
#include "skitter/crowd.h"

// What a scene says happens while its crowd runs (Scene::events).
namespace skitter::crowd {

// All that can be known before the crowd runs, which begins with the scene's herds, of those kinds: throws
// Error(input) that names the event where the terrain has no such place, no herd of that number is there by
// then, the herd has no such agent, a herd cannot come or go, or a number is out of its range. The files of
// herds that come are not read. Returns the most places that herds have at a time.
uint64_t checkEvents(const Scene& scene, const Heightfield& terrain, const Kinds& kinds);

// The tick before which an event happens, counted from 1, of `dt` seconds.
uint64_t tickOf(const Event& event, double dt);

// Those that happen just before a tick, counted from 1, of `dt` seconds. `events` are by time.
std::span<const Event> eventsAt(std::span<const Event> events, uint64_t tick, double dt);

// The samples of the ground that an event changes; none where it lies beyond the map or is about agents.
struct Rectangle {
  uint32_t x = 0, z = 0, columns = 0, rows = 0;
};
Rectangle groundOf(const Event& event, const Heightfield& terrain);

// Whether it names agents by number, whom a herd of fewer agents may not have.
bool namesAgents(const Event& event);

// The scene's events before the next tick happen, as if the host did it all now; Crowd::record does not
// repeat them. The length of a tick is known (setTick). Throws Error(input) that names the event where a herd
// or an agent is not there or no place is left; then none of them has happened. Throws Error(device) where
// memory does not suffice for a herd; then those before that event have happened, and the next call goes on
// with it.
void letEventsHappen(Crowd& crowd);

}  // namespace skitter::crowd
