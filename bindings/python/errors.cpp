#include "bindings/python/bind.h"

namespace skitter::python {
namespace {

// Alive as long as the interpreter is, which may end after destructors of this file have run.
struct Errors {
  PyObject *any, *input, *device;
};
Errors errors;

PyObject* makeError(py::module_& module, const char* name, const py::object& bases, const char* kind,
                    const char* text) {
  py::dict members;
  members["kind"] = kind;
  PyObject* made =
      PyErr_NewExceptionWithDoc(("skitter." + std::string(name)).c_str(), text, bases.ptr(), members.ptr());
  if (made == nullptr) throw py::error_already_set();
  module.add_object(name, made);
  return made;
}

}  // namespace

void bindErrors(py::module_& module) {
  const auto object = [](PyObject* type) { return py::reinterpret_borrow<py::object>(type); };
  errors.any =
      makeError(module, "Error", object(PyExc_RuntimeError), "check",
                "Wrong input or a failing world, in one line. `kind` is \"input\", \"device\" or \"check\".");
  errors.input = makeError(module, "InputError", py::make_tuple(object(errors.any), object(PyExc_ValueError)),
                           "input", "A wrong argument, or an unreadable or malformed file.");
  errors.device = makeError(module, "DeviceError", object(errors.any), "device",
                            "No usable Vulkan device, not enough of its memory, or it failed.");
  py::register_exception_translator([](std::exception_ptr pointer) {
    try {
      if (pointer) std::rethrow_exception(pointer);
    } catch (const Error& error) {
      PyObject* const type = error.kind() == Error::Kind::input    ? errors.input
                             : error.kind() == Error::Kind::device ? errors.device
                                                                   : errors.any;
      PyErr_SetString(type, error.what());
    }
  });
}

}  // namespace skitter::python
