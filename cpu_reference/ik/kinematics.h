#pragma once

#include "cpu_reference/types.h"

namespace skitter::reference {

// (X, Y) = (d.x, d.y) / (1 + d.z) of a unit vector, and back.
glm::dvec2 stereographic(const glm::dvec3& d);
glm::dvec3 direction(const glm::dvec2& xy);

// How the bones of a chain with limits are turned from rest.
struct Pose {
  std::vector<glm::dvec2> swing;  // (X, Y) of each bone
  std::vector<double> twist;      // tan(tau / 2) of each bone

  static Pose rest(size_t bones) { return {std::vector(bones, glm::dvec2(0)), std::vector(bones, 0.0)}; }
};

// A pose with what forward kinematics makes of it: the base at 0, lengths divided by the reach.
class Posture {
 public:
  // `bones` stay the caller's.
  Posture(const std::vector<BoneRest>& bones, Pose pose);
  // Without twist.
  Posture(const Limb& limb, std::vector<glm::dvec2> directions);

  // Sets how bone i is turned and places it; the bones after it are stale until placed in turn, but frame(i +
  // 1) is not.
  void place(size_t i, const glm::dvec2& swing, double twist);
  void place(size_t i, const glm::dvec2& swing) { place(i, swing, twist(i)); }
  void setPose(const Pose& pose);

  size_t bones() const { return pose_.swing.size(); }
  const std::vector<BoneRest>& rests() const { return *bones_; }
  const BoneRest& bone(size_t i) const { return (*bones_)[i]; }
  const Pose& pose() const { return pose_; }
  const std::vector<glm::dvec2>& directions() const { return pose_.swing; }
  const glm::dvec2& swing(size_t i) const { return pose_.swing[i]; }
  double twist(size_t i) const { return pose_.twist[i]; }
  const glm::dmat3& frame(size_t i) const { return frames_[i]; }                              // A_i
  const glm::dmat3& turned(size_t i) const { return turned_[i]; }                             // F_i
  glm::dmat3 rotation(size_t i) const { return turned_[i] * glm::transpose(bone(i).frame); }  // R_i
  const std::vector<glm::dvec3>& joints() const { return joints_; }
  const glm::dvec3& joint(size_t i) const { return joints_[i]; }  // p_i
  const glm::dvec3& tip() const { return joints_.back(); }        // p_n

 private:
  const std::vector<BoneRest>* bones_;
  Pose pose_;
  std::vector<glm::dmat3> frames_, turned_;  // A_0 .. A_n, the last one unused, and F_i
  std::vector<glm::dvec3> joints_;
};

}  // namespace skitter::reference
