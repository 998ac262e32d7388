#include "skitter/spline.h"

#include "bindings/python/bind.h"

namespace skitter::python {
namespace {

using namespace py::literals;

using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;

SplineTangents tangentsOf(const std::string& rule, float tension, float continuity, float bias) {
  return {bindings::namedOf(allSplineRules, "rule", rule), tension, continuity, bias};
}

std::vector<float> numbersOf(const std::optional<Floats>& array) {
  if (!array) return {};
  return {array->data(), array->data() + array->size()};
}

std::vector<glm::vec3> optionalPointsOf(const std::optional<Floats>& array, const char* name) {
  return array ? pointsOf(*array, name) : std::vector<glm::vec3>();
}

std::unique_ptr<Spline> makeSpline(const Floats& points, const std::optional<Floats>& knots, bool closed,
                                   const std::string& rule, float tension, float continuity, float bias,
                                   const std::optional<Floats>& arriving,
                                   const std::optional<Floats>& leaving) {
  return std::make_unique<Spline>(SplineChain{.points = pointsOf(points, "points"),
                                              .knots = numbersOf(knots),
                                              .closed = closed,
                                              .tangents = tangentsOf(rule, tension, continuity, bias),
                                              .arriving = optionalPointsOf(arriving, "arriving"),
                                              .leaving = optionalPointsOf(leaving, "leaving")});
}

// A vector for each of the numbers: the array's shape and (3,).
template <typename Ask>
py::array_t<float> vectorsAt(const Doubles& times, Ask ask) {
  std::vector<glm::vec3> values;
  for (py::ssize_t i = 0; i < times.size(); ++i) values.push_back(ask(times.data()[i]));
  return rowsOf(std::move(values), {times.shape(), times.shape() + times.ndim()});
}

struct MotionRow {
  float position[3], velocity[3];
  float travelled;
  uint32_t state;
};

MotionRow rowOf(const SplineMotion& motion) {
  const glm::vec3 &p = motion.position, &v = motion.velocity;
  return {{p.x, p.y, p.z}, {v.x, v.y, v.z}, motion.travelled, static_cast<uint32_t>(motion.state)};
}

struct PythonSplines {
  std::shared_ptr<SharedDevice> device;
  SplineBatch batch;
};

std::unique_ptr<PythonSplines> makeSplines(const std::shared_ptr<SharedDevice>& device, const Floats& points,
                                           const std::optional<Floats>& knots, bool closed,
                                           const std::string& rule, float tension, float continuity,
                                           float bias, bool constantSpeed,
                                           const std::optional<Floats>& arriving,
                                           const std::optional<Floats>& leaving) {
  if (points.ndim() != 3 || points.shape(2) != 3)
    throw inputError(fmt::format("points have shape {}, expected (splines, points, 3)", shapeOf(points)));
  SplineBatch::Options options;
  options.points = static_cast<uint32_t>(points.shape(1));
  options.closed = closed;
  options.tangents = tangentsOf(rule, tension, continuity, bias);
  options.constantSpeed = constantSpeed;
  const auto count = static_cast<uint32_t>(points.shape(0));
  const std::vector<glm::vec3> places = pointsOf(points, "points");
  const std::vector<float> times = numbersOf(knots);
  const auto in = optionalPointsOf(arriving, "arriving"), out = optionalPointsOf(leaving, "leaving");
  const Turn turn(*device);
  SplineBatch batch(device->device, count, options);
  batch.setPoints(places, times);
  if (!in.empty()) batch.setTangents(in, out);
  return std::unique_ptr<PythonSplines>(new PythonSplines{device, std::move(batch)});
}

void setClocks(PythonSplines& self, const Doubles& start, const Doubles& duration) {
  const size_t count = self.batch.splines();
  const Each<double> starts(start, "start", count), durations(duration, "duration", count);
  std::vector<SplineClock> clocks;
  for (size_t i = 0; i < count; ++i)
    clocks.push_back({.start = starts[i], .duration = durations[i], .active = true});
  const Turn turn(*self.device);
  self.batch.setClocks(clocks);
}

py::array_t<MotionRow> travel(PythonSplines& self, double now) {
  std::vector<MotionRow> rows;
  {
    const Turn turn(*self.device);
    self.batch.travel(now);
    for (const SplineMotion& motion : self.batch.downloadMotions()) rows.push_back(rowOf(motion));
  }
  return listOf(std::move(rows));
}

py::array_t<float> lengths(PythonSplines& self) {
  std::vector<float> all;
  {
    const Turn turn(*self.device);
    all = self.batch.downloadLengths();
  }
  return listOf(std::move(all));
}

}  // namespace

void bindSplines(py::module_& module) {
  PYBIND11_NUMPY_DTYPE(MotionRow, position, velocity, travelled, state);
  module.attr("spline_rules") = namesTuple(allSplineRules);
  module.attr("spline_states") = namesTuple(allSplineStates);
  py::class_<Spline>(module, "Spline",
                     "A cubic Hermite spline on the host, computed in double (docs/spline.md).")
      .def(py::init(&makeSpline), "points"_a, "knots"_a = py::none(), py::kw_only(), "closed"_a = false,
           "rule"_a = "catmullRom", "tension"_a = 0.0f, "continuity"_a = 0.0f, "bias"_a = 0.0f,
           "arriving"_a = py::none(), "leaving"_a = py::none(),
           R"(Through points of shape (points, 3), 2 to 1024, in the caller's unit.

knots: when they are met, one more of a closed spline; None: 0, 1, 2, ... rule: of the tangents, one of
skitter.spline_rules. tension, continuity, bias: of the rules cardinal and kochanekBartels. arriving, leaving:
velocities of shape (points, 3), of the rule given. Raises InputError for one that cannot be.)")
      .def_property_readonly("begin", &Spline::begin, "The first knot.")
      .def_property_readonly("end", &Spline::end, "The last knot.")
      .def_property_readonly("closed", &Spline::closed, "Whether it comes back to the first point.")
      .def_property_readonly("length", &Spline::length, "Arc length.")
      .def(
          "position",
          [](const Spline& self, const Doubles& time) {
            return vectorsAt(time, [&](double t) { return self.position(t); });
          },
          "time"_a,
          "Where it is at knot times, clamped or, of a closed spline, wrapped: the times' shape and (3,).")
      .def(
          "velocity",
          [](const Spline& self, const Doubles& time) {
            return vectorsAt(time, [&](double t) { return self.velocity(t); });
          },
          "time"_a, "The first derivative, likewise.")
      .def(
          "acceleration",
          [](const Spline& self, const Doubles& time) {
            return vectorsAt(time, [&](double t) { return self.acceleration(t); });
          },
          "time"_a, "The second derivative, likewise.")
      .def(
          "length_at",
          [](const Spline& self, const Doubles& time) {
            return py::vectorize([&self](double t) { return self.lengthAt(t); })(time);
          },
          "time"_a, "Arc length from the first point on.")
      .def(
          "time_at_length",
          [](const Spline& self, const Doubles& length) {
            return py::vectorize([&self](double l) { return self.timeAtLength(l); })(length);
          },
          "length"_a, "The knot time at an arc length, clamped or wrapped.");

  py::class_<PythonSplines>(module, "SplineBatch", "Splines of equal point counts on a device.")
      .def(py::init(&makeSplines), "device"_a, "points"_a, "knots"_a = py::none(), py::kw_only(),
           "closed"_a = false, "rule"_a = "catmullRom", "tension"_a = 0.0f, "continuity"_a = 0.0f,
           "bias"_a = 0.0f, "constant_speed"_a = false, "arriving"_a = py::none(), "leaving"_a = py::none(),
           "Through points of shape (splines, points, 3). knots: of one spline, for all, or of each. "
           "constant_speed: "
           "the arc length grows evenly, not the knots' time. The rest is as a Spline has it.")
      .def_property_readonly(
          "splines", [](const PythonSplines& self) { return self.batch.splines(); }, "Splines.")
      .def("set_clocks", &setClocks, "start"_a, "duration"_a,
           "When each begins and how long its way takes, seconds: numbers, or arrays of shape (splines,).")
      .def("travel", &travel, "now"_a,
           "Where everything is at a time: a structured array of position, velocity, travelled (arc length), "
           "state (an "
           "index of skitter.spline_states).")
      .def("lengths", &lengths, "Arc lengths: float32 of shape (splines,).");
}

}  // namespace skitter::python
