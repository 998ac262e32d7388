#include "bindings/python/crowd.h"

namespace skitter::python {
namespace {

using namespace py::literals;

// A note is any value that Python's json module writes; the engine has its text.
std::string textOf(const py::object& note) {
  if (note.is_none()) return {};
  return py::module_::import("json").attr("dumps")(note).cast<std::string>();
}
py::object noteOf(const State& state) {
  if (state.note.empty()) return py::none();
  return py::module_::import("json").attr("loads")(state.note);
}

State parsedState(const py::buffer& data, const std::string& name) {
  const py::buffer_info info = data.request();
  if (PyBuffer_IsContiguous(info.view(), 'C') == 0)
    throw inputError("data is not contiguous, expected bytes in a row");
  const auto* const first = static_cast<const std::byte*>(info.ptr);
  return parseState({first, first + info.size * info.itemsize}, name);
}

void save(PythonCrowd& self, const std::filesystem::path& file, const py::object& note) {
  const std::string text = textOf(note);
  self.told([&](const Crowd& crowd) { crowd.save(file, text); });
}

py::array_t<uint8_t> saveToMemory(PythonCrowd& self, const py::object& note) {
  const std::string text = textOf(note);
  std::vector<std::byte> bytes = self.told([&](const Crowd& crowd) { return crowd.saveToMemory(text); });
  const auto count = static_cast<py::ssize_t>(bytes.size());
  return arrayOver<uint8_t>(std::move(bytes), {count});
}

std::shared_ptr<PythonCrowd> resume(const std::shared_ptr<SharedDevice>& device, State state,
                                    std::optional<bool> pose, std::optional<bool> feet,
                                    std::optional<uint32_t> footfalls, std::optional<bool> sleep,
                                    std::optional<bool> fuse, bool timestamps, uint32_t pageAgents,
                                    const std::optional<Levels>& levels) {
  CrowdOptions& options = state.options;
  options.pose = pose.value_or(options.pose);
  options.feet = feet.value_or(options.feet);
  options.footfalls = footfalls.value_or(options.footfalls);
  options.sleep = sleep.value_or(options.sleep);
  options.fuse = fuse.value_or(options.fuse);
  options.timestamps = timestamps;
  options.pageAgents = pageAgents;
  if (levels) options.levels = levels;
  const Turn turn(*device);
  return std::make_shared<PythonCrowd>(device, state);
}

}  // namespace

void bindStates(py::module_& module, CrowdClass& bound) {
  py::class_<State>(module, "State",
                    "A crowd as it was between two ticks, with all that it needs to go on (docs/state.md).")
      .def_static("load", &loadState, "file"_a,
                  "A file that Crowd.save() wrote. It may be replaced meanwhile.")
      .def_static("parse", &parsedState, "data"_a, "name"_a = "the state",
                  "The bytes that Crowd.save_to_memory() gave, in any object that holds bytes; they are "
                  "copied. `name` is for "
                  "messages.")
      .def_readonly("tick", &State::tick, "The last tick that was made.")
      .def_readonly("dt", &State::dt, "Seconds per tick; 0 before the first.")
      .def_property_readonly(
          "scene", [](const State& self) { return PythonScene(self.scene); },
          "A copy of the scene, with the herds that were there.")
      .def_property_readonly(
          "terrain", [](const State& self) { return std::make_shared<Heightfield>(self.terrain); },
          "A copy of the ground as edited.")
      .def_property_readonly("note", &noteOf, "The note with which it was saved, or None.")
      .def("__repr__",
           [](const State& self) { return fmt::format("<skitter.State of tick {}>", self.tick); });
  bound
      .def("save", &save, "file"_a, "note"_a = py::none(),
           "Writes a state, with which resume() goes on. The file takes its name once it is whole. `note` is "
           "anything that Python's json module writes, and comes back as State.note.")
      .def("save_to_memory", &saveToMemory, "note"_a = py::none(),
           "The same as bytes: uint8 of shape (bytes,), for State.parse() or numpy.save().")
      .def_static("resume", &resume, "device"_a, "state"_a, py::kw_only(), "pose"_a = py::none(),
                  "feet"_a = py::none(), "footfalls"_a = py::none(), "sleep"_a = py::none(),
                  "fuse"_a = py::none(), "timestamps"_a = false, "page_agents"_a = 0, "levels"_a = py::none(),
                  "The crowd of a state, which goes on as if it had never stopped. Options are those of "
                  "Crowd; None: as in the crowd that was saved.");
}

}  // namespace skitter::python
