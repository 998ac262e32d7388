#pragma once

#include <glm/glm.hpp>
#include <vector>

namespace skitter::reference {

// Splines as docs/spline.md has them.
enum class TangentRule {
  given,
  catmullRom,
  finiteDifference,
  cardinal,
  kochanekBartels,
  monotone,
  zero,
};

struct SplineKey {
  double time = 0;
  glm::dvec3 point{0};
  glm::dvec3 arriving{0}, leaving{0};  // of TangentRule::given
};

struct SplineRecipe {
  std::vector<SplineKey> keys = {};  // of a closed spline the first one's point and tangents again at the end
  bool closed = false;
  TangentRule rule = TangentRule::catmullRom;
  double tension = 0, continuity = 0, bias = 0;
};

struct SplineSample {
  glm::dvec3 position{0}, velocity{0}, acceleration{0};
  double step = 1;  // h of its segment
};

// A segment by its Bernstein polynomial over s in [0, 1].
struct Bezier {
  glm::dvec3 b0{0}, b1{0}, b2{0}, b3{0};

  glm::dvec3 at(double s) const;
  glm::dvec3 derivative(double s) const;
  glm::dvec3 secondDerivative(double s) const;
  void halve(Bezier& first, Bezier& second) const;
  double chord() const;
  double polygon() const;
};

// The documented quadrature from 0 to s.
double quadratureLength(const Bezier&, double s);
// C - H of the documented error bound.
double lengthErrorBound(const Bezier&);
// The length itself, halved until polygon and chord agree to `tolerance`.
double trueLength(const Bezier&, double tolerance);

class HermiteSpline {
 public:
  explicit HermiteSpline(const SplineRecipe&);

  const std::vector<SplineKey>& keys() const { return keys_; }  // with the tangents of the rule
  const Bezier& segment(size_t i) const { return segments_[i]; }
  size_t segments() const { return segments_.size(); }
  bool closed() const { return closed_; }
  double begin() const { return keys_.front().time; }
  double end() const { return keys_.back().time; }

  SplineSample at(double time) const;
  double length() const { return lengths_.back(); }
  double lengthAt(double time) const;
  double timeAtLength(double length) const;

 private:
  struct Place {
    size_t segment;
    double s;
  };
  Place place(double time) const;

  bool closed_;
  std::vector<SplineKey> keys_;
  std::vector<Bezier> segments_;
  std::vector<double> lengths_;
};

struct TravelClock {
  double start = 0, duration = 1;
  bool active = false;
};

enum class TravelState { idle, moving, finished };

struct Travel {
  TravelState state = TravelState::idle;
  double phase = 0, rounds = 0;
  glm::dvec3 position{0}, velocity{0};
  double travelled = 0;
};
Travel travelAt(const HermiteSpline&, const TravelClock&, double now, bool constantSpeed);
// The same with the phase given: what a phase that is off by a little would give.
Travel travelAtPhase(const HermiteSpline&, double phase, double rounds, double duration, bool constantSpeed);
TravelClock rescaled(const TravelClock&, double duration, double now);

}  // namespace skitter::reference
