#include "skitter/ik.h"

#include "bindings/python/bind.h"

namespace skitter::python {
namespace {

using namespace py::literals;

constexpr std::array startNames{"rest", "previous"};

// Ball and hinge limits; none is free.
using Limited = std::variant<ik::Cone, ik::Ellipse, ik::Hinge>;

struct PythonBatch {
  std::shared_ptr<SharedDevice> device;
  ik::Batch batch;

  PythonBatch(std::shared_ptr<SharedDevice> on, const ik::Chain& chain, uint32_t chains,
              const ik::Options& options)
      : device(std::move(on)), batch(device->device, chain, chains, options) {}

  template <typename Ask>
  auto told(Ask ask) {
    const Turn turn(*device);
    return ask(batch);
  }
  void checkCount(const char* name, size_t count, size_t expected) const {
    if (count != expected) throw inputError(fmt::format("{} {}, expected {}", count, name, expected));
  }
};

struct ReportRow {
  float error;
  uint32_t iterations, stop;
};

py::array_t<float> joints(PythonBatch& self) {
  auto all = self.told([](const ik::Batch& batch) { return batch.downloadJoints(); });
  return rowsOf(std::move(all), {self.batch.chains(), self.batch.joints()});
}

py::array_t<float> solve(PythonBatch& self, const std::optional<Floats>& targets) {
  std::vector<glm::vec3> points;
  if (targets) {
    points = pointsOf(*targets, "targets");
    self.checkCount("targets", points.size(), self.batch.chains());
  }
  self.told([&](ik::Batch& batch) {
    if (targets) batch.setTargets(points);
    batch.solve();
  });
  return joints(self);
}

py::array_t<ReportRow> reports(PythonBatch& self) {
  std::vector<ReportRow> rows;
  for (const ik::Report& report : self.told([](const ik::Batch& batch) { return batch.downloadReports(); }))
    rows.push_back({report.error, report.iterations, static_cast<uint32_t>(report.stop)});
  return listOf(std::move(rows));
}

void setBases(PythonBatch& self, const Floats& positions, const std::optional<Floats>& rotations) {
  const std::vector<glm::vec3> places = pointsOf(positions, "positions");
  self.checkCount("positions", places.size(), self.batch.chains());
  if (rotations && (rotations->ndim() != 2 || rotations->shape(1) != 4 ||
                    static_cast<size_t>(rotations->shape(0)) != places.size()))
    throw inputError(
        fmt::format("rotations have shape {}, expected ({}, 4)", shapeOf(*rotations), places.size()));
  std::vector<ik::Base> bases;
  for (size_t i = 0; i < places.size(); ++i) {
    ik::Base base{.position = places[i]};
    if (rotations) {
      const float* q = rotations->data() + 4 * i;
      base.rotation = glm::quat(q[3], q[0], q[1], q[2]);
    }
    bases.push_back(base);
  }
  self.told([&](ik::Batch& batch) { batch.setBases(bases); });
}

py::array_t<float> rotations(PythonBatch& self) {
  auto all = self.told([](const ik::Batch& batch) { return batch.downloadRotations(); });
  return rowsOf(std::move(all), {self.batch.chains(), self.batch.joints() - 1});
}

void bindChains(py::module_& module) {
  py::class_<ik::Cone>(module, "Cone", "A bone stays within an angle of its rest direction.")
      .def(py::init([](float halfAngle) { return ik::Cone{halfAngle}; }), "halfAngle"_a, "Radians, above 0.")
      .def_readwrite("halfAngle", &ik::Cone::halfAngle, "Radians.");
  py::class_<ik::Ellipse>(module, "Ellipse",
                          "A cone with another half-angle toward each side of the bone's frame.")
      .def(py::init([](float px, float py, float nx, float ny) {
             return ik::Ellipse{px, py, nx, ny};
           }),
           "px"_a, "py"_a, "nx"_a, "ny"_a, "Radians toward +x, +y, -x and -y, each above 0 and at most 3.1.")
      .def_readwrite("px", &ik::Ellipse::px, "Radians toward +x.")
      .def_readwrite("py", &ik::Ellipse::py, "Radians toward +y.")
      .def_readwrite("nx", &ik::Ellipse::nx, "Radians toward -x.")
      .def_readwrite("ny", &ik::Ellipse::ny, "Radians toward -y.");
  py::class_<ik::Hinge>(module, "Hinge", "A bone turns about one axis.")
      .def(py::init([](const glm::vec3& axis, float min, float max) {
             return ik::Hinge{axis, min, max};
           }),
           "axis"_a, "min"_a, "max"_a,
           "`axis` in the chain's rest axes, not along the bone; radians, at most 3.1 either way.")
      .def_readwrite("axis", &ik::Hinge::axis, "In the chain's rest axes.")
      .def_readwrite("min", &ik::Hinge::min, "Radians.")
      .def_readwrite("max", &ik::Hinge::max, "Radians.");

  py::class_<ik::Bone>(module, "Bone", "A bone of a chain, at rest.")
      .def(py::init([](float length, const glm::vec3& direction, const std::optional<Limited>& limit,
                       const std::pair<float, float>& twist, float stiffness) {
             ik::Bone bone{.length = length,
                           .direction = direction,
                           .twistMin = twist.first,
                           .twistMax = twist.second,
                           .stiffness = stiffness};
             if (limit) bone.limit = std::visit([](const auto& kind) { return ik::Limit(kind); }, *limit);
             return bone;
           }),
           "length"_a, "direction"_a = glm::vec3(0, 1, 0), "limit"_a = py::none(),
           "twist"_a = std::pair(0.0f, 0.0f), "stiffness"_a = 1.0f,
           "`length` in the caller's unit; `direction` of any length but 0; `limit`: None, a Cone, an "
           "Ellipse or a "
           "Hinge; `twist` about the bone from and to, radians; `stiffness` of the pull to the rest pose.")
      .def_readwrite("length", &ik::Bone::length, "In the caller's unit.")
      .def_readwrite("direction", &ik::Bone::direction, "At rest.")
      .def_readwrite("stiffness", &ik::Bone::stiffness, "Of the pull to the rest pose.");

  py::class_<ik::Chain>(module, "Chain", "The kind of chain that a batch solves, from its base at 0.")
      .def(py::init([](std::vector<ik::Bone> bones, const std::optional<glm::vec3>& pole) {
             ik::Chain chain{std::move(bones), pole};
             ik::check(chain);
             return chain;
           }),
           "bones"_a, "pole"_a = py::none(),
           "1 to 15 bones; `pole`: to which side it should fold, where it may fold two ways. Raises "
           "InputError for "
           "one that cannot be.")
      .def_property_readonly(
          "bones", [](const ik::Chain& self) { return py::tuple(py::cast(self.bones)); }, "From the base on.")
      .def_property_readonly("reach", &ik::Chain::reach, "The sum of the lengths.")
      .def(
          "rest", [](const ik::Chain& self) { return rowsOf(self.rest()); },
          "Its joints at rest, base first: float32 of shape (joints, 3).");
}

}  // namespace

void bindIk(py::module_& parent) {
  py::module_ module =
      parent.def_submodule("ik", "Inverse kinematics of many equal chains at once (docs/ik.md).");
  bindChains(module);
  PYBIND11_NUMPY_DTYPE(ReportRow, error, iterations, stop);
  module.attr("stop_names") =
      py::tuple(py::cast(std::vector<std::string>(ik::stopNames.begin(), ik::stopNames.end())));
  module.attr("solvers") = namesTuple(allSolvers);

  py::class_<PythonBatch>(module, "Batch", "Chains of one kind on a device.")
      .def(py::init([](const std::shared_ptr<SharedDevice>& device, const ik::Chain& chain, uint32_t chains,
                       const std::string& solver, const std::string& start, float tolerance,
                       uint32_t iterations, bool restarts, std::optional<float> restPull, bool bases,
                       bool keepRotations) {
             ik::Options options;
             options.solver = bindings::namedOf(allSolvers, "solver", solver);
             if (start != startNames[0] && start != startNames[1])
               throw inputError(
                   fmt::format("start is \"{}\", expected one of {}", start, fmt::join(startNames, ", ")));
             options.start = start == startNames[0] ? ik::Start::rest : ik::Start::previous;
             options.tolerance = tolerance;
             options.iterations = iterations;
             options.restarts = restarts;
             options.restPull = restPull;
             options.bases = bases;
             options.rotations = keepRotations;
             const Turn turn(*device);
             return std::make_unique<PythonBatch>(device, chain, chains, options);
           }),
           "device"_a, "chain"_a, "chains"_a, py::kw_only(), "solver"_a = "auto", "start"_a = "rest",
           "tolerance"_a = ik::Options{}.tolerance, "iterations"_a = 0, "restarts"_a = true,
           "rest_pull"_a = py::none(), "bases"_a = false, "rotations"_a = false,
           R"(So many chains.

solver: one of skitter.ik.solvers. start: "rest", or "previous" to go on from the solve before. tolerance: share of
the reach. iterations: at most; 0: 20 for free chains, 64 for limited ones, 4 where solves go on. restarts: of the
active set, from seed poses. rest_pull: share of the angle from rest taken back an iteration. bases: each chain has
a base that may move. rotations: keep the bones' rotations.)")
      .def(
          "set_targets",
          [](PythonBatch& self, const Floats& targets) {
            const std::vector<glm::vec3> points = pointsOf(targets, "targets");
            self.checkCount("targets", points.size(), self.batch.chains());
            self.told([&](ik::Batch& batch) { batch.setTargets(points); });
          },
          "targets"_a, "One per chain, relative to its base or, with bases, in the world: shape (chains, 3).")
      .def("set_bases", &setBases, "positions"_a, "rotations"_a = py::none(),
           "With `bases`: positions of shape (chains, 3), quaternions x, y, z, w of shape (chains, 4).")
      .def(
          "reset", [](PythonBatch& self) { self.told([](ik::Batch& batch) { batch.reset(); }); },
          "Every chain to its rest pose.")
      .def("solve", &solve, "targets"_a = py::none(),
           "Solves every chain for these targets, or for those set last, and returns joints().")
      .def("joints", &joints, "Joints, base first: float32 of shape (chains, joints, 3).")
      .def("rotations", &rotations,
           "With `rotations`: of the bones, world from rest, quaternions x, y, z, w: float32 of shape "
           "(chains, bones, "
           "4).")
      .def("reports", &reports,
           "Of the last solve, one per chain: a structured array of error (of the tip, share of the reach), "
           "iterations, "
           "stop (an index of skitter.ik.stop_names).")
      .def_property_readonly(
          "chains", [](const PythonBatch& self) { return self.batch.chains(); }, "Chains.")
      .def_property_readonly(
          "solver", [](const PythonBatch& self) { return nameOf(self.batch.solver()); },
          "What \"auto\" stands for.")
      .def_property_readonly(
          "iterations", [](const PythonBatch& self) { return self.batch.iterations(); }, "At most.");
}

}  // namespace skitter::python
