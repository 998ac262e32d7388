#include "cpu_reference/active_set.h"

#include <algorithm>
#include <limits>

namespace skitter::reference {
namespace {

// A bone's two ways to turn: radially, toward or away from its rest direction, and tangentially.
struct Joint {
  glm::dvec3 d{0, 0, 1};
  double s = 0;                                           // sine of the angle from rest
  glm::dvec2 h{1, 0};                                     // the way it is turned from rest
  glm::dvec3 radial{0}, tangential{0};                    // movement of the tip a radian
  double room = std::numeric_limits<double>::infinity();  // radial, up to the limit
  double pull = 0;                                        // z_i
  bool held = false;
  double radialStep = 0, tangentialStep = 0;
};

Joint jointAt(const Posture& posture, const BoneRest& bone, size_t i) {
  Joint joint;
  joint.d = direction(posture.directions()[i]);
  joint.s = std::hypot(joint.d.x, joint.d.y);
  if (joint.s >= 1e-6) joint.h = glm::dvec2(joint.d.x, joint.d.y) / joint.s;
  if (bone.length > 0) {
    const glm::dmat3& a = posture.frame(i);
    const glm::dvec3 r = posture.tip() - posture.joint(i);
    const glm::dvec3 radialAxis = joint.h.x * a[1] - joint.h.y * a[0];
    const glm::dvec3 tangentialAxis =
        a[2] * (joint.s / std::max(1 + joint.d.z, 1e-12)) - (joint.h.x * a[0] + joint.h.y * a[1]);
    joint.radial = glm::cross(radialAxis, r);
    joint.tangential = glm::cross(tangentialAxis, r);
  }
  const double t = bone.tanHalfCone, sine = 2 * t / (1 + t * t), cosine = (1 - t * t) / (1 + t * t);
  const double denominator = cosine * joint.d.z + sine * joint.s;
  if (denominator >= 0.1) joint.room = (sine * joint.d.z - cosine * joint.s) / denominator;
  return joint;
}

// Holds what meets its limit, at most twice; leaves the free joints' steps and the matrix' inverse.
glm::dmat3 solveWithLimits(std::vector<Joint>& joints, double mu, glm::dvec3 e) {
  glm::dmat3 inverse(1);
  for (int pass = 0; pass < 3; ++pass) {
    glm::dmat3 m(mu);
    for (const Joint& joint : joints) {
      if (!joint.held) m += glm::outerProduct(joint.radial, joint.radial);
      m += glm::outerProduct(joint.tangential, joint.tangential);
    }
    inverse = glm::inverse(m);
    const glm::dvec3 lambda = inverse * e;
    bool anyHeld = false;
    for (Joint& joint : joints) {
      joint.tangentialStep = glm::dot(joint.tangential, lambda);
      if (joint.held) continue;
      joint.radialStep = joint.pull + glm::dot(joint.radial, lambda);
      if (joint.radialStep > joint.room && pass < 2) {
        joint.held = anyHeld = true;
        joint.radialStep = joint.room;
        e -= (joint.room - joint.pull) * joint.radial;
      }
    }
    if (!anyHeld) break;
  }
  return inverse;
}

void moveTo(const std::vector<Joint>& joints, const Limb& limb, Posture& posture) {
  for (size_t i = 0; i < joints.size(); ++i) {
    const Joint& joint = joints[i];
    const glm::dvec3 d = normalized(
        joint.d + joint.radialStep * glm::dvec3(joint.h.x * joint.d.z, joint.h.y * joint.d.z, -joint.s) +
        joint.tangentialStep * glm::dvec3(-joint.h.y, joint.h.x, 0));
    posture.place(i, clampCone(stereographic(d), limb.bones[i].tanHalfCone));
  }
}

}  // namespace

void activeSet(const Tuning& tuning, const Limb& limb, const glm::dvec3& target, int chords, Posture& posture,
               double& damping) {
  glm::dvec3 e = target - posture.tip();
  const double before = glm::length(e);
  const double mu = (0.25 * std::min(before * before, 0.25) + 1e-5) * damping;
  if (before > 0.5) e *= 0.5 / before;

  std::vector<Joint> joints;
  for (size_t i = 0; i < posture.bones(); ++i) {
    joints.push_back(jointAt(posture, limb.bones[i], i));
    Joint& joint = joints.back();
    if (chords > 0 && before < tuning.pullError) {
      joint.pull = -tuning.restPull * limb.bones[i].stiffness * joint.s;
      e -= joint.pull * joint.radial;
    }
  }
  const glm::dmat3 inverse = solveWithLimits(joints, mu, e);
  const std::vector<glm::dvec2> old = posture.directions();
  moveTo(joints, limb, posture);
  for (int chord = 0; chord < chords; ++chord) {
    const glm::dvec3 lambda = inverse * (target - posture.tip());
    for (Joint& joint : joints) {
      if (!joint.held) joint.radialStep += glm::dot(joint.radial, lambda);
      joint.tangentialStep += glm::dot(joint.tangential, lambda);
    }
    moveTo(joints, limb, posture);
  }
  const double after = glm::length(target - posture.tip());
  if (after > 1.0001 * before && after > tuning.ikTolerance) {
    posture.setDirections(old);
    damping = std::min(16 * damping, 4096.0);
  } else {
    damping = std::max(damping / 10, 1.0);
  }
}

}  // namespace skitter::reference
