#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "skitter/scene.h"

// Goals in series: of kinds route, roam, follow and flee (docs/ways.md).
namespace skitter::crowd {

// A goal, and its places in the table of its agents' kind, where they have numbers from `first` on.
struct Series {
  Goal goal;  // without its speed
  uint32_t first = 0;
  std::vector<glm::vec2> places;  // as they are now

  bool operator==(const Series&) const = default;
};
using SeriesTable = std::vector<Series>;

bool isSeries(const Goal& goal);

// nullptr where the table has no such goal; where no place has that number.
const Series* findSeries(const SeriesTable& table, const Goal& goal);
const Series* seriesAt(const SeriesTable& table, uint32_t number);

// Whether the goal found room for its places, of which all goals together have shared::MOST_PLACES.
bool enlist(SeriesTable& table, const Goal& goal, std::vector<glm::vec2> places);

// Their places as the device has them (WAY_PLACES in shaders/shared/ways.h).
std::vector<glm::vec4> placesIn(const SeriesTable& table);

// The places of kind roam, by a seed.
std::vector<glm::vec2> scattered(const Goal& goal, uint64_t seed);

// The number of the place that an agent begins with.
uint32_t firstPlaceOf(const Series& series, uint32_t draw);

}  // namespace skitter::crowd
