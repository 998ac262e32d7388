#include "cpu_reference/ik/jacobian.h"

#include <algorithm>

#include "cpu_reference/ik/columns.h"
#include "cpu_reference/rotation.h"

namespace skitter::reference {
namespace {

constexpr double longestError = 0.5, longestStep = 1;  // shares of the length, radians
constexpr double restShare = 0.05;                     // of the pseudoinverse's null-space part, at most
constexpr double dlsDamping = 0.01, pseudoinverseRidge = 1e-6;

glm::dvec3 shortened(const glm::dvec3& e) {
  const double length = glm::length(e);
  return length > longestError ? e * (longestError / length) : e;
}

// lambda of M = J J^T and e, so that the step is J^T lambda.
glm::dvec3 solved(Jacobian method, const glm::dmat3& sum, const glm::dvec3& e, Arithmetic& arithmetic) {
  const glm::dmat3 m = rounded(sum, arithmetic);
  if (method == Jacobian::transpose) {
    // The length of step that takes the most of e away were J constant: Buss, eq. 8.
    const glm::dvec3 me = product(m, e, arithmetic);
    const double square = glm::dot(me, me);
    return square < 1e-20 ? glm::dvec3(0) : e * (glm::dot(e, me) / square);
  }
  const double trace = m[0][0] + m[1][1] + m[2][2];
  const double ridge = method == Jacobian::pseudoinverse ? pseudoinverseRidge * trace : dlsDamping;
  return product(inverseOf(m + glm::dmat3(ridge), arithmetic), e, arithmetic);
}

// Scale that keeps the largest step within its bound.
double moderation(double largest) { return largest > longestStep ? longestStep / largest : 1; }

}  // namespace

void jacobian(Jacobian method, const std::vector<BoneRest>& bones, const glm::dvec3& target, Joints& joints) {
  const glm::dvec3 attached = method == Jacobian::targetAttached ? target : joints.back();
  std::vector<glm::dvec3> directions = directionsOf(joints);
  std::vector<glm::dvec3> omega(bones.size(), glm::dvec3(0));
  glm::dvec3 e = shortened(target - joints.back());
  const double pull = std::min(restShare, glm::length(target - joints.back()));
  glm::dmat3 m(0);
  for (size_t i = 0; i < bones.size(); ++i) {
    if (bones[i].length == 0) continue;
    const glm::dvec3 r = attached - joints[i];
    m += glm::dmat3(glm::dot(r, r)) - glm::outerProduct(r, r);
    if (method != Jacobian::pseudoinverse) continue;
    omega[i] = pull * glm::cross(directions[i], bones[i].direction());
    e -= glm::cross(omega[i], r);
  }
  Arithmetic exact;
  const glm::dvec3 lambda = solved(method, m, e, exact);
  double largest = 0;
  for (size_t i = 0; i < bones.size(); ++i) {
    if (bones[i].length > 0) omega[i] += glm::cross(attached - joints[i], lambda);
    largest = std::max(largest, glm::length(omega[i]));
  }
  glm::dmat3 turn(1);
  for (size_t i = 0; i < bones.size(); ++i) {
    turn = turn * turnBy(omega[i] * moderation(largest));
    directions[i] = normalized(turn * directions[i]);
  }
  joints = laidOut(bones, directions);
}

void jacobian(Jacobian method, const glm::dvec3& target, Posture& posture) {
  Arithmetic exact;
  jacobian(method, target, posture, exact);
}

void jacobian(Jacobian method, const glm::dvec3& target, Posture& posture, Arithmetic& arithmetic) {
  std::vector<JointColumns> chain =
      columnsAt(posture, method == Jacobian::targetAttached ? target : posture.tip());
  glm::dvec3 e = shortened(target - posture.tip());
  const double pull = std::min(restShare, glm::length(target - posture.tip()));
  glm::dmat3 m(0);
  for (size_t i = 0; i < chain.size(); ++i) {
    if (method == Jacobian::pseudoinverse) pullToRest(posture.bone(i), pull, chain[i]);
    for (Column& column : chain[i].columns) {
      column.movement += arithmetic.placeErrors();
      m += glm::outerProduct(column.movement, column.movement);
      e -= column.pull * column.movement;
    }
  }
  const glm::dvec3 lambda = solved(method, m, e, arithmetic);
  double largest = 0;
  for (JointColumns& joint : chain) {
    for (Column& column : joint.columns) {
      column.step = column.pull + arithmetic.dot(column.movement, lambda);
      largest = std::max(largest, std::abs(column.step));
    }
  }
  for (JointColumns& joint : chain) {
    for (Column& column : joint.columns) column.step *= moderation(largest);
  }
  applySteps(chain, posture);
}

}  // namespace skitter::reference
