#include "crowd/ways/ways.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <variant>

#include "crowd/page.h"
#include "crowd/radius.h"
#include "crowd/readback.h"
#include "crowd/spawn.h"
#include "crowd/ways/threats.h"
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

bool isLed(std::span<const float> goal) { return goal[6] == shared::GOAL_POINT; }

Traveller travellerOf(const Kind& kind) {
  return {.legLength = kind.rig.legLength,
          .footprint = footprintRadius(kind.rig),
          .margin = kind.parameters.edgeMargin,
          .ways = *kind.wayNeeds};
}

CostGrid groundFor(const Crowd::Impl& crowd, const Kind& kind) {
  return costGrid(crowd.terrain, crowd.scene.obstacles, travellerOf(kind));
}

CostGrid gridFor(const Crowd::Impl& crowd, const Kind& kind) {
  CostGrid grid = kind.ground;
  keepOff(grid, threatsTo(crowd, kind), travellerOf(kind));
  return grid;
}

// As their records have it: a spawn keeps them off the edge of the map.
void addTarget(const Spawner& spawner, const Goal& goal, Targets& targets) {
  if (goal.kind != Goal::Kind::point) return;
  const GoalRecord record = spawner.goalRecord(0.0f, goal);
  addOnce(targets, {record[0], record[1]});
}

// Of events that are about the herd of that number, whichever herd has it then.
void addEventTargets(const Crowd::Impl& crowd, uint32_t herd, const Spawner& spawner, Targets& targets) {
  for (const Event& event : crowd.events) {
    if (const auto* change = std::get_if<GoalChange>(&event.what); change && change->herd == herd)
      addTarget(spawner, change->goal, targets);
    if (const auto* addition = std::get_if<Addition>(&event.what); addition && addition->herd == herd)
      for (const Addition::Arrival& arrival : addition->arrivals)
        if (arrival.goal) addTarget(spawner, *arrival.goal, targets);
  }
}

// Those that agents of the kind have, or will have in the next tick.
Targets targetsOf(const Crowd::Impl& crowd, const Kind& kind) {
  constexpr auto floats = static_cast<size_t>(4 * shared::GOAL_STRIDE);
  Targets targets;
  for (const Page& page : kind.pages) {
    const std::vector<float> goals = gpu::download<float>(*crowd.context, page.goal);
    for (size_t agent = 0; agent < page.agents; ++agent) {
      const auto goal = std::span(goals).subspan(agent * floats, floats);
      if (isLed(goal)) addOnce(targets, {goal[0], goal[1]});
    }
  }
  for (const AgentChange& change : kind.changes.all())
    if (change.goal && isLed(change.record)) addOnce(targets, {change.record[0], change.record[1]});
  return targets;
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

void beginWays(Crowd::Impl& crowd, uint32_t k) {
  Kind& kind = crowd.kinds[k];
  if (!kind.wayNeeds) return;
  kind.ground = groundFor(crowd, kind);
  kind.ways = std::make_unique<WayFields>(*crowd.context, gridFor(crowd, kind));
  Targets targets;
  const std::vector<HerdRun> runs = runsOf(crowd, k);
  for (const HerdRun& of : runs) addTarget(spawnerOf(crowd, *of.herd, *of.run), of.herd->from.goal, targets);
  for (const HerdRun& of : runs)
    addEventTargets(crowd, of.number, spawnerOf(crowd, *of.herd, *of.run), targets);
  kind.ways->add(fitting(*kind.ways, targets, {}), {});
}

void leadTo(Crowd::Impl& crowd, const Herd& herd, const SizeRun& run, std::span<const Goal> goals,
            const std::function<std::string()>& name) {
  Kind& kind = crowd.kinds[run.kind];
  if (!kind.ways || kind.ways->regions().count == 0) return;
  const Spawner spawner = spawnerOf(crowd, herd, run);
  Targets targets;
  for (const Goal& goal : goals) addTarget(spawner, goal, targets);
  const auto isNew = [&](const glm::vec2& target) { return !kind.ways->has(target); };
  if (std::ranges::none_of(targets, isNew)) return;
  Targets kept = targets;
  if (kind.ways->goals().size() + targets.size() > shared::MOST_WAYS) {
    crowd.context->waitIdle();
    for (const glm::vec2& target : targetsOf(crowd, kind)) addOnce(kept, target);
  }
  const Targets fresh = fitting(*kind.ways, targets, kept);
  if (fresh.size() < static_cast<size_t>(std::ranges::count_if(targets, isNew)))
    throw inputError(
        fmt::format("{}: its goals, and those of agents like it, are more than {} places that "
                    "ways lead to, expected at most as many",
                    name(), shared::MOST_WAYS));
  changeWays(crowd, kind, [&](WayFields& ways) { ways.add(fresh, kept); });
}

void leadEverybody(Crowd::Impl& crowd) {
  for (Kind& kind : crowd.kinds) {
    if (!kind.ways) continue;
    const Targets targets = targetsOf(crowd, kind);
    const Targets fresh = fitting(*kind.ways, targets, targets);
    if (!fresh.empty()) changeWays(crowd, kind, [&](WayFields& ways) { ways.add(fresh, targets); });
  }
}

void keepWays(Crowd::Impl& crowd) {
  const bool edited = !crowd.edits.empty(), threatened = threatsHaveMoved(crowd);
  if (!edited && !threatened) return;
  for (Kind& kind : crowd.kinds) {
    if (!kind.ways) continue;
    if (edited) kind.ground = groundFor(crowd, kind);
    CostGrid grid = gridFor(crowd, kind);
    if (grid == kind.ways->grid()) continue;
    changeWays(crowd, kind, [&](WayFields& ways) { ways.setGrid(std::move(grid)); });
  }
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
    if (!of.presence.has(agent) || goal[6] != shared::GOAL_POINT || !ways.has({goal[0], goal[1]})) continue;
    const uint32_t region = ways.regions().of[crowd::cellAt(ways.grid(), crowd::placeOf(body))];
    // Who is in an obstacle gets out of it, nobody knows where.
    if (region == crowd::Regions::none) continue;
    count += region != ways.stopsAt({goal[0], goal[1]}).region;
  }
  return count;
}

}  // namespace skitter
