#include "crowd/ways/ways.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <utility>
#include <variant>

#include "crowd/page.h"
#include "crowd/radius.h"
#include "crowd/readback.h"
#include "crowd/spawn.h"
#include "crowd/ways/cost_grid.h"
#include "crowd/ways/look.h"
#include "gpu/context.h"
#include "gpu/transfer.h"
#include "skitter/crowd.h"
#include "skitter/error.h"

namespace skitter {
namespace crowd {
namespace {

using Targets = std::vector<glm::vec2>;

void addOnce(Targets& targets, const glm::vec2& target) {
  if (std::ranges::find(targets, target) == targets.end()) targets.push_back(target);
}

Traveller travellerOf(const Kind& kind) {
  return {.legLength = kind.rig.legLength,
          .footprint = footprintRadius(kind.rig),
          .margin = kind.parameters.edgeMargin,
          .ways = kind.wayfaring->ways};
}

CostGrid groundFor(const Crowd::Impl& crowd, const Kind& kind) {
  return costGrid(crowd.terrain, crowd.scene.obstacles, travellerOf(kind));
}

// The kind's ground where heights wait to be edited.
void renewGround(const Crowd::Impl& crowd, Kind& kind) {
  for (const HeightEdits::Rectangle& samples : crowd.edits.pending())
    renewCosts(kind.ground, crowd.terrain, crowd.scene.obstacles, travellerOf(kind),
               cellsOver(kind.ground, crowd.terrain, samples));
}

CostGrid gridFor(const Crowd::Impl& crowd, const Kind& kind) {
  CostGrid grid = kind.ground;
  keepOff(grid, threatsTo(crowd, kind), travellerOf(kind));
  return grid;
}

// The places of a goal in series. One who cannot be seen is followed to the origin until he can.
Targets placesFor(const Crowd::Impl& crowd, const Spawner& spawner, const Goal& goal) {
  if (goal.kind == Goal::Kind::flee) return {glm::vec2(shared::WAY_OUT)};
  if (goal.kind == Goal::Kind::follow) return {leaderOf(crowd, goal).value_or(glm::vec2(0))};
  Targets places = goal.kind == Goal::Kind::roam ? scattered(goal, crowd.seed) : goal.places;
  for (glm::vec2& place : places) place = spawner.within(place);
  return places;
}

// Adds the targets of a goal, as records will have them, and to the table its series; whether that has room.
bool addGoal(const Crowd::Impl& crowd, const Spawner& spawner, const Goal& goal, SeriesTable& table,
             Targets& targets) {
  if (goal.kind == Goal::Kind::point) addOnce(targets, spawner.within(goal.target));
  if (!isSeries(goal)) return true;
  if (findSeries(table, goal) == nullptr && !enlist(table, goal, placesFor(crowd, spawner, goal)))
    return false;
  for (const glm::vec2& place : findSeries(table, goal)->places) addOnce(targets, place);
  return true;
}

// Calls each(goal) for events that are about the herd of that number, whichever herd has it then.
template <class Each>
void eachEventGoal(const Crowd::Impl& crowd, uint32_t herd, const Each& each) {
  for (const Event& event : crowd.events) {
    if (const auto* change = std::get_if<GoalChange>(&event.what); change && change->herd == herd)
      each(change->goal);
    if (const auto* addition = std::get_if<Addition>(&event.what); addition && addition->herd == herd)
      for (const Addition::Arrival& arrival : addition->arrivals)
        if (arrival.goal) each(*arrival.goal);
  }
}

// Calls each(goal record) for the goals that agents of the kind have, or will have in the next tick.
template <class Each>
void eachGoalRecord(const Crowd::Impl& crowd, const Kind& kind, const Each& each) {
  constexpr auto floats = static_cast<size_t>(4 * shared::GOAL_STRIDE);
  for (const Page& page : kind.pages) {
    const std::vector<float> goals = gpu::download<float>(*crowd.context, page.goal);
    for (size_t agent = 0; agent < page.agents; ++agent)
      each(std::span(goals).subspan(agent * floats, floats));
  }
  for (const AgentChange& change : kind.changes.all())
    if (change.goal) each(std::span<const float>(change.record));
}

// The goals that agents of the kind have, or will have in the next tick.
struct Use {
  Targets points;  // of kind point
  SeriesTable series;

  Targets targets() const {
    Targets all = points;
    for (const Series& each : series)
      for (const glm::vec2& place : each.places) addOnce(all, place);
    return all;
  }
};
Use useOf(const Crowd::Impl& crowd, const Kind& kind) {
  Use use;
  std::vector<bool> isUsed(kind.series.size(), false);
  eachGoalRecord(crowd, kind, [&](std::span<const float> goal) {
    if (goal[6] == shared::GOAL_POINT) addOnce(use.points, {goal[0], goal[1]});
    if (goal[6] != shared::GOAL_SERIES) return;
    if (const Series* series = seriesAt(kind.series, static_cast<uint32_t>(goal[2])))
      isUsed[static_cast<size_t>(series - kind.series.data())] = true;
  });
  for (size_t i = 0; i < isUsed.size(); ++i)
    if (isUsed[i]) use.series.push_back(kind.series[i]);
  return use;
}

// The stages that read fields are bound to them where they are now.
void rebind(const Crowd::Impl& crowd, Kind& kind) {
  const auto reads = [](const gpu::BindingDecl& declared) { return declared.binding == shared::BINDING_WAY; };
  for (size_t i = 0; i < kind.stages.size(); ++i) {
    if (std::ranges::none_of(kind.stages[i].bindings, reads)) continue;
    for (Page& page : kind.pages) page.bindings[i] = bindingsOf(crowd, kind, page, kind.stages[i]);
  }
}

// Calls `change` with the kind's fields, and binds them anew where they have moved.
template <class Change>
void changeWays(const Crowd::Impl& crowd, Kind& kind, const Change& change) {
  crowd.context->waitIdle();
  const uint32_t moves = kind.ways->moves();
  change(*kind.ways);
  if (kind.ways->moves() != moves) rebind(crowd, kind);
}

// As many of `targets` as have no field and find room beside those of `kept`.
Targets fitting(const WayFields& ways, const Targets& targets, const Targets& kept) {
  size_t room = shared::MOST_WAYS;
  for (const glm::vec2& target : kept) room -= std::min<size_t>(room, ways.has(target));
  Targets fresh;
  for (const glm::vec2& target : targets)
    if (!ways.has(target) && fresh.size() < room) fresh.push_back(target);
  return fresh;
}

}  // namespace

void beginWays(Crowd::Impl& crowd, uint32_t k, bool isNew) {
  Kind& kind = crowd.kinds[k];
  if (!kind.findsWay()) return;
  kind.ground = groundFor(crowd, kind);
  kind.ways = std::make_unique<WayFields>(*crowd.context, gridFor(crowd, kind));
  const std::vector<HerdRun> runs = runsOf(crowd, k);
  const auto add = [&](const HerdRun& of, const Goal& goal, Targets& targets) {
    if (!isNew && isSeries(goal)) return true;  // those in use will follow
    return addGoal(crowd, spawnerOf(crowd, *of.herd, *of.run), goal, kind.series, targets);
  };
  Targets targets;
  for (const HerdRun& of : runs)
    if (!add(of, of.herd->from.goal, targets) || (isNew && targets.size() > shared::MOST_WAYS))
      throw inputError(
          fmt::format("{}: herd {}: its goal, and those of herds like it, are more than {} places that ways "
                      "lead to, expected at most as many",
                      crowd.scene.name, of.number, shared::MOST_WAYS));
  for (const HerdRun& of : runs)
    eachEventGoal(crowd, of.number, [&](const Goal& goal) { add(of, goal, targets); });
  kind.ways->setPlaces(placesIn(kind.series));
  kind.ways->add(fitting(*kind.ways, targets, {}), {});
}

void leadTo(Crowd::Impl& crowd, const Herd& herd, const SizeRun& run, std::span<const Goal> goals,
            const std::function<std::string()>& name) {
  Kind& kind = crowd.kinds[run.kind];
  if (!kind.ways) return;
  const Spawner spawner = spawnerOf(crowd, herd, run);
  SeriesTable table = kind.series;
  Targets targets;
  const auto add = [&](const Goal& goal) { return addGoal(crowd, spawner, goal, table, targets); };
  if (!std::ranges::all_of(goals, add)) {
    // Those that nobody has any more make room.
    crowd.context->waitIdle();
    table = useOf(crowd, kind).series;
    targets.clear();
    if (!std::ranges::all_of(goals, add))
      throw inputError(
          fmt::format("{}: its goals in series, and those of agents like it, have more than {} "
                      "places, expected at most as many",
                      name(), shared::MOST_PLACES));
  }
  const auto isNew = [&](const glm::vec2& target) { return !kind.ways->has(target); };
  if (table == kind.series && std::ranges::none_of(targets, isNew)) return;
  Targets kept = targets;
  if (kind.ways->goals().size() + targets.size() > shared::MOST_WAYS) {
    crowd.context->waitIdle();
    for (const glm::vec2& target : useOf(crowd, kind).targets()) addOnce(kept, target);
  }
  const Targets fresh = fitting(*kind.ways, targets, kept);
  if (fresh.size() < static_cast<size_t>(std::ranges::count_if(targets, isNew)))
    throw inputError(
        fmt::format("{}: its goals, and those of agents like it, are more than {} places that "
                    "ways lead to, expected at most as many",
                    name(), shared::MOST_WAYS));
  changeWays(crowd, kind, [&](WayFields& ways) {
    ways.setPlaces(placesIn(table));
    ways.add(fresh, kept);
  });
  kind.series = std::move(table);
}

void leadEverybody(Crowd::Impl& crowd) {
  for (Kind& kind : crowd.kinds) {
    if (!kind.ways) continue;
    const Targets targets = useOf(crowd, kind).targets();
    const Targets fresh = fitting(*kind.ways, targets, targets);
    if (!fresh.empty()) changeWays(crowd, kind, [&](WayFields& ways) { ways.add(fresh, targets); });
  }
}

namespace {

void renewGrids(Crowd::Impl& crowd) {
  const bool edited = !crowd.edits.empty(), threatened = threatsHaveMoved(crowd);
  if (!edited && !threatened) return;
  for (Kind& kind : crowd.kinds) {
    if (!kind.ways) continue;
    if (edited) renewGround(crowd, kind);
    CostGrid grid = gridFor(crowd, kind);
    if (grid == kind.ways->grid()) continue;
    changeWays(crowd, kind, [&](WayFields& ways) { ways.setGrid(std::move(grid)); });
  }
}

bool isFollowing(const Series& series) { return series.goal.kind == Goal::Kind::follow; }

// Moves the places of leaders whom somebody follows, and forgets the others.
void followLeaders(const Crowd::Impl& crowd, Kind& kind) {
  crowd.context->waitIdle();
  Use use = useOf(crowd, kind);
  SeriesTable table;
  for (const Series& series : kind.series)
    if (!isFollowing(series) || std::ranges::find(use.series, series) != use.series.end())
      table.push_back(series);
  Targets left;
  for (Series& series : table) {
    if (!isFollowing(series)) continue;
    const std::optional<glm::vec2> place = leaderOf(crowd, series.goal);
    if (!place || *place == series.places[0]) continue;
    left.push_back(std::exchange(series.places[0], *place));
  }
  if (table == kind.series) return;
  kind.series = std::move(table);
  for (Series& series : use.series) series.places = findSeries(kind.series, series.goal)->places;
  const Targets kept = use.targets();
  changeWays(crowd, kind, [&](WayFields& ways) {
    ways.setPlaces(placesIn(kind.series));
    // A field that nobody needs any more becomes that of a new place.
    Targets fresh = fitting(ways, kept, kept);
    for (const glm::vec2& from : left) {
      if (fresh.empty() || std::ranges::find(kept, from) != kept.end() || !ways.has(from)) continue;
      ways.move(from, fresh.back());
      fresh.pop_back();
    }
    if (!fresh.empty()) ways.add(fresh, kept);
  });
}

}  // namespace

void keepWays(Crowd::Impl& crowd) {
  renewGrids(crowd);
  if (!isTimeToLook(crowd)) return;
  for (Kind& kind : crowd.kinds)
    if (kind.ways && std::ranges::any_of(kind.series, isFollowing)) followLeaders(crowd, kind);
}

}  // namespace crowd

uint32_t Crowd::cannotReach(uint32_t herd) const {
  constexpr std::array records = {Record::goal, Record::body};
  const crowd::Herd& of = impl_->herdAt(herd);
  const bool findWays = std::ranges::any_of(
      of.runs, [&](const crowd::SizeRun& run) { return impl_->kinds[run.kind].ways != nullptr; });
  if (!findWays) return 0;
  const HerdState state = crowd::downloadRecords(*impl_, herd, records);
  uint32_t count = 0;
  for (uint32_t agent = 0; agent < of.agents; ++agent) {
    const crowd::WayFields& ways = *impl_->kinds[of.runOf(agent).kind].ways;
    const float* goal = &state.goal[size_t{agent} * 4 * shared::GOAL_STRIDE];
    const float* body = &state.body[size_t{agent} * 4 * shared::BODY_STRIDE];
    const bool isLed = goal[6] == shared::GOAL_POINT || goal[6] == shared::GOAL_SERIES;
    if (!of.presence.has(agent) || !isLed || goal[0] == shared::WAY_OUT || !ways.has({goal[0], goal[1]}))
      continue;
    const uint32_t region = ways.regions().of[crowd::cellAt(ways.grid(), crowd::placeOf(body))];
    // An agent in an obstacle gets out of it, nobody knows where, as long as there is anything outside.
    const bool leadsNowhere = ways.regions().count == 0;
    if (region == crowd::Regions::none && !leadsNowhere) continue;
    count += leadsNowhere || region != ways.stopsAt({goal[0], goal[1]}).region;
  }
  return count;
}

}  // namespace skitter
