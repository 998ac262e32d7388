#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "crowd/grid.h"
#include "crowd/herd.h"
#include "crowd/readback.h"
#include "validation/convert.h"
#include "validation/convert_forage.h"
#include "validation/replay.h"

// Apart from replay.h, which does without a device.
namespace skitter::validation {

// The fields of a kind. Waits for the device.
inline std::vector<reference::WayField> waysOf(const crowd::Kind& kind) {
  std::vector<reference::WayField> all;
  if (!kind.ways) return all;
  const CostGrid& grid = kind.ways->grid();
  for (const glm::vec2& goal : kind.ways->goals()) {
    const std::vector<float> times = kind.ways->times(goal);
    all.push_back({.goal = goal,
                   .stop = kind.ways->stopsAt(goal).stop,
                   .columns = grid.columns,
                   .rows = grid.rows,
                   .cell = grid.cell,
                   .origin = grid.origin,
                   .cost = {grid.cost.begin(), grid.cost.end()},
                   .times = {times.begin(), times.end()}});
  }
  return all;
}

// The places of goals in series that the kind has.
inline std::vector<reference::WayPlace> wayPlacesOf(const crowd::Kind& kind) {
  std::vector<reference::WayPlace> all;
  if (!kind.ways) return all;
  for (const glm::vec4& place : kind.ways->places())
    all.push_back({{place.x, place.y}, static_cast<size_t>(place.z), static_cast<size_t>(place.w)});
  return all;
}

// The facts of a kind whose herds forage, from the agent of that number on.
inline std::optional<ForageFacts> forageOf(const crowd::Kind& kind, int64_t firstNumber = 0) {
  if (!kind.trails) return {};
  const Forage& forage = kind.trails->forage();
  return ForageFacts{.map = forageMapOf(forage, kind.trails->grid()),
                     .tuning = forageTuningOf(forage, kind.trails->seed(), double{kind.parameters.dt}),
                     .firstNumber = firstNumber,
                     .agents = kind.agents};
}

inline reference::AvoidObstacle obstacleOf(const Disc& disc) {
  return {.corners = {disc.centre}, .radius = disc.radius};
}
inline reference::AvoidObstacle obstacleOf(const Capsule& capsule) {
  return {.corners = {capsule.from, capsule.to}, .radius = capsule.radius};
}
inline reference::AvoidObstacle obstacleOf(const ConvexPolygon& polygon) {
  return {.corners = {polygon.corners.begin(), polygon.corners.end()}};
}
inline std::vector<reference::AvoidObstacle> obstaclesOf(const Scene& scene) {
  std::vector<reference::AvoidObstacle> obstacles;
  for (const Obstacle& obstacle : scene.obstacles)
    obstacles.push_back(std::visit([](const auto& shape) { return obstacleOf(shape); }, obstacle.shape));
  return obstacles;
}

// The facts of a herd's kind. Call it once the tick length is known: the parameters are complete only then.
// The facts refer to the kind's rig.
inline HerdFacts herdFacts(const crowd::Kind& kind, const Heightfield& terrain) {
  HerdFacts facts{kind.rig, terrain,         kind.parameters, kind.rigRecords,
                  kind.ik,  kind.controller, kind.clips,      kind.keyPoses};
  facts.ways = waysOf(kind);
  facts.wayPlaces = wayPlacesOf(kind);
  facts.forage = forageOf(kind);
  facts.gaitMap = kind.gaitMap;
  return facts;
}

// The same of a herd's agents that have one size, who are replayed by themselves.
inline HerdFacts herdFacts(const Crowd::Impl& crowd, const crowd::HerdRun& of, const Heightfield& terrain) {
  const crowd::Kind& kind = crowd.kinds[of.run->kind];
  HerdFacts facts = herdFacts(kind, terrain);
  facts.firstAgent = of.run->firstOfHerd;
  facts.forage = forageOf(kind, of.run->firstAgent);
  if (!kind.avoids) return facts;
  const crowd::Quanta quanta = crowd::quantaOf(crowd);
  facts.avoid = {.quanta = quanta.inMetre,
                 .look = quanta.lookOf(kind),
                 .legLength = kind.parameters.legLength,
                 .obstacles = obstaclesOf(crowd.scene)};
  facts.firstNumber = crowd::numberOf(crowd, kind) + of.run->firstAgent;
  facts.firstInKind = of.run->firstAgent;
  return facts;
}

inline HerdFacts herdFacts(const Crowd::Impl& crowd, const crowd::HerdRun& of) {
  return herdFacts(crowd, of, crowd.terrain);
}

// Everybody as the last tick left them, where somebody avoids; else nobody. Waits for the device.
inline Surroundings surroundingsOf(const Crowd::Impl& crowd) {
  Surroundings all;
  if (!crowd::avoids(crowd)) return all;
  const crowd::Quanta quanta = crowd::quantaOf(crowd);
  constexpr std::array records = {Record::body};
  const std::vector<HerdState> states = crowd::downloadRecords(crowd, records);
  for (uint32_t h = 0; h < states.size(); ++h) {
    const HerdState& state = states[h];
    for (uint32_t agent = 0; agent < state.agents; ++agent) {
      const crowd::SizeRun& run = crowd.herds[h].runOf(agent);
      const crowd::Kind& kind = crowd.kinds[run.kind];
      const reference::AgentBody body = bodyOf(state, agent);
      const int64_t number = int64_t{crowd::numberOf(crowd, kind)} + run.firstAgent + agent - run.firstOfHerd;
      if (!body.absent)
        all.push_back(reference::walkerOf(body, number, quanta.radiusOf(kind), kind.avoids, quanta.inMetre));
    }
  }
  std::ranges::sort(all, {}, &reference::Walker::number);
  return all;
}

}  // namespace skitter::validation
