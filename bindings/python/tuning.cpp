#include "skitter/tuning.h"
#include "bindings/python/bind.h"

namespace skitter::python {
namespace {

void set(Tuning& tuning, const std::string& name, float value) {
  for (const TuningInfo& info : allTunings)
    if (name == info.name) {
      tuning.*info.member = value;
      return;
    }
  throw inputError(fmt::format("tuning has no \"{}\"; Tuning.info() lists what it has", name));
}

py::dict describe(const TuningInfo& info) {
  using namespace py::literals;
  return py::dict("stage"_a = info.stage, "unit"_a = nameOf(info.unit), "usual"_a = info.usual,
                  "least"_a = info.least, "most"_a = info.most, "does"_a = info.does,
                  "breaks"_a = info.breaks);
}

}  // namespace

void bindTuning(py::module_& module) {
  py::class_<Tuning, std::shared_ptr<Tuning>> bound(
      module, "Tuning",
      "The numbers that a herd's walk depends on, in units that do not depend on its size (docs/tuning.md). "
      "Ranges are checked when a crowd is made.");
  bound.def(py::init([](const py::kwargs& values) {
              Tuning tuning;
              for (const auto& [name, value] : values)
                set(tuning, name.cast<std::string>(), value.cast<float>());
              return tuning;
            }),
            "The defaults but for those that are given.");
  for (const TuningInfo& info : allTunings) {
    const std::string unit = *nameOf(info.unit) != '\0' ? fmt::format(" {}", nameOf(info.unit)) : "";
    bound.def_property(
        info.name, [member = info.member](const Tuning& self) { return self.*member; },
        [member = info.member](Tuning& self, float value) { self.*member = value; },
        fmt::format("{}: {}. Usually {:g}{}, {}.", info.stage, info.does, info.usual, unit, rangeOf(info))
            .c_str());
  }
  bound
      .def_static(
          "info",
          [] {
            py::dict all;
            for (const TuningInfo& info : allTunings) all[info.name] = describe(info);
            return all;
          },
          "Of each parameter: stage, unit, usual, least, most, does, breaks.")
      .def(
          "to_dict",
          [](const Tuning& self) {
            py::dict values;
            for (const TuningInfo& info : allTunings) values[info.name] = self.*info.member;
            return values;
          },
          "Every parameter by its name.")
      .def("__eq__", [](const Tuning& self, const Tuning& other) { return self == other; })
      .def("__repr__", [](const Tuning& self) {
        std::string changed;
        for (const TuningInfo& info : allTunings)
          if (self.*info.member != info.usual)
            changed += fmt::format("{}{}={:g}", changed.empty() ? "" : ", ", info.name, self.*info.member);
        return fmt::format("skitter.Tuning({})", changed);
      });
}

}  // namespace skitter::python
