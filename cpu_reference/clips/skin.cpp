#include "cpu_reference/clips/skin.h"

#include <algorithm>
#include <cmath>

namespace skitter::reference {

using glm::dmat3;
using glm::dmat4;
using glm::dvec3;
using glm::dvec4;

dmat4 placement(const dvec3& origin, double scale, const dvec3& up, const dvec3& forward) {
  // Rows: what becomes x, y and z.
  const dmat3 rotation = glm::transpose(dmat3(glm::cross(up, forward), up, forward));
  dmat4 result(rotation * scale);
  result[3] = dvec4(rotation * (-origin * scale), 1);
  return result;
}

std::vector<SkinWeight> heaviest(std::vector<SkinWeight> weights) {
  std::stable_sort(weights.begin(), weights.end(),
                   [](const SkinWeight& a, const SkinWeight& b) { return a.weight > b.weight; });
  weights.resize(std::min<size_t>(weights.size(), 4));
  double sum = 0;
  for (const SkinWeight& one : weights) sum += one.weight;
  for (SkinWeight& one : weights) one.weight /= sum;
  return weights;
}

dvec3 skinVertex(const dmat4& P, const std::vector<dmat4>& pose, std::span<const int> joints,
                 std::span<const dmat4> inverseBind, std::span<const SkinWeight> weights,
                 const dvec3& vertex) {
  dvec4 sum(0);
  for (const SkinWeight& one : weights) {
    const auto j = static_cast<size_t>(one.joint);
    sum += one.weight * (pose[static_cast<size_t>(joints[j])] * (inverseBind[j] * dvec4(vertex, 1)));
  }
  return P * sum;
}

dmat4 bindTransform(const dmat4& restOfNode, const dmat4& inverseBind) {
  const dmat4 A = restOfNode * inverseBind;
  const dmat3 linear(A);
  const double box = glm::length(linear[0]) * glm::length(linear[1]) * glm::length(linear[2]);
  return std::abs(glm::determinant(linear)) <= 1e-12 * box ? dmat4(1) : A;
}

std::vector<dmat4> paletteAt(const dmat4& P, const std::vector<dmat4>& pose,
                             std::span<const PaletteEntry> entries, const dvec3& rootVelocity, double t) {
  const dmat4 back = glm::inverse(P);
  std::vector<dmat4> result;
  for (const PaletteEntry& entry : entries) {
    result.push_back(P * pose[static_cast<size_t>(entry.node)] * entry.constant * back);
    result.back()[3] -= dvec4(t * rootVelocity, 0);
  }
  return result;
}

dvec3 jointStart(const dmat4& P, const PaletteEntry& entry) {
  return P * glm::inverse(entry.constant) * dvec4(0, 0, 0, 1);
}

double displacement(const dmat4& a, const dmat4& b, const dvec3& low, const dvec3& high) {
  const dmat4 difference = a - b;
  double worst = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const dvec3 at((corner & 1) != 0 ? high.x : low.x, (corner & 2) != 0 ? high.y : low.y,
                   (corner & 4) != 0 ? high.z : low.z);
    worst = std::max(worst, glm::length(dvec3(difference * dvec4(at, 1))));
  }
  return worst;
}

}  // namespace skitter::reference
