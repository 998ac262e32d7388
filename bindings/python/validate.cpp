#include "bindings/common/walk.h"
#include "bindings/python/crowd.h"
#include "validation/lockstep/lockstep.h"

namespace skitter::python {
namespace {

using namespace py::literals;
using validation::StageResult;

// A validation on one device.
struct Outcome {
  std::string device;
  uint64_t ticks = 0;
  std::vector<StageResult> stages = {};

  bool passed() const {
    return std::all_of(stages.begin(), stages.end(), [](const StageResult& stage) { return stage.pass; });
  }
};

std::vector<StageResult> replay(SharedDevice& device, const Scene& scene, const Heightfield& terrain,
                                uint64_t ticks, float dt, const std::vector<crowd::StageId>& stages,
                                const CrowdOptions& options) {
  Signals signals;
  Crowd crowd(device.device, terrain, scene, options);
  bindings::Walk walk(device.device);
  validation::Lockstep lockstep(crowd, scene, dt, stages);
  while (crowd.tick() < ticks) {
    signals.check();
    lockstep.begin();
    walk.step(crowd, 1, dt);
    lockstep.end();
  }
  return lockstep.results();
}

Outcome validate(const PythonScene& from, uint64_t frames, std::shared_ptr<SharedDevice> device,
                 const std::optional<std::vector<std::string>>& stages,
                 const std::shared_ptr<Heightfield>& terrain, float dt, bool sleep, bool fuse,
                 uint32_t pageAgents) {
  const Scene scene = from.scene();
  if (frames == 0) throw inputError("frames is 0, expected at least 1");
  std::vector<crowd::StageId> asked;
  if (stages)
    for (const std::string& name : *stages)
      asked.push_back(bindings::namedOf(crowd::allStages, "stages", name));
  validation::expectComparable(scene, asked, "stages");
  CrowdOptions options;
  options.footfalls = UINT32_MAX;  // all that can be
  options.sleep = sleep;
  options.fuse = fuse;
  options.pageAgents = pageAgents;
  if (!device) {
    const py::gil_scoped_release release;
    device = std::make_shared<SharedDevice>(Device::create());
  }
  const Turn turn(*device);
  return {device->device.report().name, frames,
          replay(*device, scene, terrain ? *terrain : scene.loadTerrain(), frames, dt, asked, options)};
}

}  // namespace

void bindValidation(py::module_& module) {
  py::class_<StageResult>(module, "StageResult", "How a stage compared with the reference.")
      .def_readonly("name", &StageResult::name, "The stage's name.")
      .def_readonly("samples", &StageResult::samples, "Agents, legs or joints compared, each in each tick.")
      .def_readonly("kept", &StageResult::kept, "Records that had to stay as they were, and did.")
      .def_readonly("maxError", &StageResult::maxError,
                    "The error of the quantity that is worst relative to its own tolerance.")
      .def_readonly("tolerance", &StageResult::tolerance, "The tolerance of that quantity, in that sample.")
      .def_property_readonly("ratio", &StageResult::ratio, "That error over that tolerance.")
      .def_readonly("ties", &StageResult::ties,
                    "Samples in which rounding decided otherwise, and all else is right for that.")
      .def_readonly("worst", &StageResult::worst, "That quantity, with agent, leg, expected and found.")
      .def_readonly("passed", &StageResult::pass,
                    "Whether something was compared, and all of it within its tolerance.")
      .def_readonly("why", &StageResult::why, "Every reason why it did not pass; else empty.");
  py::class_<Outcome>(module, "Validation",
                      "The outcome of validate(), which is true where every stage passed.")
      .def_readonly("device", &Outcome::device, "The name of the device.")
      .def_readonly("ticks", &Outcome::ticks, "Ticks compared.")
      .def_property_readonly(
          "stages",
          [](const Outcome& self) {
            py::dict stages;
            for (const StageResult& stage : self.stages) stages[stage.name.c_str()] = stage;
            return stages;
          },
          "A StageResult for each stage, by name, in the order of a tick.")
      .def_property_readonly("passed", &Outcome::passed, "Whether every stage passed.")
      .def("__bool__", &Outcome::passed)
      .def("__str__", [](const Outcome& self) { return validation::table(self.stages); })
      .def("__repr__", [](const Outcome& self) {
        return fmt::format("<skitter.Validation of {} ticks: {}>", self.ticks,
                           self.passed() ? "passed" : "FAILED");
      });
  module.def("validate", &validate, "scene"_a, "frames"_a = 120, "device"_a = py::none(),
             "stages"_a = py::none(), py::kw_only(), "terrain"_a = py::none(), "dt"_a = usualTick,
             "sleep"_a = false, "fuse"_a = true, "page_agents"_a = 0,
             R"(Holds every stage of `frames` ticks against the CPU reference in double precision.

A frame is one tick, as for `skitter validate`. The reference takes about a millisecond per agent and tick. Of
more than 1,024 agents of one size in a herd a part is compared, another one in each tick. stages: names
of those to compare; None: all that the herds have. device: None: the best one. terrain, sleep, fuse,
page_agents: as for a Crowd. Ctrl-C ends it between two ticks.)");
}

}  // namespace skitter::python
