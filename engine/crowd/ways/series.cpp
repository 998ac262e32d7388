#include "crowd/ways/series.h"

#include <algorithm>

#include "base/split_mix.h"
#include "shared/ways.h"

namespace skitter::crowd {
namespace {

constexpr size_t roamPlaces = 8;

// Agents of all speeds share a series.
Goal keyOf(Goal goal) {
  goal.speed = 0;
  goal.velocity = glm::vec2(0);
  return goal;
}

uint32_t endOf(const Series& series) { return series.first + static_cast<uint32_t>(series.places.size()); }

// The first of those that may come after the nth place, and how many they are.
glm::uvec2 nextOf(const Series& series, uint32_t n) {
  if (series.goal.kind == Goal::Kind::roam) return {series.first, series.places.size()};
  if (n + 1 < series.places.size()) return {series.first + n + 1, 1};
  return {series.first, series.goal.kind == Goal::Kind::route && series.goal.loop ? 1 : 0};
}

}  // namespace

bool isSeries(const Goal& goal) {
  using enum Goal::Kind;
  return goal.kind == route || goal.kind == roam || goal.kind == follow || goal.kind == flee;
}

const Series* findSeries(const SeriesTable& table, const Goal& goal) {
  const auto found = std::ranges::find(table, keyOf(goal), &Series::goal);
  return found == table.end() ? nullptr : &*found;
}

const Series* seriesAt(const SeriesTable& table, uint32_t number) {
  const auto has = [&](const Series& each) { return number >= each.first && number < endOf(each); };
  const auto found = std::ranges::find_if(table, has);
  return found == table.end() ? nullptr : &*found;
}

bool enlist(SeriesTable& table, const Goal& goal, std::vector<glm::vec2> places) {
  Series made{keyOf(goal), 0, std::move(places)};
  // The table is in the order of its numbers.
  auto at = table.begin();
  for (; at != table.end() && endOf(made) > at->first; ++at) made.first = endOf(*at);
  if (endOf(made) > uint32_t{shared::MOST_PLACES}) return false;
  table.insert(at, std::move(made));
  return true;
}

std::vector<glm::vec4> placesIn(const SeriesTable& table) {
  std::vector<glm::vec4> all(table.empty() ? 0 : endOf(table.back()), glm::vec4(0));
  for (const Series& series : table)
    for (uint32_t n = 0; n < series.places.size(); ++n)
      all[series.first + n] = {series.places[n], nextOf(series, n)};
  return all;
}

std::vector<glm::vec2> scattered(const Goal& goal, uint64_t seed) {
  base::SplitMix64 random(seed);
  std::vector<glm::vec2> places;
  while (places.size() < roamPlaces) {
    const double x = 2 * random.uniform() - 1, z = 2 * random.uniform() - 1;
    if (x * x + z * z < 1) places.push_back(goal.target + goal.radius * glm::vec2(x, z));
  }
  return places;
}

uint32_t firstPlaceOf(const Series& series, uint32_t draw) {
  if (series.goal.kind != Goal::Kind::roam) return series.first;
  return series.first + static_cast<uint32_t>(uint64_t{draw} * series.places.size() >> 24);
}

}  // namespace skitter::crowd
