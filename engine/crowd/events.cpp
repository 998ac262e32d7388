#include "crowd/events.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "skitter/error.h"

namespace skitter::crowd {
namespace {

// The samples of one side within `radius` of a place.
struct Side {
  uint32_t first, count;
};
Side sideOf(float place, float radius, float origin, float spacing, uint32_t samples) {
  const double first = std::ceil((double{place} - radius - origin) / spacing);
  const double last = std::floor((double{place} + radius - origin) / spacing);
  const double from = std::max(first, 0.0), to = std::min(last, static_cast<double>(samples) - 1);
  return to < from ? Side{0, 0} : Side{static_cast<uint32_t>(from), static_cast<uint32_t>(to - from) + 1};
}

Rectangle rectangleOf(const Mound& mound, const Heightfield& terrain) {
  const Side columns =
      sideOf(mound.centre.x, mound.radius, terrain.originX(), terrain.spacingX, terrain.columns);
  const Side rows = sideOf(mound.centre.y, mound.radius, terrain.originZ(), terrain.spacingZ, terrain.rows);
  if (columns.count == 0 || rows.count == 0) return {};
  return {columns.first, rows.first, columns.count, rows.count};
}
Rectangle rectangleOf(const HeightSamples& samples, const Heightfield&) {
  return {samples.x, samples.z, samples.columns, samples.rows};
}

std::vector<float> heightsOf(const Mound& mound, const Rectangle& at, const Heightfield& terrain) {
  std::vector<float> heights;
  for (uint32_t row = at.z; row < at.z + at.rows; ++row)
    for (uint32_t column = at.x; column < at.x + at.columns; ++column) {
      const glm::vec2 place(terrain.originX() + static_cast<float>(column) * terrain.spacingX,
                            terrain.originZ() + static_cast<float>(row) * terrain.spacingZ);
      const glm::vec2 away = (place - mound.centre) / mound.radius;
      const float inside = std::max(0.0f, 1 - glm::dot(away, away));
      heights.push_back(terrain.heights[size_t{row} * terrain.columns + column] +
                        mound.height * inside * inside);
    }
  return heights;
}
std::vector<float> heightsOf(const HeightSamples& samples, const Rectangle&, const Heightfield&) {
  return samples.heights;
}

// The first tick that ends at that time or later. A time that is a whole number of ticks may be a little more
// or less in float32.
uint64_t tickOf(const Event& event, double dt) {
  return static_cast<uint64_t>(std::max(1.0, std::ceil(double{event.at} / dt - 1e-3)));
}

// As Heightfield::edit will.
void check(const HeightSamples& edit, const std::string& event, const Heightfield& terrain) {
  const auto& [x, z, columns, rows, heights] = edit;
  if (uint64_t{x} + columns > terrain.columns || uint64_t{z} + rows > terrain.rows)
    throw inputError(fmt::format("{}.edit: {} x {} samples at {}, {}, expected some of the {} x {} of {}", event,
                                 columns, rows, x, z, terrain.columns, terrain.rows, terrain.name));
  if (heights.size() != uint64_t{columns} * rows)
    throw inputError(
        fmt::format("{}.edit: {} heights, expected {}", event, heights.size(), uint64_t{columns} * rows));
  if (!std::ranges::all_of(heights, [](float height) { return std::isfinite(height); }))
    throw inputError(fmt::format("{}.edit: a height is not finite", event));
}

}  // namespace

void checkEvents(const Scene& scene, const Heightfield& terrain) {
  for (size_t e = 0; e < scene.events.size(); ++e) {
    const Event& event = scene.events[e];
    const std::string name = fmt::format("{}: events[{}]", scene.name, e);
    if (!(event.at >= 0 && event.at <= Event::maxTime))
      throw inputError(fmt::format("{}.at is {}, expected 0 to {} s", name, event.at, Event::maxTime));
    if (e > 0 && event.at < scene.events[e - 1].at)
      throw inputError(fmt::format("{}.at is {}, expected {} or later, as the event before it", name,
                                   event.at, scene.events[e - 1].at));
    if (const auto* mound = std::get_if<Mound>(&event.what))
      if (!(mound->radius > 0 && std::isfinite(mound->radius) && std::isfinite(mound->height) &&
            std::isfinite(mound->centre.x) && std::isfinite(mound->centre.y)))
        throw inputError(fmt::format("{}.mound: expected a radius above 0, and finite numbers", name));
    if (const auto* samples = std::get_if<HeightSamples>(&event.what)) check(*samples, name, terrain);
  }
}

std::span<const Event> eventsAt(std::span<const Event> events, uint64_t tick, double dt) {
  const auto byTick = [&](const Event& event) { return tickOf(event, dt); };
  const auto found = std::ranges::equal_range(events, tick, {}, byTick);
  return {found.begin(), found.end()};
}

Rectangle groundOf(const Event& event, const Heightfield& terrain) {
  return std::visit([&](const auto& what) { return rectangleOf(what, terrain); }, event.what);
}

void happen(const Event& event, Crowd& crowd) {
  const Rectangle at = groundOf(event, crowd.terrain());
  if (at.columns == 0) return;
  const std::vector<float> heights =
      std::visit([&](const auto& what) { return heightsOf(what, at, crowd.terrain()); }, event.what);
  crowd.editHeights(at.x, at.z, at.columns, at.rows, heights);
}

}  // namespace skitter::crowd
