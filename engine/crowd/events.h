#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "skitter/crowd.h"

// What a scene says happens while its crowd runs (Scene::events).
namespace skitter::crowd {

// Throws Error(input) that names the event where the terrain has no such place.
void checkEvents(const Scene& scene, const Heightfield& terrain);

// Those that happen just before a tick, counted from 1, of `dt` seconds. `events` are by time.
std::span<const Event> eventsAt(std::span<const Event> events, uint64_t tick, double dt);

// The samples of the ground that an event changes; none where it lies beyond the map.
struct Rectangle {
  uint32_t x = 0, z = 0, columns = 0, rows = 0;
};
Rectangle groundOf(const Event& event, const Heightfield& terrain);

void happen(const Event& event, Crowd& crowd);

}  // namespace skitter::crowd
