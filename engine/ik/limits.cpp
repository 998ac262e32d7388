#include "ik/limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "skitter/records.h"

namespace skitter::ik {
namespace {

constexpr float almostAlong = 0.999f;
constexpr auto widest = static_cast<float>(widestAngle);

void checkRange(size_t bone, const char* what, float least, float greatest) {
  if (!(least <= greatest && least >= -widest && greatest <= widest))
    throw faultOf(bone, fmt::format("its {} goes from {} to {} rad, expected a range within -3.1 to 3.1",
                                    what, least, greatest));
}

void checkAngle(size_t bone, float angle, float most) {
  if (!(angle > 0 && angle <= most))
    throw faultOf(bone,
                  fmt::format("a half-angle is {} rad, expected more than 0 and at most {}", angle, most));
}

}  // namespace

bool hasDirection(const glm::vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && glm::length(v) >= 1e-6f;
}

Error faultOf(size_t bone, const std::string& fault) {
  return inputError(fmt::format("bone {}: {}", bone, fault));
}

void expectCount(const char* name, size_t found, size_t expected) {
  if (found != expected)
    throw inputError(fmt::format("a batch was given {} {}, expected {}", found, name, expected));
}

void checkLimits(size_t number, const Bone& bone) {
  checkRange(number, "twist", bone.twistMin, bone.twistMax);
  if (const auto* cone = std::get_if<Cone>(&bone.limit)) checkAngle(number, cone->halfAngle, 3.15f);
  if (const auto* ellipse = std::get_if<Ellipse>(&bone.limit))
    for (const float angle : {ellipse->px, ellipse->py, ellipse->nx, ellipse->ny})
      checkAngle(number, angle, widest);
  if (const auto* hinge = std::get_if<Hinge>(&bone.limit)) {
    if (!hasDirection(hinge->axis)) throw faultOf(number, "its hinge has an axis without direction");
    if (std::fabs(glm::dot(glm::normalize(hinge->axis), glm::normalize(bone.direction))) > almostAlong)
      throw faultOf(number, "its hinge's axis lies along the bone, which it could not turn");
    checkRange(number, "hinge", hinge->min, hinge->max);
    if (bone.twistMin != 0 || bone.twistMax != 0) throw faultOf(number, "a hinge has no twist range");
  }
}

int kindOf(const Limit& limit) {
  if (std::holds_alternative<Free>(limit)) return 0;
  if (std::holds_alternative<Ellipse>(limit)) return shared::LIMIT_ELLIPSE;
  if (std::holds_alternative<Hinge>(limit)) return shared::LIMIT_HINGE;
  return shared::LIMIT_CONE;
}

glm::dvec4 numbersOf(const Limit& limit, const glm::dvec3& along) {
  if (const auto* ellipse = std::get_if<Ellipse>(&limit))
    return {ellipse->px, ellipse->py, ellipse->nx, ellipse->ny};
  if (const auto* hinge = std::get_if<Hinge>(&limit))
    return {std::tan(hinge->min / 2), std::tan(hinge->max / 2), along.x, along.z};
  return glm::dvec4(0);
}

glm::dvec3 leaning(double theta, double phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

double greatestAngle(const Limit& limit, double phi) {
  if (const auto* cone = std::get_if<Cone>(&limit)) return std::min<double>(cone->halfAngle, widestAngle);
  if (const auto* ellipse = std::get_if<Ellipse>(&limit)) {
    const double c = std::cos(phi), s = std::sin(phi);
    return 1 / std::hypot(c / (c < 0 ? ellipse->nx : ellipse->px), s / (s < 0 ? ellipse->ny : ellipse->py));
  }
  return widestAngle;
}

glm::dvec3 clamped(const Limit& limit, const glm::dvec3& d) {
  if (const auto* hinge = std::get_if<Hinge>(&limit)) {
    const double q = std::clamp<double>(std::atan2(-d.y, d.z), hinge->min, hinge->max);
    return {0, -std::sin(q), std::cos(q)};
  }
  if (std::holds_alternative<Free>(limit)) return d;
  const double theta = std::atan2(std::hypot(d.x, d.y), d.z), phi = std::atan2(d.y, d.x);
  const double most = greatestAngle(limit, phi);
  return theta <= most ? d : leaning(most, phi);
}

}  // namespace skitter::ik
