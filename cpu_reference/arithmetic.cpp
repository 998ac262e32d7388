#include "cpu_reference/arithmetic.h"

namespace skitter::reference {

bool Arithmetic::below(double value, double limit) {
  const size_t next = decisions_.size();
  decisions_.push_back(next < told_.size() ? told_[next] : value < limit);
  margins_.push_back(limit - value);
  return decisions_.back();
}

double Arithmetic::error(double most) {
  if (!random_) return 0;
  return most * (static_cast<double>((*random_)() >> 11) * 0x1p-52 - 1);
}

glm::dvec3 Arithmetic::errors(double most) {
  const double x = error(most), y = error(most);
  return {x, y, error(most)};
}

double Arithmetic::dot(const glm::dvec3& a, const glm::dvec3& b) {
  const glm::dvec3 terms = a * b, sizes = glm::abs(terms);
  return terms.x + terms.y + terms.z + numberError(sizes.x + sizes.y + sizes.z);
}

double Arithmetic::length(const glm::dvec3& v) {
  const double length = glm::length(v);
  return length + numberError(4 * length);
}

glm::dmat3 rounded(glm::dmat3 m, Arithmetic& arithmetic) {
  const glm::dvec3 diagonal(m[0][0], m[1][1], m[2][2]);
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j)
      m[j][i] = m[i][j] += arithmetic.numberError(3 * std::sqrt(diagonal[i] * diagonal[j]));
  return m;
}

// Rounding errors of an inverse depend on the way to it: a cofactor is the difference of two products.
glm::dmat3 inverseOf(const glm::dmat3& m, Arithmetic& arithmetic) {
  glm::dmat3 adjugate;
  for (int i = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j) {
      const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      const double a = m[i1][j1] * m[i2][j2], b = m[i1][j2] * m[i2][j1];
      adjugate[j][i] = adjugate[i][j] = a - b + arithmetic.numberError(std::abs(a) + std::abs(b));
    }
  }
  return adjugate / arithmetic.dot(m[0], adjugate[0]);
}

glm::dvec3 product(const glm::dmat3& m, const glm::dvec3& v, Arithmetic& arithmetic) {
  const double x = arithmetic.dot(m[0], v), y = arithmetic.dot(m[1], v);
  return {x, y, arithmetic.dot(m[2], v)};
}

}  // namespace skitter::reference
