#pragma once

#include <fmt/format.h>
#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <concepts>
#include <cstddef>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "bindings/common/names.h"
#include "skitter/crowd.h"
#include "skitter/device.h"
#include "skitter/error.h"
#include "skitter/scene.h"

// What the files of the module share: each of them binds a subject.
namespace skitter::python {

namespace py = pybind11;

void bindErrors(py::module_& module);
void bindDevice(py::module_& module);
void bindTuning(py::module_& module);
void bindLevels(py::module_& module);
void bindScene(py::module_& module);
void bindCrowd(py::module_& module);
void bindIk(py::module_& module);
void bindSplines(py::module_& module);
void bindValidation(py::module_& module);

// A device is shared by what is made on it, and used by one thread at a time.
struct SharedDevice {
  Device device;
  std::mutex mutex;

  explicit SharedDevice(Device made) : device(std::move(made)) {}
};

// A call that takes long or uses the device: the interpreter runs other threads meanwhile, and calls on one
// device take turns. No Python object is touched while it lives.
class Turn {
 public:
  explicit Turn(SharedDevice& device) : lock_(device.mutex) {}

 private:
  py::gil_scoped_release release_;  // first, for who waits must not hold the interpreter
  std::lock_guard<std::mutex> lock_;
};

// Lets Python handle signals, now and then, from a call that has released the interpreter: Ctrl-C throws.
class Signals {
 public:
  void check() {
    const auto now = std::chrono::steady_clock::now();
    if (now - last_ < std::chrono::milliseconds(20)) return;
    last_ = now;
    const py::gil_scoped_acquire acquire;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

// An event as Python has it: `what` is an object of one of the kinds of Event::what.
struct PythonEvent {
  float at = 0;
  py::object what;
};
void bindEvents(py::module_& module);
py::list eventsOf(const Scene& scene);
// Throws Error(input) where something else is in the list.
std::vector<Event> eventsIn(const py::list& events);

// A scene as Python has it: herds, terrain and events are objects of their own, so that a name for one of
// them stays good whatever becomes of the scene.
struct PythonScene {
  Scene rest = Scene{};  // all but these
  py::list herds, events;
  py::object terrain;

  explicit PythonScene(const Scene& scene);
  // Throws Error(input) where something else has been put in their place.
  Scene scene() const;
};

// An array over the memory of a list, which it keeps: nothing is copied.
template <typename Value, typename Element>
py::array_t<Value> arrayOver(std::vector<Element> elements, std::vector<py::ssize_t> shape) {
  auto* const kept = new std::vector<Element>(std::move(elements));
  const py::capsule owner(kept, [](void* pointer) { delete static_cast<std::vector<Element>*>(pointer); });
  return py::array_t<Value>(std::move(shape), reinterpret_cast<const Value*>(kept->data()), owner);
}
template <typename Value>
py::array_t<Value> arrayOf(std::vector<Value> values, std::vector<py::ssize_t> shape) {
  return arrayOver<Value>(std::move(values), std::move(shape));
}
// One value a thing.
template <typename Value>
py::array_t<Value> listOf(std::vector<Value> values) {
  const auto count = static_cast<py::ssize_t>(values.size());
  return arrayOf(std::move(values), {count});
}

// Vectors as rows of an array.
template <int Size, typename Value>
py::array_t<Value> rowsOf(std::vector<glm::vec<Size, Value>> vectors, std::vector<py::ssize_t> shape) {
  static_assert(sizeof(glm::vec<Size, Value>) == Size * sizeof(Value));
  shape.push_back(Size);
  return arrayOver<Value>(std::move(vectors), std::move(shape));
}
// x, y, z, w.
inline py::array_t<float> rowsOf(std::vector<glm::quat> rotations, std::vector<py::ssize_t> shape) {
  static_assert(sizeof(glm::quat) == 4 * sizeof(float) && offsetof(glm::quat, w) == 3 * sizeof(float));
  shape.push_back(4);
  return arrayOver<float>(std::move(rotations), std::move(shape));
}
// One row a thing.
template <typename Vector>
auto rowsOf(std::vector<Vector> vectors) {
  const auto count = static_cast<py::ssize_t>(vectors.size());
  return rowsOf(std::move(vectors), {count});
}

// What float32 arrays are passed in as; others are converted.
using Floats = py::array_t<float, py::array::c_style | py::array::forcecast>;

// "(10, 3)"
inline std::string shapeOf(const py::array& array) {
  return fmt::format("({}{})", fmt::join(array.shape(), array.shape() + array.ndim(), ", "),
                     array.ndim() == 1 ? "," : "");
}

// The rows of an array in order. Its last axis has `Size` numbers; `shape` says so in a message.
template <int Size>
std::vector<glm::vec<Size, float>> vectorsOf(const Floats& array, const char* name, const char* shape) {
  if (array.ndim() < 1 || array.shape(array.ndim() - 1) != Size)
    throw inputError(fmt::format("{} has shape {}, expected {}", name, shapeOf(array), shape));
  std::vector<glm::vec<Size, float>> vectors(static_cast<size_t>(array.size() / Size));
  const float* at = array.data();
  for (auto& vector : vectors)
    for (int k = 0; k < Size; ++k) vector[k] = *at++;
  return vectors;
}
inline std::vector<glm::vec3> pointsOf(const Floats& array, const char* name) {
  return vectorsOf<3>(array, name, "(..., 3)");
}

// Numbers of a caller: one for each of `count` things, or one for all of them.
template <typename Number>
class Each {
 public:
  Each(const py::array_t<Number, py::array::c_style | py::array::forcecast>& array, const char* name,
       size_t count)
      : numbers_(array.data()), one_(array.size() == 1) {
    if (!one_ && static_cast<size_t>(array.size()) != count)
      throw inputError(
          fmt::format("{} has shape {}, expected one number or ({},)", name, shapeOf(array), count));
  }
  Number operator[](size_t i) const { return numbers_[one_ ? 0 : i]; }

 private:
  const Number* numbers_;  // in the array
  bool one_;
};

// A member that Python sees as one of a few names, as scene files have them.
template <typename Class, typename Object, typename Enum, size_t Count>
void defineNamed(Class& bound, const char* name, Enum Object::*member,
                 const std::array<const char*, Count>& names, const char* text) {
  bound.def_property(
      name, [=](const Object& object) { return names[static_cast<size_t>(object.*member)]; },
      [=](Object& object, const std::string& value) {
        const auto found = std::find(names.begin(), names.end(), value);
        if (found == names.end())
          throw inputError(
              fmt::format("{} is \"{}\", expected one of {}", name, value, fmt::join(names, ", ")));
        object.*member = static_cast<Enum>(found - names.begin());
      },
      text);
}

// Their names, in that order.
template <typename Enum, size_t Count>
py::tuple namesTuple(const std::array<Enum, Count>& all) {
  py::tuple names(Count);
  for (size_t i = 0; i < Count; ++i) names[i] = nameOf(all[i]);
  return names;
}

// A member whose enumeration has names (skitter/enum_names.h).
template <typename Class, typename Object, typename Enum, size_t Count>
void defineNamed(Class& bound, const char* name, Enum Object::*member, const std::array<Enum, Count>& all,
                 const char* text) {
  bound.def_property(
      name, [=](const Object& object) { return nameOf(object.*member); },
      [=](Object& object, const std::string& value) { object.*member = bindings::namedOf(all, name, value); },
      text);
}

}  // namespace skitter::python

namespace pybind11::detail {

// Vectors are tuples in Python, and any sequence of as many numbers is taken for one.
template <int Size, std::floating_point Number>
struct type_caster<glm::vec<Size, Number>> {
  using Vector = glm::vec<Size, Number>;
  PYBIND11_TYPE_CASTER(Vector, const_name("Sequence[float]"));

  bool load(handle from, bool) {
    if (!PySequence_Check(from.ptr()) || PyUnicode_Check(from.ptr()) || PySequence_Size(from.ptr()) != Size) {
      PyErr_Clear();
      return false;
    }
    const auto items = reinterpret_borrow<sequence>(from);
    for (int k = 0; k < Size; ++k) {
      const object item = items[static_cast<size_t>(k)];
      const double number = PyFloat_AsDouble(item.ptr());
      if (number == -1 && PyErr_Occurred()) {
        PyErr_Clear();
        return false;
      }
      value[k] = static_cast<Number>(number);
    }
    return true;
  }
  static handle cast(const Vector& vector, return_value_policy, handle) {
    tuple numbers(Size);
    for (int k = 0; k < Size; ++k) numbers[static_cast<size_t>(k)] = float_(double{vector[k]});
    return numbers.release();
  }
};

}  // namespace pybind11::detail
