// The events of a scene as Python objects.
#include "bindings/python/bind.h"

namespace skitter::python {
namespace {

using namespace py::literals;

using What = decltype(Event::what);
using Places = std::vector<uint32_t>;

constexpr const char* herdText = "The herd's number.";
constexpr const char* agentsText = "Whom it is about, by place; empty: all who are there.";

HeightSamples samplesOf(uint32_t x, uint32_t z, const Floats& heights) {
  if (heights.ndim() != 2)
    throw inputError(fmt::format("heights have shape {}, expected (rows, columns)", shapeOf(heights)));
  return {.x = x,
          .z = z,
          .columns = static_cast<uint32_t>(heights.shape(1)),
          .rows = static_cast<uint32_t>(heights.shape(0)),
          .heights = {heights.data(), heights.data() + heights.size()}};
}

// A list that Python sees as a tuple.
template <typename Class, typename Object, typename Value>
void defineTuple(Class& bound, const char* name, std::vector<Value> Object::*member, const char* text) {
  bound.def_property(
      name, [=](const Object& self) { return py::tuple(py::cast(self.*member)); },
      [=](Object& self, std::vector<Value> values) { self.*member = std::move(values); }, text);
}

// A place's members under the names that scene files have for them.
template <typename Class, typename Object>
void definePlace(Class& bound, Place Object::*place) {
  bound
      .def_property(
          "position", [=](const Object& self) { return (self.*place).position; },
          [=](Object& self, const glm::vec2& position) { (self.*place).position = position; },
          "x and z, metres.")
      .def_property(
          "heading", [=](const Object& self) { return (self.*place).heading; },
          [=](Object& self, float heading) { (self.*place).heading = heading; },
          "Radians about +Y; 0 faces +Z.");
}

void bindGround(py::module_& module) {
  py::class_<Mound>(module, "Mound", "Ground that rises, or sinks to a pit, with smooth sides.")
      .def(py::init([](const glm::vec2& centre, float radius, float height) {
             return Mound{centre, radius, height};
           }),
           "centre"_a = Mound{}.centre, "radius"_a = Mound{}.radius, "height"_a = Mound{}.height)
      .def_readwrite("centre", &Mound::centre, "x and z, metres.")
      .def_readwrite("radius", &Mound::radius, "Metres.")
      .def_readwrite("height", &Mound::height, "Metres at the centre; below 0: a pit.");
  py::class_<HeightSamples>(module, "HeightSamples", "New heights of a rectangle of the ground's samples.")
      .def(py::init(&samplesOf), "x"_a, "z"_a, "heights"_a,
           "From column `x` and row `z` on, as Crowd.edit_heights().")
      .def_readwrite("x", &HeightSamples::x, "The first column.")
      .def_readwrite("z", &HeightSamples::z, "The first row.")
      .def_property(
          "heights",
          [](const HeightSamples& self) {
            return arrayOf(self.heights, {self.rows, self.columns});
          },
          [](HeightSamples& self, const Floats& heights) { self = samplesOf(self.x, self.z, heights); },
          "Metres above mid height, float32 of shape (rows, columns): a copy.");
}

void bindChanges(py::module_& module) {
  py::class_<GoalChange> goal(module, "GoalChange", "A new goal.");
  goal.def(py::init([](const Goal& to, uint32_t herd, Places agents) {
             return GoalChange{herd, std::move(agents), to};
           }),
           "goal"_a, "herd"_a = 0, "agents"_a = Places{})
      .def_readwrite("herd", &GoalChange::herd, herdText)
      .def_readwrite("goal", &GoalChange::goal, "Where they go.");
  defineTuple(goal, "agents", &GoalChange::agents, agentsText);

  py::class_<SpeedChange> speed(module, "SpeedChange", "A new speed; goals stay.");
  speed
      .def(py::init([](float to, uint32_t herd, Places agents) {
             return SpeedChange{herd, std::move(agents), to};
           }),
           "speed"_a, "herd"_a = 0, "agents"_a = Places{})
      .def_readwrite("herd", &SpeedChange::herd, herdText)
      .def_readwrite("speed", &SpeedChange::speed, "Metres per second.");
  defineTuple(speed, "agents", &SpeedChange::agents, agentsText);

  py::class_<Teleport::Move> move(module, "Move", "An agent that is put elsewhere.");
  move.def(py::init([](uint32_t agent, const glm::vec2& position, float heading) {
             return Teleport::Move{agent, {position, heading}};
           }),
           "agent"_a, "position"_a, "heading"_a = 0.0f)
      .def_readwrite("agent", &Teleport::Move::agent, "Its place in the herd.");
  definePlace(move, &Teleport::Move::place);
  py::class_<Teleport> teleport(module, "Teleport", "Agents of a herd that are put elsewhere; goals stay.");
  teleport
      .def(py::init([](std::vector<Teleport::Move> moves, uint32_t herd) {
             return Teleport{herd, std::move(moves)};
           }),
           "moves"_a, "herd"_a = 0)
      .def_readwrite("herd", &Teleport::herd, herdText);
  defineTuple(teleport, "moves", &Teleport::moves, "A tuple of Move, each a copy.");
}

void bindComing(py::module_& module) {
  py::class_<Addition::Arrival> arrival(module, "Arrival", "An agent that comes.");
  arrival
      .def(py::init([](const glm::vec2& position, float heading, std::optional<Goal> goal) {
             return Addition::Arrival{{position, heading}, goal};
           }),
           "position"_a, "heading"_a = 0.0f, "goal"_a = py::none())
      .def_readwrite("goal", &Addition::Arrival::goal, "Where it goes; None: the herd's.");
  definePlace(arrival, &Addition::Arrival::place);
  py::class_<Addition> addition(module, "Addition", "Agents that come, to a herd with a reserve.");
  addition
      .def(py::init([](std::vector<Addition::Arrival> arrivals, uint32_t herd) {
             return Addition{herd, std::move(arrivals)};
           }),
           "arrivals"_a, "herd"_a = 0)
      .def_readwrite("herd", &Addition::herd, herdText);
  defineTuple(addition, "arrivals", &Addition::arrivals, "A tuple of Arrival, each a copy.");

  py::class_<Removal> removal(module, "Removal", "Agents that go, from a herd with a reserve.");
  removal
      .def(py::init([](Places agents, uint32_t herd) {
             return Removal{herd, std::move(agents)};
           }),
           "agents"_a, "herd"_a = 0)
      .def_readwrite("herd", &Removal::herd, herdText);
  defineTuple(removal, "agents", &Removal::agents, "Their places.");

  py::class_<HerdAddition>(module, "HerdAddition",
                           "A herd that comes; it gets the lowest number that is free.")
      .def(py::init([](const Herd& herd) { return HerdAddition{herd}; }), "herd"_a, "A copy of the herd.")
      .def_readwrite("herd", &HerdAddition::herd, "The herd.");
  py::class_<HerdRemoval>(module, "HerdRemoval", "A herd that goes.")
      .def(py::init([](uint32_t herd) { return HerdRemoval{herd}; }), "herd"_a)
      .def_readwrite("herd", &HerdRemoval::herd, herdText);
}

void bindThreats(py::module_& module) {
  py::class_<ThreatChange> change(module, "ThreatChange",
                                  "A threat that comes, moves or, with radius 0, goes.");
  change
      .def(py::init([](uint32_t number, const glm::vec2& centre, float radius) {
             return ThreatChange{number, {centre, radius}};
           }),
           "number"_a, "centre"_a = glm::vec2(0), "radius"_a = 1.0f)
      .def_readwrite("number", &ThreatChange::number, "0 to 63.")
      .def_property(
          "centre", [](const ThreatChange& self) { return self.threat.centre; },
          [](ThreatChange& self, const glm::vec2& centre) { self.threat.centre = centre; },
          "x and z, metres.")
      .def_property(
          "radius", [](const ThreatChange& self) { return self.threat.radius; },
          [](ThreatChange& self, float radius) { self.threat.radius = radius; }, "Metres; 0: it goes.");
}

void bindLegs(py::module_& module) {
  py::class_<LegChange> change(module, "LegChange", "A leg of some agents, of a herd that can be hurt.");
  change
      .def(py::init([](std::string leg, const std::string& state, uint32_t herd, Places agents,
                       std::optional<float> share, std::optional<uint32_t> bone) {
             return LegChange{.herd = herd,
                              .agents = std::move(agents),
                              .share = share,
                              .leg = std::move(leg),
                              .state = bindings::namedOf(allLegStates, "state", state),
                              .bone = bone};
           }),
           "leg"_a, "state"_a = "lost", "herd"_a = 0, "agents"_a = Places{}, "share"_a = py::none(),
           "bone"_a = py::none())
      .def_readwrite("herd", &LegChange::herd, herdText)
      .def_readwrite("leg", &LegChange::leg, "Its name in the rig.")
      .def_readwrite("share", &LegChange::share,
                     "Each agent is drawn with this chance, 0 to 1; None: all of `agents`.")
      .def_readwrite("bone", &LegChange::bone,
                     "The first bone that is lost, from the root; None: the second one.");
  defineNamed(change, "state", &LegChange::state, allLegStates,
              "\"whole\", \"lame\", \"stuck\" or \"lost\".");
  defineTuple(change, "agents", &LegChange::agents, agentsText);
}

void bindLoads(py::module_& module) {
  py::class_<LoadChange> change(module, "LoadChange", "A load of some agents, of a herd that can be hurt.");
  change
      .def(py::init([](const Load& load, uint32_t herd, Places agents, std::optional<float> share) {
             return LoadChange{.herd = herd, .agents = std::move(agents), .share = share, .load = load};
           }),
           "load"_a, "herd"_a = 0, "agents"_a = Places{}, "share"_a = py::none())
      .def_readwrite("herd", &LoadChange::herd, herdText)
      .def_readwrite("load", &LoadChange::load, "The load; of mass 0: it is laid down.")
      .def_readwrite("share", &LoadChange::share,
                     "Each agent is drawn with this chance, 0 to 1; None: all of `agents`.");
  defineTuple(change, "agents", &LoadChange::agents, agentsText);
}

void bindPushes(py::module_& module) {
  py::class_<Push> push(module, "Push", "A push of some agents, of a herd with reactions.");
  push.def(py::init([](const glm::vec2& velocity, uint32_t herd, Places agents, std::optional<float> share) {
             return Push{.herd = herd, .agents = std::move(agents), .share = share, .velocity = velocity};
           }),
           "velocity"_a, "herd"_a = 0, "agents"_a = Places{}, "share"_a = py::none())
      .def_readwrite("herd", &Push::herd, herdText)
      .def_readwrite("velocity", &Push::velocity,
                     "x and z, metres per second, at most 100 long: what is added to the velocity.")
      .def_readwrite("share", &Push::share,
                     "Each agent is drawn with this chance, 0 to 1; None: all of `agents`.");
  defineTuple(push, "agents", &Push::agents, agentsText);
}

// Takes the object for a `Kind` if it is one.
template <typename Kind>
bool takes(const py::object& object, What& what) {
  if (!py::isinstance<Kind>(object)) return false;
  what = object.cast<const Kind&>();
  return true;
}
template <typename... Kinds>
bool isTaken(const py::object& object, std::variant<Kinds...>& what) {
  return (takes<Kinds>(object, what) || ...);
}

}  // namespace

py::list eventsOf(const Scene& scene) {
  py::list events;
  for (const auto& [at, what] : scene.events)
    events.append(std::make_shared<PythonEvent>(
        PythonEvent{at, std::visit([](const auto& each) { return py::cast(each); }, what)}));
  return events;
}

std::vector<Event> eventsIn(const py::list& events) {
  std::vector<Event> made;
  for (const py::handle item : events) {
    const auto fail = [&](const char* member, const py::handle& found, const char* expected) {
      throw inputError(fmt::format("events[{}]{} is {}, expected {}", made.size(), member,
                                   py::repr(found).cast<std::string>(), expected));
    };
    if (!py::isinstance<PythonEvent>(item)) fail("", item, "an Event");
    const auto& event = item.cast<const PythonEvent&>();
    Event one{.at = event.at, .what = {}};
    if (!isTaken(event.what, one.what))
      fail(".what", event.what,
           "a Mound, HeightSamples, GoalChange, SpeedChange, Teleport, Addition, Removal, HerdAddition, "
           "HerdRemoval, ThreatChange, LegChange, LoadChange or Push");
    made.push_back(std::move(one));
  }
  return made;
}

void bindEvents(py::module_& module) {
  bindGround(module);
  bindChanges(module);
  bindComing(module);
  bindThreats(module);
  bindLegs(module);
  bindLoads(module);
  bindPushes(module);
  py::class_<PythonEvent, std::shared_ptr<PythonEvent>>(
      module, "Event", "What happens to a crowd while it runs, at a time (docs/scene.md).")
      .def(py::init([](float at, py::object what) {
             return PythonEvent{at, std::move(what)};
           }),
           "at"_a, "what"_a)
      .def_readwrite("at", &PythonEvent::at,
                     "Seconds from the start: before the first tick that ends then or later.")
      .def_readwrite("what", &PythonEvent::what,
                     "A Mound, HeightSamples, GoalChange, SpeedChange, Teleport, Addition, Removal, "
                     "HerdAddition, HerdRemoval, ThreatChange, LegChange, LoadChange or Push.")
      .def("__repr__", [](const PythonEvent& self) {
        return fmt::format("<skitter.Event at {} s: {}>", self.at,
                           py::type::of(self.what).attr("__name__").cast<std::string>());
      });
}

}  // namespace skitter::python
