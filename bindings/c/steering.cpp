#include <algorithm>
#include <optional>
#include <vector>

#include "bindings/c/handles.h"
#include "bindings/common/herd_reader.h"

using namespace skitter;
using c::crowdOf;
using c::given;
using c::guarded;
using c::listOf;

namespace {

static_assert(SKITTER_NO_AGENT == AgentId().bits());
static_assert(SKITTER_GOAL_CROSS == static_cast<int>(Goal::Kind::cross) &&
              SKITTER_GOAL_POINT == static_cast<int>(Goal::Kind::point) &&
              SKITTER_GOAL_NONE == static_cast<int>(Goal::Kind::none) &&
              SKITTER_GOAL_VELOCITY == static_cast<int>(Goal::Kind::velocity) &&
              SKITTER_GOAL_ROUTE == static_cast<int>(Goal::Kind::route) &&
              SKITTER_GOAL_ROAM == static_cast<int>(Goal::Kind::roam) &&
              SKITTER_GOAL_FOLLOW == static_cast<int>(Goal::Kind::follow) &&
              SKITTER_GOAL_FLEE == static_cast<int>(Goal::Kind::flee));

// Only a route has places. A count that cannot be is not read by.
std::vector<glm::vec2> placesOf(const skitter_goal& goal) {
  if (goal.kind != SKITTER_GOAL_ROUTE) return {};
  if (goal.place_count == 0 || goal.place_count > Goal::maxPlaces)
    throw inputError(
        fmt::format("goal.place_count is {}, expected 1 to {}", goal.place_count, Goal::maxPlaces));
  const auto numbers = listOf(goal.places, size_t{2} * goal.place_count, "goal.places");
  std::vector<glm::vec2> places;
  for (size_t i = 0; i < numbers.size(); i += 2) places.emplace_back(numbers[i], numbers[i + 1]);
  return places;
}

static_assert(SKITTER_REACTION_STEADY == static_cast<int>(ReactionPhase::steady) &&
              SKITTER_REACTION_FALLING == static_cast<int>(ReactionPhase::falling) &&
              SKITTER_REACTION_RISING == static_cast<int>(ReactionPhase::rising));

Goal goalOf(const skitter_goal& goal) {
  if (const int kind = static_cast<int>(goal.kind); kind < SKITTER_GOAL_CROSS || kind > SKITTER_GOAL_FLEE)
    throw inputError(fmt::format("goal.kind is {}, expected a skitter_goal_kind", kind));
  return {.kind = static_cast<Goal::Kind>(goal.kind),
          .target = {goal.target[0], goal.target[1]},
          .speed = goal.speed,
          .velocity = {goal.velocity[0], goal.velocity[1]},
          .places = placesOf(goal),
          .loop = goal.loop != 0,
          .radius = goal.radius,
          .leader = goal.herd,
          .agent = goal.follow_agent != 0 ? std::optional(goal.agent) : std::nullopt};
}

static_assert(SKITTER_LEG_WHOLE == static_cast<int>(LegState::whole) &&
              SKITTER_LEG_LAME == static_cast<int>(LegState::lame) &&
              SKITTER_LEG_STUCK == static_cast<int>(LegState::stuck) &&
              SKITTER_LEG_LOST == static_cast<int>(LegState::lost));

AgentLeg agentLegOf(const skitter_agent_leg& leg) {
  if (const int state = static_cast<int>(leg.state); state < SKITTER_LEG_WHOLE || state > SKITTER_LEG_LOST)
    throw inputError(fmt::format("state is {}, expected a skitter_leg_state", state));
  AgentLeg made{
      .agent = AgentId::ofBits(leg.agent), .leg = leg.leg, .state = static_cast<LegState>(leg.state)};
  if (leg.bone != SKITTER_STUMP) made.bone = leg.bone;
  return made;
}

Place placeOf(const skitter_place& place) { return {{place.x, place.z}, place.heading}; }

// A list of AgentGoal, AgentSpeed or AgentPlace.
template <typename Given, typename From, typename Convert>
std::vector<Given> eachOf(const skitter_agent_id* agents, const From* values, size_t count, const char* name,
                          Convert convert) {
  const auto ids = listOf(agents, count, "agents");
  const auto from = listOf(values, count, name);
  std::vector<Given> list;
  list.reserve(count);
  for (size_t i = 0; i < count; ++i) list.push_back({AgentId::ofBits(ids[i]), convert(from[i])});
  return list;
}

}  // namespace

skitter_result skitter_crowd_agent_id(const skitter_crowd* crowd, uint32_t herd, uint32_t agent,
                                      skitter_agent_id* id) {
  return guarded([&] {
    const Crowd& asked = crowdOf(crowd);
    given(id, "id");
    *id = asked.agentId(herd, agent).bits();
  });
}

skitter_result skitter_crowd_agent_ids(const skitter_crowd* crowd, uint32_t herd, skitter_agent_id* ids,
                                       size_t room) {
  return guarded([&] {
    const Crowd& asked = crowdOf(crowd);
    given(ids, "ids");
    c::checkRoom("ids", room, asked.places(herd));
    std::ranges::copy(bindings::agentIdsOf(asked, herd), ids);
  });
}

skitter_result skitter_crowd_has(const skitter_crowd* crowd, skitter_agent_id agent, int* has) {
  return guarded([&] {
    const Crowd& asked = crowdOf(crowd);
    given(has, "has");
    *has = asked.has(AgentId::ofBits(agent)) ? 1 : 0;
  });
}

skitter_result skitter_crowd_steer(skitter_crowd* crowd, uint32_t herd, const skitter_goal* goal) {
  return guarded([&] { crowdOf(crowd).steer(herd, goalOf(given(goal, "goal"))); });
}

skitter_result skitter_crowd_steer_each(skitter_crowd* crowd, uint32_t herd, const skitter_goal* goals,
                                        size_t count) {
  return guarded([&] {
    Crowd& steered = crowdOf(crowd);
    std::vector<Goal> all;
    for (const skitter_goal& goal : listOf(goals, count, "goals")) all.push_back(goalOf(goal));
    steered.steer(herd, all);
  });
}

skitter_result skitter_crowd_steer_agents(skitter_crowd* crowd, const skitter_agent_id* agents,
                                          const skitter_goal* goals, size_t count) {
  return guarded([&] { crowdOf(crowd).steer(eachOf<AgentGoal>(agents, goals, count, "goals", goalOf)); });
}

skitter_result skitter_crowd_set_speed(skitter_crowd* crowd, uint32_t herd, float speed) {
  return guarded([&] { crowdOf(crowd).setSpeed(herd, speed); });
}

skitter_result skitter_crowd_set_speed_each(skitter_crowd* crowd, uint32_t herd, const float* speeds,
                                            size_t count) {
  return guarded([&] { crowdOf(crowd).setSpeed(herd, listOf(speeds, count, "speeds")); });
}

skitter_result skitter_crowd_set_speed_agents(skitter_crowd* crowd, const skitter_agent_id* agents,
                                              const float* speeds, size_t count) {
  return guarded([&] {
    crowdOf(crowd).setSpeed(
        eachOf<AgentSpeed>(agents, speeds, count, "speeds", [](float speed) { return speed; }));
  });
}

skitter_result skitter_crowd_teleport(skitter_crowd* crowd, const skitter_agent_id* agents,
                                      const skitter_place* places, size_t count) {
  return guarded(
      [&] { crowdOf(crowd).teleport(eachOf<AgentPlace>(agents, places, count, "places", placeOf)); });
}

skitter_result skitter_crowd_push(skitter_crowd* crowd, const skitter_agent_id* agents,
                                  const float* velocities, size_t count) {
  return guarded([&] {
    Crowd& pushed = crowdOf(crowd);
    const auto ids = listOf(agents, count, "agents");
    const auto from = listOf(velocities, 2 * count, "velocities");
    std::vector<AgentPush> pushes;
    for (size_t i = 0; i < count; ++i)
      pushes.push_back({AgentId::ofBits(ids[i]), {from[2 * i], from[2 * i + 1]}});
    pushed.push(pushes);
  });
}

skitter_result skitter_crowd_reactions(const skitter_crowd* crowd, uint32_t herd, skitter_reaction* reactions,
                                       size_t room) {
  return guarded([&] {
    const Crowd& asked = crowdOf(crowd);
    given(reactions, "reactions");
    c::checkRoom("reactions", room, asked.places(herd));
    for (const Reaction& each : asked.reactions(herd))
      *reactions++ = {.phase = static_cast<skitter_reaction_phase>(each.phase),
                      .falls = each.falls,
                      .stands = each.stands,
                      .down = each.down,
                      .down_before = each.downBefore};
  });
}

skitter_result skitter_crowd_searches(const skitter_crowd* crowd, uint32_t herd, skitter_search* searches,
                                      size_t room) {
  return guarded([&] {
    const Crowd& asked = crowdOf(crowd);
    given(searches, "searches");
    c::checkRoom("searches", room, asked.places(herd));
    for (const Search& each : asked.searches(herd))
      *searches++ = {
          .phase = static_cast<skitter_search_phase>(each.phase), .trials = each.trials, .best = each.best};
  });
}

skitter_result skitter_crowd_add(skitter_crowd* crowd, uint32_t herd, const skitter_place* place,
                                 const skitter_goal* goal, skitter_agent_id* id) {
  return guarded([&] {
    Crowd& to = crowdOf(crowd);
    const Place at = placeOf(given(place, "place"));
    const AgentId added = goal != nullptr ? to.add(herd, at, goalOf(*goal)) : to.add(herd, at);
    if (id != nullptr) *id = added.bits();
  });
}

skitter_result skitter_crowd_remove(skitter_crowd* crowd, skitter_agent_id agent) {
  return guarded([&] { crowdOf(crowd).remove(AgentId::ofBits(agent)); });
}

skitter_result skitter_crowd_cannot_reach(const skitter_crowd* crowd, uint32_t herd, uint32_t* agents) {
  return c::tell(crowd, agents, "agents", [&](const Crowd& asked) { return asked.cannotReach(herd); });
}

skitter_result skitter_crowd_hurt(skitter_crowd* crowd, const skitter_agent_leg* legs, size_t count) {
  return guarded([&] {
    Crowd& hurt = crowdOf(crowd);
    std::vector<AgentLeg> all;
    for (const skitter_agent_leg& leg : listOf(legs, count, "legs")) all.push_back(agentLegOf(leg));
    hurt.hurt(all);
  });
}

skitter_result skitter_crowd_heal(skitter_crowd* crowd, skitter_agent_id agent) {
  return guarded([&] { crowdOf(crowd).heal(AgentId::ofBits(agent)); });
}

skitter_result skitter_crowd_leg_state(const skitter_crowd* crowd, skitter_agent_id agent, uint32_t leg,
                                       skitter_leg_state* state) {
  return guarded([&] {
    const Crowd& asked = crowdOf(crowd);
    given(state, "state");
    *state = static_cast<skitter_leg_state>(asked.legState(AgentId::ofBits(agent), leg));
  });
}

skitter_result skitter_crowd_carry(skitter_crowd* crowd, const skitter_agent_load* loads, size_t count) {
  return guarded([&] {
    Crowd& told = crowdOf(crowd);
    std::vector<AgentLoad> all;
    for (const auto& [agent, load] : listOf(loads, count, "loads"))
      all.push_back({AgentId::ofBits(agent), {load.mass, {load.offset[0], load.offset[1], load.offset[2]}}});
    told.carry(all);
  });
}

skitter_result skitter_crowd_carried(const skitter_crowd* crowd, skitter_agent_id agent, skitter_load* load) {
  return guarded([&] {
    const Crowd& asked = crowdOf(crowd);
    given(load, "load");
    const auto [mass, offset] = asked.carried(AgentId::ofBits(agent));
    *load = {mass, {offset.x, offset.y, offset.z}};
  });
}

skitter_result skitter_crowd_set_threat(skitter_crowd* crowd, uint32_t number, const float centre[2],
                                        float radius) {
  return guarded([&] {
    const float* at = &given(centre, "centre");
    crowdOf(crowd).setThreat(number, {{at[0], at[1]}, radius});
  });
}

skitter_result skitter_crowd_add_herd(skitter_crowd* crowd, const skitter_scene* scene, uint32_t herd,
                                      skitter_herd_id* id) {
  return guarded([&] {
    Crowd& to = crowdOf(crowd);
    const HerdId added = to.addHerd(c::herdOf(given(scene, "scene").scene, herd));
    if (id != nullptr) *id = {added.index, added.generation};
  });
}

skitter_result skitter_crowd_remove_herd(skitter_crowd* crowd, skitter_herd_id herd) {
  return guarded([&] { crowdOf(crowd).removeHerd({herd.herd, herd.generation}); });
}

skitter_result skitter_crowd_herd_id(const skitter_crowd* crowd, uint32_t herd, skitter_herd_id* id) {
  return guarded([&] {
    const Crowd& asked = crowdOf(crowd);
    given(id, "id");
    const HerdId found = asked.herdId(herd);
    *id = {found.index, found.generation};
  });
}

skitter_result skitter_crowd_has_herd(const skitter_crowd* crowd, skitter_herd_id herd, int* has) {
  return guarded([&] {
    const Crowd& asked = crowdOf(crowd);
    given(has, "has");
    *has = asked.has(HerdId{herd.herd, herd.generation}) ? 1 : 0;
  });
}
