#include "ik/skeleton.h"

#include <algorithm>
#include <cmath>

#include "ik/limits.h"

namespace skitter::ik {
namespace {

using glm::dmat3;
using glm::dvec3;

// x = shortest(Z, z) X.
dmat3 ballFrame(const dvec3& z) {
  dvec3 x(1, 0, 0);
  if (z.z >= -0.999999) {
    const double k = 1 / (1 + z.z);
    x = dvec3(1 - z.x * z.x * k, -z.x * z.y * k, -z.x);
  }
  x = glm::normalize(x - z * glm::dot(x, z));
  return {x, glm::cross(z, x), z};
}

dmat3 hingeFrame(const dvec3& axis, const dvec3& bone) {
  const dvec3 z = glm::normalize(bone - axis * glm::dot(axis, bone));
  return {axis, glm::cross(z, axis), z};
}

// S(d).
dmat3 swing(const dvec3& d) {
  const double k = 1 / std::max(1 + d.z, 1e-12);
  return {dvec3(1 - k * d.x * d.x, -k * d.x * d.y, -d.x), dvec3(-k * d.x * d.y, 1 - k * d.y * d.y, -d.y), d};
}

dmat3 turnAboutZ(double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {dvec3(c, s, 0), dvec3(-s, c, 0), dvec3(0, 0, 1)};
}

}  // namespace

Skeleton::Skeleton(const Chain& chain) {
  const double reach = chain.reach();
  for (const Bone& bone : chain.bones) {
    Joint& joint = joints_.emplace_back();
    const dvec3 rest = glm::normalize(dvec3(bone.direction));
    joint.length = bone.length / reach;
    joint.limit = bone.limit;
    joint.stiffness = bone.stiffness;
    if (const auto* hinge = std::get_if<Hinge>(&bone.limit)) {
      const dvec3 axis = glm::normalize(dvec3(hinge->axis));
      const double along = glm::dot(axis, rest);
      joint.frame = hingeFrame(axis, rest);
      joint.axis = {along, 0, std::sqrt(1 - along * along)};
    } else {
      joint.frame = ballFrame(rest);
      joint.twistMin = bone.twistMin;
      joint.twistMax = bone.twistMax;
    }
  }
}

bool Skeleton::hasTwists() const {
  return std::any_of(joints_.begin(), joints_.end(),
                     [](const Joint& joint) { return joint.twistMin != 0 || joint.twistMax != 0; });
}

bool Skeleton::isPadded() const {
  return std::any_of(joints_.begin(), joints_.end(), [](const Joint& joint) { return joint.length == 0; });
}

bool Skeleton::restIsLegal() const {
  const Pose pose = rest();
  return std::all_of(pose.directions.begin(), pose.directions.end(),
                     [](const dvec3& d) { return d.z == 1; }) &&
         std::all_of(pose.twists.begin(), pose.twists.end(), [](double twist) { return twist == 0; });
}

bool Skeleton::restIsStraight() const {
  const std::vector<dvec3> places = place(rest());
  const dvec3 line = places.back() / std::max(glm::length(places.back()), 1e-10);
  return std::all_of(places.begin(), places.end(),
                     [&](const dvec3& p) { return glm::length(glm::cross(line, p)) < 2e-3; });
}

Skeleton::Pose Skeleton::rest() const {
  Pose pose;
  for (size_t i = 0; i < bones(); ++i) {
    pose.directions.push_back(clamped(joints_[i].limit, {0, 0, 1}));
    pose.twists.push_back(std::clamp(0.0, joints_[i].twistMin, joints_[i].twistMax));
  }
  return pose;
}

std::vector<dvec3> Skeleton::place(const Pose& pose) const {
  std::vector<dvec3> places;
  dmat3 carried(1);
  dvec3 p(0);
  for (size_t i = 0; i < bones(); ++i) {
    const Joint& joint = joints_[i];
    const dmat3 f = carried * joint.frame * swing(pose.directions[i]) * turnAboutZ(pose.twists[i]);
    p += joint.length * (f * joint.axis);
    places.push_back(p);
    carried = f * glm::transpose(joint.frame);
  }
  return places;
}

Skeleton::Pose Skeleton::aim(std::span<const dvec3> wanted) const {
  Pose pose = rest();
  dmat3 carried(1);
  for (size_t i = 0; i < bones(); ++i) {
    const Joint& joint = joints_[i];
    const dvec3 v = wanted[i + 1] - wanted[i];
    const dmat3 a = carried * joint.frame;
    if (joint.length > 0 && glm::length(v) > 1e-12) {
      dvec3 d = glm::transpose(a) * glm::normalize(v);
      if (std::holds_alternative<Hinge>(joint.limit) && std::hypot(d.y, d.z) > 1e-12)
        d = glm::normalize(dvec3(0, d.y, d.z));
      pose.directions[i] = clamped(joints_[i].limit, d);
    }
    carried = a * swing(pose.directions[i]) * turnAboutZ(pose.twists[i]) * glm::transpose(joint.frame);
  }
  return pose;
}

}  // namespace skitter::ik
