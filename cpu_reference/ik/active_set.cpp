#include "cpu_reference/ik/active_set.h"

#include <algorithm>

#include "cpu_reference/ik/columns.h"

namespace skitter::reference {
namespace {

constexpr double chordError = 0.1;        // beyond it chord steps would only stir a chain that cannot arrive
constexpr double leastDenominator = 0.1;  // of a room's tangent; below it, the limit is too far to matter
constexpr double unlimited = std::numeric_limits<double>::infinity();

// Room is the tangent of the angle left, as a step of x radians along the tangent turns by atan(x).
void coneRoom(const Limit& limit, JointColumns& joint) {
  const double t = limit.tanHalfCone, sine = 2 * t / (1 + t * t), cosine = (1 - t * t) / (1 + t * t);
  const double denominator = cosine * joint.d.z + sine * joint.s;
  if (denominator >= leastDenominator) {
    joint.columns[0].high = (sine * joint.d.z - cosine * joint.s) / denominator;
  }
}

// Turns the two columns across and along the level line of E = sqrt((v.x / a_x)^2 + (v.y / a_y)^2), v = theta
// h, on which the joint is: only the way across it is limited, by E = 1.
void ellipseRoom(const Limit& limit, JointColumns& joint) {
  const double theta = 2 * std::atan(joint.s / std::max(1 + joint.d.z, 1e-12));
  if (theta < 1e-3) return;
  const glm::dvec2 axes = ellipseAxes(limit, joint.h), around{-joint.h.y, joint.h.x};
  const glm::dvec2 v = theta * joint.h, n = v / (axes * axes);
  const double level = std::sqrt(glm::dot(v, n));
  // Gradient of E by (radial, tangential) steps, times E.
  const glm::dvec2 gradient{glm::dot(n, joint.h), glm::dot(n, around) * theta / joint.s};
  joint.way = normalized(gradient);
  Column &across = joint.columns[0], &along = joint.columns[1];
  const glm::dvec3 radial = across.movement, tangential = along.movement;
  across.movement = joint.way.x * radial + joint.way.y * tangential;
  along.movement = joint.way.x * tangential - joint.way.y * radial;
  across.high = (1 - level) * level / glm::length(gradient);
}

// tan(end - q) from tan(end / 2) and the hinge's d = (0, -sin q, cos q).
double hingeEnd(double tanHalf, const glm::dvec3& d, double otherwise) {
  const double scale = 1 / (1 + tanHalf * tanHalf);
  const double sine = 2 * tanHalf * scale, cosine = (1 - tanHalf * tanHalf) * scale;
  const double denominator = cosine * d.z - sine * d.y;
  return denominator < leastDenominator ? otherwise : (sine * d.z + cosine * d.y) / denominator;
}

// 2 tan((end - tau) / 2).
double twistEnd(double tanHalf, double twist, double otherwise) {
  const double denominator = 1 + tanHalf * twist;
  return denominator < leastDenominator ? otherwise : 2 * (tanHalf - twist) / denominator;
}

void giveRoom(const Limit& limit, JointColumns& joint) {
  if (joint.columns.empty()) return;
  if (limit.kind == LimitKind::hinge) {
    joint.columns[0].low = hingeEnd(limit.tanHalfLow, joint.d, -unlimited);
    joint.columns[0].high = hingeEnd(limit.tanHalfHigh, joint.d, unlimited);
    return;
  }
  limit.kind == LimitKind::ellipse ? ellipseRoom(limit, joint) : coneRoom(limit, joint);
  if (joint.columns.size() == 3) {
    joint.columns[2].low = twistEnd(limit.tanHalfTwistLow, joint.twist, -unlimited);
    joint.columns[2].high = twistEnd(limit.tanHalfTwistHigh, joint.twist, unlimited);
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
