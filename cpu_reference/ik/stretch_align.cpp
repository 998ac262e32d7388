#include "cpu_reference/ik/stretch_align.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "cpu_reference/ik/deadlock.h"
#include "cpu_reference/rotation.h"

namespace skitter::reference {
namespace {

// The bones' directions along the line from base to tip, and across it.
struct Bends {
  glm::dvec3 line{0};              // e^
  std::vector<double> along;       // a_i
  std::vector<glm::dvec3> across;  // b_i
};

// Gives a chain that hardly bends an arc.
void bend(const IkChain& chain, double wanted, Bends& bends) {
  const size_t n = bends.along.size();
  double squares = 0;
  for (const glm::dvec3& b : bends.across) squares += glm::dot(b, b);
  if (squares >= static_cast<double>(n) * 0.02 * 0.02 * std::min(1.0, 100 * (1 - wanted))) return;
  const glm::dvec3 side = perpendicular(chain.pole.value_or(glm::dvec3(0)), bends.line);
  for (size_t i = 0; i < n; ++i) {
    glm::dvec3& b = bends.across[i];
    b += side * (0.1 * arcShare(i, n));
    b -= bends.line * glm::dot(b, bends.line);
    bends.along[i] = std::copysign(std::sqrt(std::max(1 - glm::dot(b, b), 0.0)), bends.along[i]);
  }
}

Bends bendsOf(const IkChain& chain, double wanted, const Joints& joints) {
  const std::vector<glm::dvec3> directions = directionsOf(joints);
  Bends bends;
  bends.line = glm::length(joints.back()) < 1e-6 ? directions[0] : glm::normalize(joints.back());
  for (const glm::dvec3& u : directions) {
    bends.along.push_back(glm::dot(u, bends.line));
    bends.across.push_back(u - bends.line * bends.along.back());
  }
  bend(chain, wanted, bends);
  return bends;
}

// The tip (g along the line, h across it) of the chain stretched by lambda, its distance and the derivative
// of that.
struct Stretched {
  double g = 0;
  glm::dvec3 h{0};
  double distance = 0, slope = 0;
  double dg = 0;
  glm::dvec3 dh{0};
};

Stretched stretched(const IkChain& chain, const Bends& bends, double lambda) {
  Stretched tip;
  double& dg = tip.dg;
  glm::dvec3& dh = tip.dh;
  for (size_t i = 0; i < chain.bones.size(); ++i) {
    const double l = chain.bones[i].length, v = bends.along[i] + lambda;
    const glm::dvec3& b = bends.across[i];
    const double square = glm::dot(b, b), rho = 1 / std::sqrt(std::max(v * v + square, 1e-12));
    tip.g += l * v * rho;
    tip.h += l * rho * b;
    dg += l * square * rho * rho * rho;
    dh -= l * v * rho * rho * rho * b;
  }
  tip.distance = std::sqrt(tip.g * tip.g + glm::dot(tip.h, tip.h));
  tip.slope = (tip.g * dg + glm::dot(tip.h, dh)) / std::max(tip.distance, 1e-6);
  return tip;
}

// The tip, and by how much the chain is stretched for it, where the distance is `wanted`. Newton's method on
// 1 / sqrt(1 - distance), which is nearly linear in lambda near full stretch.
std::pair<Stretched, double> stretchFor(const IkChain& chain, const Bends& bends, double wanted,
                                        double tolerance, bool onward) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  constexpr int steps = 8;
  double lambda = 0, low = -infinity, high = infinity;
  for (int step = 0;; ++step) {
    Stretched tip = stretched(chain, bends, lambda);
    const bool done = std::abs(tip.distance - wanted) < 0.9 * tolerance;
    (tip.distance < wanted ? low : high) = lambda;
    const double f = 1 / std::sqrt(std::max(1 - tip.distance, 1e-9));
    double next = lambda - (f - 1 / std::sqrt(1 - wanted)) / (f * f * f * tip.slope / 2);
    const bool inside = next > low && next < high;
    // A straight chain's slope is rounding, and a step by it may be anything.
    if (done && onward && inside && std::abs(next - lambda) < (1 + std::abs(lambda)) / 2) {
      next = std::max(next, -3.0);
      tip.g += (next - lambda) * tip.dg;
      tip.h += (next - lambda) * tip.dh;
      lambda = next;
    }
    if (done || step == steps) return {tip, lambda};
    if (!inside) next = low == -infinity ? high - 1 : high == infinity ? low + 1 : (low + high) / 2;
    lambda = std::max(next, -3.0);
  }
}

}  // namespace

void stretchAlign(const IkChain& chain, const glm::dvec3& target, double tolerance, bool onward,
                  Joints& joints) {
  const double wanted = std::min(glm::length(target), 0.99999);
  const Bends bends = bendsOf(chain, wanted, joints);
  const auto [tip, lambda] = stretchFor(chain, bends, wanted, tolerance, onward);
  const glm::dmat3 turn = shortest(normalized(bends.line * tip.g + tip.h), normalized(target));
  std::vector<glm::dvec3> directions = directionsOf(joints);
  for (size_t i = 0; i < directions.size(); ++i) {
    // A bone that neither bends nor stretches has no direction: it keeps its own.
    const glm::dvec3 v = bends.across[i] + bends.line * (bends.along[i] + lambda);
    if (glm::length(v) >= 1e-6) directions[i] = turn * glm::normalize(v);
  }
  joints = laidOut(chain.bones, directions);
}

}  // namespace skitter::reference
