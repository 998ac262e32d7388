#pragma once

#include <limits>

#include "cpu_reference/ik/kinematics.h"

// The Jacobian of a chain with limits: docs/ik.md, "The Jacobian family", limited chains.
namespace skitter::reference {

// One way in which a joint can turn. Steps are radians.
struct Column {
  glm::dvec3 movement{0};                                              // of what is attached, a radian
  double low = -std::numeric_limits<double>::infinity(), high = -low;  // room up to the limit
  double pull = 0;                                                     // z, the step toward rest
  bool held = false;                                                   // at an end of its room
  double step = 0;                                                     // x
};

// The joint of one bone with what it was when the columns were made.
struct JointColumns {
  glm::dvec3 d{0, 0, 1};  // the bone's direction in its frame
  glm::dvec2 swing{0};    // its (X, Y)
  double s = 0;           // sine of the angle from rest
  glm::dvec2 h{1, 0};     // the way it is turned from rest
  double twist = 0;       // tan(tau / 2)
  // Column 0's way in terms of (radial, tangential), away from rest and around it; column 1's is (-way.y,
  // way.x).
  glm::dvec2 way{1, 0};
  // A hinge: its turn. A ball: radial, tangential, and the twist where there is a range for it. None for a
  // bone without length.
  std::vector<Column> columns;
};

// The columns of a point rigidly attached to the last bone and now at `attached`.
std::vector<JointColumns> columnsAt(const Posture& posture, const glm::dvec3& attached);

// Sets z: `share` of the sine of the angle from rest, back to it; not for the twist.
void pullToRest(const BoneRest& bone, double share, JointColumns& joint);

// The posture after the steps of all columns, clamped.
void applySteps(const std::vector<JointColumns>& joints, Posture& posture);

}  // namespace skitter::reference
