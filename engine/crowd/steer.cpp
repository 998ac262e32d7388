// What the host says while a crowd runs; engine/crowd/changes.h carries it to the device.
#include <fmt/format.h>

#include <map>
#include <span>
#include <vector>

#include "crowd/page.h"
#include "crowd/spawn.h"
#include "crowd/steer.h"
#include "crowd/ways/ways.h"
#include "skitter/crowd.h"
#include "skitter/error.h"

namespace skitter {
namespace {

using crowd::AgentChange, crowd::SizeRun, crowd::expectGoal, crowd::expectHurts, crowd::expectLeg,
    crowd::expectCarries, crowd::expectLoad, crowd::expectPlace, crowd::expectPush, crowd::expectReacts,
    crowd::expectSpeed;

std::string nameOf(uint32_t herd) { return fmt::format("herd {}", herd); }
std::string nameOf(uint32_t herd, uint32_t agent) { return fmt::format("herd {}, agent {}", herd, agent); }

void expectOneEach(const crowd::Herd& herd, uint32_t number, size_t found, const char* what) {
  if (found != herd.agents)
    throw inputError(
        fmt::format("herd {}: found {} {}, expected {}, one a place", number, found, what, herd.agents));
}

// Calls each(agent) with everybody who is there.
template <class Each>
void forEach(const crowd::Herd& herd, const SizeRun& run, const Each& each) {
  for (uint32_t agent = run.firstOfHerd; agent < run.firstOfHerd + run.agents; ++agent)
    if (herd.presence.has(agent)) each(agent);
}
template <class Each>
void forEach(const crowd::Herd& herd, const Each& each) {
  for (const SizeRun& run : herd.runs) forEach(herd, run, each);
}

bool isThere(const crowd::Herd& herd, AgentId id) {
  return id.agent() < herd.agents && herd.presence.has(id.agent()) &&
         id.generation() == herd.presence.generations[id.agent()];
}

void expectSomebody(const Crowd::Impl& crowd, AgentId id) {
  const crowd::Herd& herd = crowd.herdAt(id.herd());
  if (!isThere(herd, id))
    throw inputError(fmt::format("herd {}, agent {} of generation {}: nobody, expected one of {} agents",
                                 id.herd(), id.agent(), id.generation(), herd.presence.count));
}

AgentChange& changeOf(Crowd::Impl& crowd, const SizeRun& run, uint32_t agent) {
  crowd::Kind& kind = crowd.kinds[run.kind];
  return kind.changes.of(run.ofKind(agent), kind.agents);
}

std::map<uint32_t, std::vector<Goal>> goalsByHerd(std::span<const AgentGoal> goals) {
  std::map<uint32_t, std::vector<Goal>> byHerd;
  for (const auto& [id, goal] : goals) byHerd[id.herd()].push_back(goal);
  return byHerd;
}

void expectReserve(const crowd::Herd& herd, uint32_t number) {
  crowd::expectReserve([&] { return nameOf(number); }, herd.from.reserve > 0);
}

template <class Name>
void expectGoalOf(const Crowd::Impl& crowd, const Name& name, const Goal& goal, const crowd::Herd& herd) {
  expectGoal(name, goal);
  crowd::expectItsHerds(name, goal, herd.from, [&](uint32_t leader) -> const skitter::Herd& {
    return crowd.presentHerdAt(leader).from;
  });
}

// Fields for the goals of one agent, some or all of a herd.
void lead(Crowd::Impl& crowd, const crowd::Herd& herd, std::span<const Goal> goals, uint32_t number) {
  for (const SizeRun& run : herd.runs) crowd::leadTo(crowd, herd, run, goals, [&] { return nameOf(number); });
}

// Sets goals of a herd's agents that have one size.
class Steerer {
 public:
  Steerer(Crowd::Impl& crowd, const crowd::Herd& herd, const SizeRun& run)
      : crowd_(crowd), run_(run), spawner_(crowd::spawnerOf(crowd, herd, run)) {}
  void steer(uint32_t agent, const Goal& goal) const {
    AgentChange& change = changeOf(crowd_, run_, agent);
    change.goal = true;
    change.record = spawner_.goalRecord(agent - run_.firstOfHerd, goal);
  }

 private:
  Crowd::Impl& crowd_;
  const SizeRun& run_;
  crowd::Spawner spawner_;
};

// `goalOf` gives each agent's.
template <class GoalOf>
void steerAll(Crowd::Impl& crowd, const crowd::Herd& herd, const GoalOf& goalOf) {
  for (const SizeRun& run : herd.runs) {
    const Steerer steerer(crowd, herd, run);
    forEach(herd, run, [&](uint32_t agent) { steerer.steer(agent, goalOf(agent)); });
  }
}

void setSpeedOf(Crowd::Impl& crowd, const crowd::Herd& herd, uint32_t agent, float speed) {
  AgentChange& change = changeOf(crowd, herd.runOf(agent), agent);
  change.speed = true;
  change.record[4] = speed;
}

}  // namespace

void Crowd::steer(uint32_t number, const Goal& goal) {
  const crowd::Herd& herd = impl_->presentHerdAt(number);
  expectGoalOf(
      *impl_, [&] { return nameOf(number); }, goal, herd);
  lead(*impl_, herd, std::span(&goal, 1), number);
  steerAll(*impl_, herd, [&](uint32_t) -> const Goal& { return goal; });
}

void Crowd::steer(uint32_t number, std::span<const Goal> goals) {
  const crowd::Herd& herd = impl_->presentHerdAt(number);
  expectOneEach(herd, number, goals.size(), "goals");
  forEach(herd, [&](uint32_t agent) {
    expectGoalOf(
        *impl_, [&] { return nameOf(number, agent); }, goals[agent], herd);
  });
  lead(*impl_, herd, goals, number);
  steerAll(*impl_, herd, [&](uint32_t agent) -> const Goal& { return goals[agent]; });
}

void Crowd::steer(std::span<const AgentGoal> goals) {
  for (const auto& [id, goal] : goals) {
    expectSomebody(*impl_, id);
    expectGoalOf(
        *impl_, [&] { return nameOf(id.herd(), id.agent()); }, goal, impl_->herds[id.herd()]);
  }
  for (const auto& [number, wanted] : goalsByHerd(goals)) lead(*impl_, impl_->herds[number], wanted, number);
  for (const auto& [id, goal] : goals) {
    const crowd::Herd& herd = impl_->herds[id.herd()];
    Steerer(*impl_, herd, herd.runOf(id.agent())).steer(id.agent(), goal);
  }
}

void Crowd::setSpeed(uint32_t number, float speed) {
  const crowd::Herd& herd = impl_->presentHerdAt(number);
  expectSpeed([&] { return nameOf(number); }, "the speed", speed);
  forEach(herd, [&](uint32_t agent) { setSpeedOf(*impl_, herd, agent, speed); });
}

void Crowd::setSpeed(uint32_t number, std::span<const float> speeds) {
  const crowd::Herd& herd = impl_->presentHerdAt(number);
  expectOneEach(herd, number, speeds.size(), "speeds");
  forEach(herd, [&](uint32_t agent) {
    expectSpeed([&] { return nameOf(number, agent); }, "the speed", speeds[agent]);
  });
  forEach(herd, [&](uint32_t agent) { setSpeedOf(*impl_, herd, agent, speeds[agent]); });
}

void Crowd::setSpeed(std::span<const AgentSpeed> speeds) {
  for (const auto& [id, speed] : speeds) {
    expectSomebody(*impl_, id);
    expectSpeed([&] { return nameOf(id.herd(), id.agent()); }, "the speed", speed);
  }
  for (const auto& [id, speed] : speeds) setSpeedOf(*impl_, impl_->herds[id.herd()], id.agent(), speed);
}

void Crowd::teleport(std::span<const AgentPlace> places) {
  for (const auto& [id, place] : places) {
    expectSomebody(*impl_, id);
    expectPlace([&] { return nameOf(id.herd(), id.agent()); }, impl_->terrain, place);
  }
  for (const auto& [id, place] : places)
    changeOf(*impl_, impl_->herds[id.herd()].runOf(id.agent()), id.agent()).stands = place;
}

void Crowd::teleport(AgentId agent, const Place& place) {
  const AgentPlace one{agent, place};
  teleport(std::span(&one, 1));
}

void Crowd::hurt(std::span<const AgentLeg> legs) {
  for (const auto& [id, leg, state, bone] : legs) {
    expectSomebody(*impl_, id);
    const auto name = [&] { return nameOf(id.herd(), id.agent()); };
    const crowd::Kind& kind = impl_->kindOf(id.herd(), id.agent());
    expectHurts(name, kind.hurts);
    expectLeg(name, kind.rig, leg, bone);
  }
  for (const auto& [id, leg, state, bone] : legs) {
    const SizeRun& run = impl_->herds[id.herd()].runOf(id.agent());
    crowd::Kind& kind = impl_->kinds[run.kind];
    const uint32_t ofKind = run.ofKind(id.agent());
    const uint32_t stump = kind.rig.legs[leg].bones.size() > 1 ? 1 : 0;
    crowd::Damage& damage = kind.damages[ofKind];
    damage.set(leg, state, bone.value_or(stump));
    if (damage.isNone()) kind.damages.erase(ofKind);
    changeOf(*impl_, run, id.agent()).hurt = true;
  }
}

void Crowd::hurt(AgentId agent, uint32_t leg, LegState state, std::optional<uint32_t> bone) {
  const AgentLeg one{agent, leg, state, bone};
  hurt(std::span(&one, 1));
}

void Crowd::heal(AgentId agent) {
  expectSomebody(*impl_, agent);
  std::vector<AgentLeg> legs;
  for (uint32_t leg = 0; leg < impl_->kindOf(agent.herd(), agent.agent()).rig.legs.size(); ++leg)
    legs.push_back({agent, leg, LegState::whole, {}});
  hurt(legs);
}

LegState Crowd::legState(AgentId id, uint32_t leg) const {
  expectSomebody(*impl_, id);
  const crowd::Kind& kind = impl_->kindOf(id.herd(), id.agent());
  expectLeg([&] { return nameOf(id.herd(), id.agent()); }, kind.rig, leg, {});
  const auto hurt = kind.damages.find(impl_->herds[id.herd()].runOf(id.agent()).ofKind(id.agent()));
  return hurt == kind.damages.end() ? LegState::whole : hurt->second.of(leg);
}

void Crowd::carry(std::span<const AgentLoad> loads) {
  for (const auto& [id, load] : loads) {
    expectSomebody(*impl_, id);
    const auto name = [&] { return nameOf(id.herd(), id.agent()); };
    expectCarries(name, impl_->herds[id.herd()].from);
    expectLoad(name, load);
  }
  for (const auto& [id, load] : loads) {
    const SizeRun& run = impl_->herds[id.herd()].runOf(id.agent());
    impl_->kinds[run.kind].setLoad(run.ofKind(id.agent()), load);
    changeOf(*impl_, run, id.agent()).hurt = true;
  }
}

void Crowd::carry(AgentId agent, const Load& load) {
  const AgentLoad one{agent, load};
  carry(std::span(&one, 1));
}

Load Crowd::carried(AgentId id) const {
  expectSomebody(*impl_, id);
  return impl_->kindOf(id.herd(), id.agent())
      .carriedBy(impl_->herds[id.herd()].runOf(id.agent()).ofKind(id.agent()));
}

void Crowd::push(std::span<const AgentPush> pushes) {
  for (const auto& [id, velocity] : pushes) {
    expectSomebody(*impl_, id);
    const auto name = [&] { return nameOf(id.herd(), id.agent()); };
    expectReacts(name, impl_->kindOf(id.herd(), id.agent()).reacts);
    expectPush(name, velocity);
  }
  for (const auto& [id, velocity] : pushes) {
    AgentChange& change = changeOf(*impl_, impl_->herds[id.herd()].runOf(id.agent()), id.agent());
    change.push = change.push.value_or(glm::vec2(0)) + velocity;
  }
}

void Crowd::push(AgentId agent, const glm::vec2& velocity) {
  const AgentPush one{agent, velocity};
  push(std::span(&one, 1));
}

std::vector<GoalBuffer> Crowd::goalBuffers(uint32_t herd) const {
  std::vector<GoalBuffer> buffers;
  for (const crowd::Part& part : crowd::partsOf(*impl_, herd))
    buffers.push_back({.goals = part.page->goal.handle(),
                       .first = part.first,
                       .firstAgent = part.firstAgent,
                       .agents = part.agents});
  return buffers;
}

AgentId Crowd::agentId(uint32_t number, uint32_t agent) const {
  const crowd::Herd& herd = impl_->herdAt(number);
  const AgentId id(number, agent, agent < herd.agents ? herd.presence.generations[agent] : 0);
  expectSomebody(*impl_, id);
  return id;
}

bool Crowd::has(AgentId id) const {
  return id.herd() < impl_->herds.size() && isThere(impl_->herds[id.herd()], id);
}

uint32_t Crowd::places(uint32_t herd) const { return impl_->herdAt(herd).agents; }
uint32_t Crowd::agentCount(uint32_t herd) const { return impl_->herdAt(herd).presence.count; }

AgentId Crowd::add(uint32_t number, const Place& place, const Goal& goal) {
  impl_->presentHerdAt(number);
  crowd::Herd& herd = impl_->herdAt(number);
  const auto name = [&] { return fmt::format("herd {}, a new agent", number); };
  expectGoalOf(*impl_, name, goal, herd);
  expectPlace(name, impl_->terrain, place);
  expectReserve(herd, number);
  const std::optional<uint32_t> empty = herd.presence.lowestEmpty();
  if (!empty)
    throw inputError(
        fmt::format("herd {}: all of its {} places are taken, expected an empty one: a larger reserve "
                    "has more",
                    number, herd.agents));
  crowd::leadTo(*impl_, herd, herd.runOf(*empty), std::span(&goal, 1), name);
  herd.presence.come(*empty);
  const SizeRun& run = herd.runOf(*empty);
  AgentChange& change = changeOf(*impl_, run, *empty);
  change.goal = true;
  change.record =
      crowd::spawnerOf(*impl_, herd, run).goalRecord(*empty - run.firstOfHerd, place.position.x, goal);
  change.stands = place;
  change.leaves = false;
  crowd::Kind& kind = impl_->kinds[run.kind];
  kind.damages.erase(run.ofKind(*empty));
  kind.setLoad(run.ofKind(*empty), {});
  change.hurt = kind.hurts;
  change.push = {};
  return agentId(number, *empty);
}

AgentId Crowd::add(uint32_t herd, const Place& place) {
  return add(herd, place, impl_->herdAt(herd).from.goal);
}

void Crowd::remove(AgentId id) {
  expectSomebody(*impl_, id);
  crowd::Herd& herd = impl_->herds[id.herd()];
  expectReserve(herd, id.herd());
  herd.presence.leave(id.agent());
  AgentChange& change = changeOf(*impl_, herd.runOf(id.agent()), id.agent());
  change = {.agent = change.agent, .leaves = true};
}

}  // namespace skitter
