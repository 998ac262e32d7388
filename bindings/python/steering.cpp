#include <limits>
#include <string>
#include <variant>
#include <vector>

#include "bindings/common/names.h"
#include "bindings/python/crowd.h"
#include "crowd/steer.h"

namespace skitter::python {
namespace {

using namespace py::literals;

// Handles of agents, AgentId::bits().
using Ids = py::array_t<uint64_t, py::array::c_style | py::array::forcecast>;
using HerdNumbers = std::pair<uint32_t, uint32_t>;  // of a HerdId: index and generation

std::vector<AgentId> agentsOf(const Ids& ids) {
  std::vector<AgentId> agents;
  for (const uint64_t bits : std::span(ids.data(), static_cast<size_t>(ids.size())))
    agents.push_back(AgentId::ofBits(bits));
  return agents;
}

std::vector<glm::vec2> pairsOf(const Floats& array, const char* name) {
  return vectorsOf<2>(array, name, "(agents, 2)");
}

// A list of AgentGoal, AgentSpeed or AgentPlace: an entry per handle.
template <typename Given, typename Make>
std::vector<Given> givenTo(const Ids& ids, const Make& make) {
  std::vector<Given> all;
  for (const AgentId agent : agentsOf(ids)) all.push_back({agent, make(all.size())});
  return all;
}

void expectOneEach(size_t found, const char* name, const Ids& agents) {
  const auto expected = static_cast<size_t>(agents.size());
  if (found != expected)
    throw inputError(fmt::format("{} {}, expected {}, one an agent", found, name, expected));
}

Goal goalTo(const glm::vec2& target, float speed) {
  Goal goal;
  goal.kind = Goal::Kind::point;
  goal.target = target;
  goal.speed = speed;
  return goal;
}

Goal goalBy(const glm::vec2& velocity) {
  Goal goal;
  goal.kind = Goal::Kind::velocity;
  goal.velocity = velocity;
  return goal;
}

void steer(PythonCrowd& self, Goal goal, uint32_t herd, const std::optional<Ids>& agents) {
  if (!agents) return self.told([&](Crowd& crowd) { crowd.steer(herd, goal); });
  const auto goals = givenTo<AgentGoal>(*agents, [&](size_t) { return goal; });
  self.told([&](Crowd& crowd) { crowd.steer(goals); });
}

// One goal per place of the herd, or a handle.
void steerEach(PythonCrowd& self, const std::vector<Goal>& goals, const char* name, uint32_t herd,
               const std::optional<Ids>& agents) {
  if (!agents) return self.told([&](Crowd& crowd) { crowd.steer(herd, goals); });
  expectOneEach(goals.size(), name, *agents);
  const auto given = givenTo<AgentGoal>(*agents, [&](size_t i) { return goals[i]; });
  self.told([&](Crowd& crowd) { crowd.steer(given); });
}

void steerTo(PythonCrowd& self, const Floats& targets, float speed, uint32_t herd,
             const std::optional<Ids>& agents) {
  std::vector<Goal> goals;
  for (const glm::vec2& target : pairsOf(targets, "targets")) goals.push_back(goalTo(target, speed));
  steerEach(self, goals, "targets", herd, agents);
}

void steerBy(PythonCrowd& self, const Floats& velocities, uint32_t herd, const std::optional<Ids>& agents) {
  std::vector<Goal> goals;
  for (const glm::vec2& velocity : pairsOf(velocities, "velocities")) goals.push_back(goalBy(velocity));
  steerEach(self, goals, "velocities", herd, agents);
}

void setSpeed(PythonCrowd& self, const Floats& speed, uint32_t herd, const std::optional<Ids>& agents) {
  if (agents) {
    const Each<float> speeds(speed, "speed", static_cast<size_t>(agents->size()));
    const auto given = givenTo<AgentSpeed>(*agents, [&](size_t i) { return speeds[i]; });
    return self.told([&](Crowd& crowd) { crowd.setSpeed(given); });
  }
  const std::span<const float> speeds(speed.data(), static_cast<size_t>(speed.size()));
  if (speed.ndim() == 0) return self.told([&](Crowd& crowd) { crowd.setSpeed(herd, speeds.front()); });
  self.told([&](Crowd& crowd) { crowd.setSpeed(herd, speeds); });
}

void teleport(PythonCrowd& self, const Ids& agents, const Floats& positions, const Floats& headings) {
  const std::vector<glm::vec2> at = pairsOf(positions, "positions");
  expectOneEach(at.size(), "positions", agents);
  const Each<float> facing(headings, "headings", at.size());
  const auto places = givenTo<AgentPlace>(agents, [&](size_t i) { return Place{at[i], facing[i]}; });
  self.told([&](Crowd& crowd) { crowd.teleport(places); });
}

// Of a rig, by its name or its number.
using LegOf = std::variant<uint32_t, std::string>;
uint32_t legOf(const Crowd& crowd, AgentId agent, const LegOf& leg) {
  if (const auto* number = std::get_if<uint32_t>(&leg)) return *number;
  const auto name = [&] { return fmt::format("herd {}, agent {}", agent.herd(), agent.agent()); };
  return crowd::legNamed(name, crowd.rig(agent.herd()), std::get<std::string>(leg));
}

void hurt(PythonCrowd& self, const Ids& agents, const LegOf& leg, const std::string& state,
          std::optional<uint32_t> bone) {
  const LegState made = bindings::namedOf(allLegStates, "state", state);
  self.told([&](Crowd& crowd) {
    std::vector<AgentLeg> legs;
    for (const AgentId agent : agentsOf(agents))
      legs.push_back({agent, legOf(crowd, agent, leg), made, bone});
    crowd.hurt(legs);
  });
}

// Of several, none is healed where one is not there.
void heal(PythonCrowd& self, const Ids& agents) {
  self.told([&](Crowd& crowd) {
    std::vector<AgentLeg> legs;
    for (const AgentId agent : agentsOf(agents))
      for (uint32_t leg = 0; leg < crowd.rig(agent.herd()).legs.size(); ++leg)
        legs.push_back({agent, leg, LegState::whole, {}});
    crowd.hurt(legs);
  });
}

std::string legState(PythonCrowd& self, uint64_t agent, const LegOf& leg) {
  const AgentId id = AgentId::ofBits(agent);
  return self.told([&](const Crowd& crowd) { return nameOf(crowd.legState(id, legOf(crowd, id, leg))); });
}

void carry(PythonCrowd& self, const Ids& agents, const Load& load) {
  self.told([&](Crowd& crowd) {
    std::vector<AgentLoad> loads;
    for (const AgentId agent : agentsOf(agents)) loads.push_back({agent, load});
    crowd.carry(loads);
  });
}

Load carried(PythonCrowd& self, uint64_t agent) {
  return self.told([&](const Crowd& crowd) { return crowd.carried(AgentId::ofBits(agent)); });
}

void push(PythonCrowd& self, const Ids& agents, const Floats& velocities) {
  const std::vector<glm::vec2> by = pairsOf(velocities, "velocities");
  expectOneEach(by.size(), "velocities", agents);
  const auto pushes = givenTo<AgentPush>(agents, [&](size_t i) { return by[i]; });
  self.told([&](Crowd& crowd) { crowd.push(pushes); });
}

py::list reactions(PythonCrowd& self, uint32_t herd) {
  const std::vector<Reaction> all = self.told([&](const Crowd& crowd) { return crowd.reactions(herd); });
  py::list made;
  for (const Reaction& each : all) {
    py::dict one;
    one["phase"] = nameOf(each.phase);
    one["falls"] = each.falls;
    one["stands"] = each.stands;
    one["down"] = each.down;
    one["down_before"] = each.downBefore;
    made.append(one);
  }
  return made;
}

py::list searches(PythonCrowd& self, uint32_t herd) {
  const std::vector<Search> all = self.told([&](const Crowd& crowd) { return crowd.searches(herd); });
  py::list made;
  for (const Search& each : all) {
    py::dict one;
    one["phase"] = nameOf(each.phase);
    one["trials"] = each.trials;
    one["best"] = each.best;
    made.append(one);
  }
  return made;
}

uint64_t add(PythonCrowd& self, const glm::vec2& position, float heading, uint32_t herd,
             const std::optional<Goal>& goal) {
  const Place place{position, heading};
  return self.told(
      [&](Crowd& crowd) { return (goal ? crowd.add(herd, place, *goal) : crowd.add(herd, place)).bits(); });
}

// A copy: another thread may change the Python object meanwhile.
HerdNumbers addHerd(PythonCrowd& self, Herd herd) {
  const HerdId id = self.told([&](Crowd& crowd) { return crowd.addHerd(herd); });
  return {id.index, id.generation};
}

void removeHerd(PythonCrowd& self, HerdNumbers herd) {
  self.told([&](Crowd& crowd) { crowd.removeHerd({herd.first, herd.second}); });
}

void bindGoals(CrowdClass& bound) {
  bound
      .def("steer", &steer, "goal"_a, "herd"_a = 0, "agents"_a = py::none(),
           "Gives all agents of the herd a goal, or those of the handles `agents`, from the next tick on.")
      .def("steer_to", &steerTo, "targets"_a, "speed"_a = 1.0f, "herd"_a = 0, "agents"_a = py::none(),
           "Sends each agent to a point of its own: x and z in metres, shape (n, 2), one per place of "
           "the herd, or one per handle of `agents`; `speed` in metres per second.")
      .def("steer_by", &steerBy, "velocities"_a, "herd"_a = 0, "agents"_a = py::none(),
           "Gives each agent a velocity: x and z in metres per second, likewise.")
      .def(
          "set_speed", &setSpeed, "speed"_a, "herd"_a = 0, "agents"_a = py::none(),
          "Metres per second, from the next tick on: one number for all, or one per place of the herd or per "
          "handle of `agents`.");
}

void bindAgents(CrowdClass& bound) {
  bound
      .def(
          "agent_id",
          [](PythonCrowd& self, uint32_t agent, uint32_t herd) {
            return self.told([&](const Crowd& crowd) { return crowd.agentId(herd, agent).bits(); });
          },
          "agent"_a, "herd"_a = 0,
          "The handle of the agent in that place of the herd. It never means another agent.")
      .def(
          "agent_ids",
          [](PythonCrowd& self, uint32_t herd) {
            return listOf(self.told([&](const Crowd& crowd) { return bindings::agentIdsOf(crowd, herd); }));
          },
          "herd"_a = 0, "The handles of all: uint64 of shape (places,); skitter.no_agent where nobody is.")
      .def(
          "has",
          [](PythonCrowd& self, uint64_t agent) {
            return self.told([&](const Crowd& crowd) { return crowd.has(AgentId::ofBits(agent)); });
          },
          "agent"_a, "Whether the agent of that handle is there.")
      .def("push", &push, "agents"_a, "velocities"_a,
           "Adds to the velocities of agents of herds with reactions: x and z in metres per second, shape "
           "(n, 2), "
           "one per handle, in the next tick.")
      .def("reactions", &reactions, "herd"_a = 0,
           "Who fell and who stands again, one dict per place: phase, falls, stands, down and down_before "
           "(seconds). Waits for the device.")
      .def(
          "searches", &searches, "herd"_a = 0,
          "How agents get on that try gaits, one dict per place: phase, trials and best, the highest fitness "
          "of these. Waits for the device.")
      .def("teleport", &teleport, "agents"_a, "positions"_a, "headings"_a = 0.0f,
           "Puts the agents of one or more handles at x and z, metres, with their feet on the ground and "
           "without speed; `headings` as headings(), one for all or one each. Goals stay.")
      .def(
          "add", &add, "position"_a, "heading"_a = 0.0f, "herd"_a = 0, "goal"_a = py::none(),
          "Adds an agent at x and z, metres, to a herd with a reserve, in its lowest empty place, which says "
          "how large it is, and returns its handle. `goal`: None: the herd's.")
      .def(
          "remove",
          [](PythonCrowd& self, uint64_t agent) {
            self.told([&](Crowd& crowd) { crowd.remove(AgentId::ofBits(agent)); });
          },
          "agent"_a, "Removes the agent of that handle from a herd with a reserve.")
      .def(
          "cannot_reach",
          [](PythonCrowd& self, uint32_t herd) {
            return self.told([&](const Crowd& crowd) { return crowd.cannotReach(herd); });
          },
          "herd"_a = 0,
          "How many agents of a herd with ways have a goal that no way leads to: they stop at the nearest "
          "place "
          "that one leads to.")
      .def(
          "set_threat",
          [](PythonCrowd& self, uint32_t number, const glm::vec2& centre, float radius) {
            self.told([&](Crowd& crowd) { crowd.setThreat(number, {centre, radius}); });
          },
          "number"_a, "centre"_a = glm::vec2(0), "radius"_a = 1.0f,
          "A disc that agents of herds with ways keep off comes, moves or, with radius 0, goes.");
}

void bindDamage(CrowdClass& bound) {
  bound
      .def("hurt", &hurt, "agents"_a, "leg"_a, "state"_a = "lost", "bone"_a = py::none(),
           "Makes a leg of the agents of one or more handles \"whole\", \"lame\", \"stuck\" or \"lost\", in "
           "herds "
           "with `hurt`. `leg`: its name in the rig, or its number. `bone`: the first one that is lost, "
           "counted "
           "from the root; None: the second one. The other legs regroup in the next tick.")
      .def("heal", &heal, "agents"_a, "Makes all legs of the agents of one or more handles whole.")
      .def("leg_state", &legState, "agent"_a, "leg"_a, "What a leg of the agent of that handle is.")
      .def("carry", &carry, "agents"_a, "load"_a,
           "Gives the agents of one or more handles a Load, in herds with `hurt`, in place of what they "
           "carried; Load() takes it away.")
      .def("carried", &carried, "agent"_a, "What the agent of that handle carries.");
}

void bindHerds(CrowdClass& bound) {
  bound
      .def("add_herd", &addHerd, "herd"_a,
           "Adds a herd, which takes about 0.3 s per size. Its rig is relative to the working directory. "
           "Returns its handle: the lowest number that no "
           "herd has, and which one it is of those that have had it.")
      .def("remove_herd", &removeHerd, "herd"_a, "Waits for the device and removes the herd of that handle.")
      .def(
          "has_herd",
          [](PythonCrowd& self, HerdNumbers herd) {
            return self.told([&](const Crowd& crowd) { return crowd.has(HerdId{herd.first, herd.second}); });
          },
          "herd"_a, "Whether the herd of that handle is there.")
      .def(
          "herd_id",
          [](PythonCrowd& self, uint32_t herd) {
            const HerdId id = self.told([&](const Crowd& crowd) { return crowd.herdId(herd); });
            return HerdNumbers{id.index, id.generation};
          },
          "herd"_a, "The handle of the herd of that number.");
}

}  // namespace

void bindSteering(CrowdClass& bound) {
  bindGoals(bound);
  bindAgents(bound);
  bindDamage(bound);
  bindHerds(bound);
}

void bindPicking(py::module_& module, CrowdClass& bound) {
  constexpr double endless = std::numeric_limits<double>::infinity();
  py::class_<Picked>(module, "Picked", "An agent under a ray or near a point.")
      .def_readonly("herd", &Picked::herd, "Its herd.")
      .def_readonly("agent", &Picked::agent, "Its place in the herd.")
      .def_readonly("distance", &Picked::distance,
                    "Metres from the ray's start to the agent's sphere, or from the point to its middle.")
      .def_readonly("place", &Picked::place,
                    "Position where the ray meets the sphere, or the sphere's middle.");
  bound
      .def(
          "pick",
          [](PythonCrowd& self, const glm::dvec3& start, const glm::dvec3& direction, double length) {
            return self.told(
                [&](const Crowd& crowd) { return bindings::pick(crowd, start, direction, length); });
          },
          "start"_a, "direction"_a, "length"_a = endless,
          "The nearest agent under a ray of so many metres, or None. It is picked by a sphere about the "
          "middle of its body.")
      .def(
          "nearest",
          [](PythonCrowd& self, const glm::dvec3& point) {
            return self.told([&](const Crowd& crowd) { return bindings::nearest(crowd, point); });
          },
          "point"_a, "The agent nearest to a point, or None.");
}

}  // namespace skitter::python
