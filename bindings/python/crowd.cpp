#include "bindings/python/crowd.h"

#include <limits>

#include "crowd/figures.h"
#include "crowd/record.h"

namespace skitter::python {
namespace {

using namespace py::literals;

std::unique_ptr<PythonCrowd> makeCrowd(const std::shared_ptr<SharedDevice>& device, const PythonScene& from,
                                       const std::shared_ptr<Heightfield>& terrain,
                                       const CrowdOptions& options) {
  Scene scene = from.scene();
  const Turn turn(*device);
  return std::make_unique<PythonCrowd>(device, scene, terrain ? *terrain : scene.loadTerrain(), options);
}

void step(PythonCrowd& self, uint64_t ticks, std::optional<float> dt) {
  Signals signals;
  const Turn turn(*self.device);
  const float wanted = dt ? *dt : self.dt() != 0 ? self.dt() : usualTick;
  self.walk.step(self.crowd, ticks, wanted, [&] {
    signals.check();
    return true;
  });
}

py::array_t<uint8_t> render(PythonCrowd& self, uint32_t width, uint32_t height,
                            const std::optional<View>& view, float detail, float scale, bool footprints,
                            std::optional<bool> occlusion) {
  std::vector<uint8_t> pixels;
  std::vector<std::string> news;
  {
    const Turn turn(*self.device);
    const bool fits = self.renderer && self.renderer->width() == width && self.renderer->height() == height;
    const RendererOptions drawing{
        .detail = detail, .scale = scale, .footprints = footprints, .occlusion = occlusion};
    if (!fits || self.drawing != drawing) {
      self.renderer.reset();
      self.renderer.emplace(self.device->device, self.crowd, width, height, drawing);
      self.drawing = drawing;
      self.warned = 0;
    }
    const double seconds = static_cast<double>(self.crowd.tick()) * double{self.dt()};
    self.walk.run([&](VkCommandBuffer commands) {
      self.renderer->record(commands, view ? *view : viewOf(self.scene, self.crowd, seconds));
    });
    pixels = self.renderer->download();
    const std::vector<std::string>& notes = self.renderer->notes();
    news.assign(notes.begin() + static_cast<std::ptrdiff_t>(self.warned), notes.end());
    self.warned = notes.size();
  }
  for (const std::string& note : news)
    if (PyErr_WarnEx(PyExc_UserWarning, note.c_str(), 1) != 0) throw py::error_already_set();
  return arrayOf(std::move(pixels), {height, width, 4});
}

py::dict figuresOf(const Fidelity& fidelity) {
  py::dict figures;
  crowd::eachFigure(fidelity, [&](const char* name, const auto& value) { figures[name] = py::cast(value); });
  return figures;
}

py::dict agentFiguresOf(const std::vector<Fidelity>& agents) {
  std::vector<const char*> names;
  std::vector<std::vector<double>> columns;
  crowd::eachFigure(Fidelity{}, [&](const char* name, const auto&) {
    names.push_back(name);
    columns.emplace_back().reserve(agents.size());
  });
  for (const Fidelity& agent : agents) {
    auto column = columns.begin();
    crowd::eachFigure(agent, [&](const char*, const auto& value) {
      if constexpr (requires { value.has_value(); })
        (column++)->push_back(value.value_or(std::numeric_limits<double>::quiet_NaN()));
      else
        (column++)->push_back(static_cast<double>(value));
    });
  }
  py::dict figures;
  for (size_t i = 0; i < names.size(); ++i) figures[names[i]] = listOf(std::move(columns[i]));
  return figures;
}

struct FootfallRow {
  uint32_t agent, leg;
  uint64_t tick;
  double seconds;
  float place[3];
  float speed;
};

py::array_t<FootfallRow> footfalls(PythonCrowd& self, uint32_t herd) {
  const std::vector<Footfall> events = self.told([&](const Crowd& crowd) { return crowd.footfalls(herd); });
  std::vector<FootfallRow> rows;
  rows.reserve(events.size());
  for (const Footfall& e : events)
    rows.push_back({e.agent, e.leg, e.tick, e.seconds, {e.place.x, e.place.y, e.place.z}, e.speed});
  return listOf(std::move(rows));
}

bool isOfLegs(Record record) { return crowd::infoOf(record).per == crowd::Per::leg; }

py::dict records(PythonCrowd& self, uint32_t herd) {
  HerdState state;
  uint32_t legs = 0;
  self.told([&](const Crowd& crowd) {
    legs = bindings::legsOf(crowd, herd);
    state = bindings::recordsOf(crowd, herd);
  });
  py::dict arrays;
  for (const Record record : allRecords) {
    std::vector<float>& values = state.of(record);
    if (values.empty()) continue;
    std::vector<py::ssize_t> shape{state.agents};
    if (isOfLegs(record)) shape.push_back(legs);
    shape.push_back(static_cast<py::ssize_t>(values.size() / state.agents / (isOfLegs(record) ? legs : 1)));
    arrays[crowd::infoOf(record).name] = arrayOf(std::move(values), std::move(shape));
  }
  return arrays;
}

void editHeights(PythonCrowd& self, uint32_t x, uint32_t z, const Floats& heights) {
  if (heights.ndim() != 2)
    throw inputError(fmt::format("heights have shape {}, expected (rows, columns)", shapeOf(heights)));
  const auto rows = static_cast<uint32_t>(heights.shape(0)),
             columns = static_cast<uint32_t>(heights.shape(1));
  const std::span<const float> samples(heights.data(), static_cast<size_t>(heights.size()));
  self.told([&](Crowd& crowd) { crowd.editHeights(x, z, columns, rows, samples); });
}

py::dict memoryUse(PythonCrowd& self, uint32_t herd) {
  const auto uses = self.told([&](const Crowd& crowd) { return crowd.memoryUse(herd); });
  py::dict bytes;
  for (const MemoryUse& use : uses) bytes[use.name.c_str()] = use.bytes;
  return bytes;
}

// Of each agent, `take` of its body.
template <typename Take>
auto eachBody(PythonCrowd& self, uint32_t herd, Take take) {
  const auto bodies = self.told([&](const Crowd& crowd) { return bindings::bodiesOf(crowd, herd); });
  std::vector<decltype(take(bodies.front()))> values;
  values.reserve(bodies.size());
  for (const BodyState& body : bodies) values.push_back(take(body));
  return values;
}

void bindMaking(CrowdClass& bound) {
  bound.def(
      py::init([](const std::shared_ptr<SharedDevice>& device, const PythonScene& scene,
                  const std::shared_ptr<Heightfield>& terrain, bool pose, bool measure, uint32_t watchEvery,
                  bool feet, uint32_t footfallRoom, bool sleep, bool fuse, bool timestamps,
                  uint32_t pageAgents, const std::optional<Levels>& levels) -> std::shared_ptr<PythonCrowd> {
        CrowdOptions options;
        options.pose = pose;
        options.measure = measure;
        options.watchEvery = watchEvery;
        options.feet = feet;
        options.footfalls = footfallRoom;
        options.sleep = sleep;
        options.fuse = fuse;
        options.timestamps = timestamps;
        options.pageAgents = pageAgents;
        options.levels = levels;
        return makeCrowd(device, scene, terrain, options);
      }),
      "device"_a, "scene"_a, "terrain"_a = py::none(), py::kw_only(), "pose"_a = true, "measure"_a = true,
      "watch_every"_a = 0, "feet"_a = false, "footfalls"_a = 0, "sleep"_a = false, "fuse"_a = true,
      "timestamps"_a = false, "page_agents"_a = 0, "levels"_a = py::none(),
      R"(The scene's herds, on its terrain or on the one that is given.

pose: bones, for joints() and render(). measure: the figures of fidelity(). watch_every: figures of one agent of
this many at a time; 0: of all in a crowd of at most 256, of one in 64 in a larger one. feet: keep the records
foot and tip. footfalls: keep so many touchdowns per tick and page; 0: none. sleep: agents that have stood
still for seconds are passed over. fuse: stages that are faster when fused are fused. timestamps: time every
stage. page_agents: most agents of a page of records; 0: as many as the device allows. levels: of rate; None:
those of the scene, if it has any.)");
}

void bindTicks(CrowdClass& bound) {
  bound
      .def(
          "step", &step, "ticks"_a = 1, "dt"_a = py::none(),
          "Makes so many ticks of `dt` seconds and waits for the last one; each is recorded while the device "
          "still runs the one before. Without `dt` it is that of the first tick, at first 1/60 s; it must "
          "stay "
          "the same. Ctrl-C ends it between two ticks.")
      .def_property_readonly(
          "tick", [](PythonCrowd& self) { return self.told([](const Crowd& c) { return c.tick(); }); },
          "Ticks made so far.")
      .def("edit_heights", &editHeights, "x"_a, "z"_a, "heights"_a,
           "Replaces samples of the ground, before the next tick, from column `x` and row `z` on. `heights` "
           "has "
           "shape (rows, columns), metres above mid height as made. Feet whose ground moves step anew.")
      .def(
          "terrain",
          [](PythonCrowd& self) {
            return self.told([](const Crowd& c) { return std::make_shared<Heightfield>(c.terrain()); });
          },
          "A copy of the ground as edited.");
}

void bindFacts(CrowdClass& bound) {
  bound
      .def_property_readonly(
          "herd_count",
          [](PythonCrowd& self) { return self.told([](const Crowd& c) { return c.herdCount(); }); },
          "Numbers of herds, those of herds that are gone among them.")
      .def_property_readonly(
          "agent_count",
          [](PythonCrowd& self) { return self.told([](const Crowd& c) { return c.agentCount(); }); },
          "Agents that are there, of all herds.")
      .def(
          "agents",
          [](PythonCrowd& self, uint32_t herd) {
            return self.told([&](const Crowd& c) { return c.agentCount(herd); });
          },
          "herd"_a = 0, "Agents of the herd that are there.")
      .def(
          "places",
          [](PythonCrowd& self, uint32_t herd) {
            return self.told([&](const Crowd& c) { return c.places(herd); });
          },
          "herd"_a = 0,
          "Places of the herd: its agents and its reserve. Arrays have a row for each, also where nobody is.")
      .def(
          "rig",
          [](PythonCrowd& self, uint32_t herd, std::optional<uint32_t> agent) {
            return self.told([&](const Crowd& c) {
              return std::make_shared<Rig>(agent ? c.rig(herd, *agent) : c.rig(herd));
            });
          },
          "herd"_a = 0, "agent"_a = py::none(),
          "The herd's rig, at the first of its sizes or at the size of an agent.")
      .def(
          "sizes",
          [](PythonCrowd& self, uint32_t herd) {
            return listOf(self.told([&](const Crowd& c) { return bindings::sizesOf(c, herd); }));
          },
          "herd"_a = 0,
          "How large the creature of each place is, times the rig that was loaded: float32 of shape "
          "(places,). A herd with Herd.sizes numbers its places size after size.")
      .def_property_readonly(
          "watch_every",
          [](PythonCrowd& self) { return self.told([](const Crowd& c) { return c.watchEvery(); }); },
          "Figures are of one agent of this many at a time.")
      .def_property_readonly(
          "memory_bytes",
          [](PythonCrowd& self) { return self.told([](const Crowd& c) { return c.memoryBytes(); }); },
          "Device memory of all records.")
      .def("memory_use", &memoryUse, "herd"_a = 0, "Bytes of device memory by kind of record.")
      .def(
          "state_hash",
          [](PythonCrowd& self) { return self.told([](const Crowd& c) { return c.stateHash(); }); },
          "A hash of every record that the next tick depends on: the same device, scene, seed and ticks give "
          "the same.")
      .def(
          "sleeping",
          [](PythonCrowd& self) { return self.told([](const Crowd& c) { return c.sleeping(); }); },
          "Agents that slept in the last tick; 0 without `sleep`.")
      .def(
          "stage_times",
          [](PythonCrowd& self) {
            py::dict milliseconds;
            for (const StageTime& time : self.told([](const Crowd& c) { return c.stageTimes(); }))
              milliseconds[time.stage.c_str()] = time.milliseconds;
            return milliseconds;
          },
          "Milliseconds of each stage of the last tick; empty without `timestamps`.")
      .def("__repr__", [](PythonCrowd& self) {
        return self.told([](const Crowd& c) {
          return fmt::format("<skitter.Crowd of {} agents at tick {}>", c.agentCount(), c.tick());
        });
      });
}

void bindPlaces(CrowdClass& bound) {
  bound
      .def(
          "positions",
          [](PythonCrowd& self, uint32_t herd) {
            return rowsOf(self.told([&](const Crowd& c) { return bindings::positionsOf(c, herd); }));
          },
          "herd"_a = 0,
          "Where bodies are, world metres: float64 of shape (places, 3). Where nobody is, y is -1,000,000.")
      .def(
          "headings",
          [](PythonCrowd& self, uint32_t herd) {
            return listOf(
                eachBody(self, herd, [](const BodyState& body) { return bindings::headingOf(body); }));
          },
          "herd"_a = 0,
          "Where bodies look, radians about +Y: 0 is +Z, a quarter turn +X. float32 of shape (places,).")
      .def(
          "speeds",
          [](PythonCrowd& self, uint32_t herd) {
            return listOf(
                eachBody(self, herd, [](const BodyState& body) { return glm::length(body.velocity); }));
          },
          "herd"_a = 0, "Horizontal, along the heading, metres per second: float32 of shape (places,).")
      .def(
          "rotations",
          [](PythonCrowd& self, uint32_t herd) {
            return rowsOf(eachBody(self, herd, [](const BodyState& body) { return body.rotation; }));
          },
          "herd"_a = 0,
          "Rotations of bodies, world from model, quaternions x, y, z, w: float32 of shape (places, 4).")
      .def(
          "joints",
          [](PythonCrowd& self, uint32_t herd) {
            std::vector<glm::dvec3> joints;
            uint32_t places = 0, legs = 0, bones = 0;
            self.told([&](const Crowd& c) {
              joints = bindings::jointsOf(c, herd);
              places = c.places(herd);
              legs = bindings::legsOf(c, herd);
              bones = bindings::bonesOf(c, herd);
            });
            return rowsOf(std::move(joints), {places, legs, bones + 1});
          },
          "herd"_a = 0,
          "Joints of the legs from root to foot, world metres: float64 of shape (places, legs, bones + 1, "
          "3). NaN "
          "fills up legs with fewer bones. Needs `pose`.")
      .def("footfalls", &footfalls, "herd"_a = 0,
           "The touchdowns of the last tick, by agent and leg: a structured array of agent, leg, tick, "
           "seconds, "
           "place (the foot's position, world metres), speed (of the foot, m/s). Needs `footfalls`.")
      .def(
          "dropped_footfalls",
          [](PythonCrowd& self, uint32_t herd) {
            return self.told([&](const Crowd& c) { return c.droppedFootfalls(herd); });
          },
          "herd"_a = 0, "Touchdowns that there was no room for, since the start.");
}

void bindRecords(CrowdClass& bound) {
  bound
      .def(
          "fidelity",
          [](PythonCrowd& self, std::optional<uint32_t> herd) {
            return figuresOf(self.told([&](const Crowd& c) {
              if (!herd) return c.fidelity();
              return c.fidelity(*herd);
            }));
          },
          "herd"_a = py::none(),
          "How well agents moved while they were watched, of a herd or of all: a dict with the names of "
          "files of "
          "figures (docs/stages/measure.md). Lengths are in leg lengths. A figure without a sample is 0; "
          "limits that "
          "nobody keeps are None.")
      .def(
          "agent_fidelity",
          [](PythonCrowd& self, uint32_t herd) {
            return agentFiguresOf(self.told([&](const Crowd& c) { return c.agentFidelity(herd); }));
          },
          "herd"_a = 0,
          "The same agent by agent: a dict of float64 arrays of shape (places,); NaN stands for None.")
      .def("records", &records, "herd"_a = 0,
           "The herd's records by name (skitter/records.h has the layouts): float32 of shape "
           "(places, "
           "numbers), or (places, legs, numbers) for records of legs.");
}

}  // namespace

void bindCrowd(py::module_& module) {
  PYBIND11_NUMPY_DTYPE(FootfallRow, agent, leg, tick, seconds, place, speed);
  py::class_<View>(module, "View", "Where a picture is taken from.")
      .def(py::init([](const glm::vec3& eye, const glm::vec3& target, float fieldOfView) {
             return View{eye, target, fieldOfView};
           }),
           "eye"_a, "target"_a, "fieldOfView"_a = View{}.fieldOfView)
      .def_readwrite("eye", &View::eye, "World metres.")
      .def_readwrite("target", &View::target, "World metres.")
      .def_readwrite("fieldOfView", &View::fieldOfView, "Radians, vertical.");
  CrowdClass bound(
      module, "Crowd",
      "The herds of a scene on one terrain, living on one device. Herds and agents are numbered from 0.");
  bindMaking(bound);
  bindTicks(bound);
  bindSteering(bound);
  bindPicking(module, bound);
  bindFacts(bound);
  bindPlaces(bound);
  bindRecords(bound);
  bindStates(module, bound);
  bindRates(bound);
  bound.def(
      "render", &render, "width"_a = 1280, "height"_a = 720, "view"_a = py::none(), "detail"_a = 1.0f,
      "scale"_a = 1.0f, "footprints"_a = false, "occlusion"_a = py::none(),
      "A picture of the crowd and its ground, by the scene's camera or from a View: RGBA8 sRGB, uint8 "
      "of shape (height, width, 4), top row first. Agents are drawn as finely as if they were `detail` "
      "times larger, 0.25 to 100000; less is cheaper. `scale`, 0.25 to 1, is the share of each side's "
      "pixels that are shaded, from which the picture is enlarged. `footprints`: feet of adaptive "
      "herds leave prints, as long as size and options stay. `occlusion`: whether agents whom others or "
      "the ground hide are left out, which changes no picture; None: where it pays.");
}

}  // namespace skitter::python
