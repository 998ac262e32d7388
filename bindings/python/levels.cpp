#include "skitter/levels.h"

#include "bindings/python/crowd.h"

namespace skitter::python {

using namespace py::literals;

void bindLevels(py::module_& module) {
  py::class_<Levels>(
      module, "Levels",
      "Levels of rate (docs/levels.md): who is far from the camera ticks in every second, fourth "
      "or eighth tick.")
      .def(py::init([](const std::array<float, Levels::count - 1>& distances,
                       const std::array<uint32_t, Levels::count - 1>& most) {
             return Levels{.distances = distances, .most = most};
           }),
           "distances"_a = Levels{}.distances, "most"_a = Levels{}.most)
      .def_static("load", &loadLevels, "file_or_default"_a = "default", R"("default", or a JSON file.)")
      .def_readwrite("distances", &Levels::distances,
                     "Metres from the camera to which full, half and quarter rate reach.")
      .def_readwrite("most", &Levels::most, "Agents that may have full, half and quarter rate.");
  py::class_<LevelFigures>(module, "LevelFigures", "What became of a level.")
      .def_readonly("rate", &LevelFigures::rate, "Its agents tick in every so many-th tick.")
      .def_readonly("agents", &LevelFigures::agents, "That have it after the last tick.")
      .def_readonly("agentTicks", &LevelFigures::agentTicks, "That were made at it.")
      .def_readonly(
          "slip", &LevelFigures::slip,
          "Mean slide of a planted foot per stance, leg lengths; None without a stance or figures.");
}

void bindRates(CrowdClass& bound) {
  bound
      .def(
          "look_from",
          [](PythonCrowd& self, const glm::vec3& camera) {
            self.told([&](Crowd& crowd) { crowd.lookFrom(camera); });
          },
          "camera"_a,
          "Where the camera is from the next tick on: rates depend on it, where the crowd has levels. Before "
          "the first call everybody has full rate.")
      .def(
          "levels", [](PythonCrowd& self) { return self.told([](const Crowd& c) { return c.levels(); }); },
          "LevelFigures of each level, full rate first; none without levels.");
}

}  // namespace skitter::python
