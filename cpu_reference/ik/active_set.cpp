#include "cpu_reference/ik/active_set.h"

#include <algorithm>

#include "cpu_reference/ik/columns.h"

namespace skitter::reference {
namespace {

constexpr double chordError = 0.1;  // beyond it chord steps would only stir a chain that cannot arrive
constexpr double unlimited = std::numeric_limits<double>::infinity();

// Gives the columns their room. A ball's two are turned the way in which it is limited and across it.
void giveRoom(const Limit& limit, JointColumns& joint) {
  if (joint.columns.empty()) return;
  const Room room = swingRoom(limit, joint.d, joint.s, joint.h);
  joint.columns[0].low = room.low;
  joint.columns[0].high = room.high;
  joint.way = room.way;
  if (joint.columns.size() > 1) {
    const glm::dvec3 radial = joint.columns[0].movement, tangential = joint.columns[1].movement;
    joint.columns[0].movement = room.way.x * radial + room.way.y * tangential;
    joint.columns[1].movement = room.way.x * tangential - room.way.y * radial;
  }
  if (joint.columns.size() == 3) {
    const Room twist = twistRoom(limit, joint.twist);
    joint.columns[2].low = twist.low;
    joint.columns[2].high = twist.high;
  }
}

// The steps of the free columns. Whether one of them meets its limit and is held from now on, which takes its
// part out of e.
bool stepOrHold(std::vector<JointColumns>& joints, const glm::dvec3& lambda, bool mayHold, glm::dvec3& e,
                Arithmetic& arithmetic) {
  bool anyHeld = false;
  for (JointColumns& joint : joints) {
    for (Column& column : joint.columns) {
      if (column.held) continue;
      column.step = column.pull + arithmetic.dot(column.movement, lambda);
      if (!mayHold) continue;
      const bool above = column.high < unlimited && arithmetic.below(column.high, column.step);
      const bool under = column.low > -unlimited && arithmetic.below(column.step, column.low);
      if (!above && !under) continue;
      column.held = anyHeld = true;
      column.step = above ? column.high : column.low;
      e -= (column.step - column.pull) * column.movement;
    }
  }
  return anyHeld;
}

// Holds what meets its limit, at most twice; leaves the steps, and the matrix' inverse for chord steps.
glm::dmat3 solveWithLimits(std::vector<JointColumns>& joints, double mu, glm::dvec3 e,
                           Arithmetic& arithmetic) {
  constexpr int passes = 3;
  glm::dmat3 inverse(1);
  for (int pass = 1; pass <= passes; ++pass) {
    glm::dmat3 m(mu);
    for (const JointColumns& joint : joints) {
      for (const Column& column : joint.columns) {
        if (!column.held) m += glm::outerProduct(column.movement, column.movement);
      }
    }
    inverse = inverseOf(rounded(m, arithmetic), arithmetic);
    if (!stepOrHold(joints, product(inverse, e, arithmetic), pass < passes, e, arithmetic)) break;
  }
  return inverse;
}

void chordStep(std::vector<JointColumns>& joints, const glm::dvec3& lambda, Posture& posture,
               Arithmetic& arithmetic) {
  for (JointColumns& joint : joints) {
    for (Column& column : joint.columns) {
      if (!column.held) column.step += arithmetic.dot(column.movement, lambda);
    }
  }
  applySteps(joints, posture);
}

}  // namespace

void activeSet(const ActiveSet& how, const glm::dvec3& target, Posture& posture, double& damping) {
  Arithmetic exact;
  activeSet(how, target, posture, damping, exact);
}

void activeSet(const ActiveSet& how, const glm::dvec3& target, Posture& posture, double& damping,
               Arithmetic& arithmetic) {
  const auto errorNow = [&] { return target - posture.tip() + arithmetic.placeErrors(); };
  glm::dvec3 e = errorNow();
  const double before = arithmetic.length(e);
  const double square = before * before;
  const double open = how.ifNear ? std::min(square * (0.25 + square), 1.0) : 0.25 * std::min(square, 0.25);
  const double mu = (open + 1e-5) * damping;
  if (before > 0.5) e *= 0.5 / before;

  const bool pulled = how.restPull > 0 && arithmetic.below(before, how.pullError);
  std::vector<JointColumns> joints = columnsAt(posture, posture.tip());
  for (size_t i = 0; i < joints.size(); ++i) {
    giveRoom(posture.bone(i), joints[i]);
    for (Column& column : joints[i].columns) {
      column.movement += arithmetic.placeErrors();
      column.low += arithmetic.placeError();
      column.high += arithmetic.placeError();
    }
    if (!pulled) continue;
    pullToRest(posture.bone(i), how.restPull * posture.bone(i).stiffness, joints[i]);
    for (const Column& column : joints[i].columns) e -= column.pull * column.movement;
  }
  const glm::dmat3 inverse = solveWithLimits(joints, mu, e, arithmetic);
  const Pose old = posture.pose();
  applySteps(joints, posture);
  for (int chord = 0; chord < how.chords; ++chord) {
    const glm::dvec3 left = errorNow();
    const bool far = glm::length(left) > chordError;
    if (how.ifNear && (far || glm::length(left) <= how.tolerance)) break;
    const Pose without = posture.pose();
    chordStep(joints, product(inverse, left, arithmetic), posture, arithmetic);
    if (!how.ifNear || glm::length(target - posture.tip()) < glm::length(left)) continue;
    posture.setPose(without);
    break;
  }
  const double after = arithmetic.length(errorNow());
  if (arithmetic.below(1.0001 * before, after) && arithmetic.below(how.tolerance, after)) {
    posture.setPose(old);
    damping = std::min(16 * damping, 4096.0);
  } else {
    damping = std::max(damping / 10, 1.0);
  }
}

}  // namespace skitter::reference
