#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <random>
#include <vector>

namespace skitter::reference {

// How a solve computes. By default it is exact, and comparisons decide as they fall. A judge of float32
// solves also has it err by random roundings (Monte Carlo arithmetic: Parker 1997), and decide as told where
// rounding might turn a comparison.
class Arithmetic {
 public:
  // The most that float32 is off: in a number of size 1; in a joint's place and in the target's, as shares of
  // the reach.
  struct Roundings {
    double number = 0, place = 0, target = 0;
  };

  Arithmetic() = default;
  // The first decisions are `told`, the others fall as they do.
  explicit Arithmetic(std::vector<bool> told) : told_(std::move(told)) {}
  Arithmetic(std::vector<bool> told, const Roundings& roundings, uint64_t seed)
      : told_(std::move(told)), roundings_(roundings), random_(seed) {}

  // Decides whether value < limit.
  bool below(double value, double limit);
  // All comparisons so far, in order; a margin is limit - value.
  const std::vector<bool>& decisions() const { return decisions_; }
  const std::vector<double>& margins() const { return margins_; }

  // Errors to be added: 0, or uniformly distributed up to the most that there may be.
  double numberError(double size) { return error(size * roundings_.number); }
  double placeError() { return error(roundings_.place); }
  double dot(const glm::dvec3& a, const glm::dvec3& b);
  double length(const glm::dvec3& v);
  glm::dvec3 placeErrors() { return errors(roundings_.place); }
  glm::dvec3 targetErrors() { return errors(roundings_.target); }

 private:
  double error(double most);
  glm::dvec3 errors(double most);

  std::vector<bool> told_, decisions_;
  std::vector<double> margins_;
  Roundings roundings_;
  std::optional<std::mt19937_64> random_;
};

// Symmetric matrices with rounding: one that is a sum of some nine outer products; the inverse, by cofactors,
// as shaders have it; the product with a vector.
glm::dmat3 rounded(glm::dmat3 sum, Arithmetic& arithmetic);
glm::dmat3 inverseOf(const glm::dmat3& m, Arithmetic& arithmetic);
glm::dvec3 product(const glm::dmat3& m, const glm::dvec3& v, Arithmetic& arithmetic);

}  // namespace skitter::reference
