#include "render/composition.h"

#include <algorithm>
#include <cmath>

#include "skitter/records.h"

namespace skitter::render {
namespace {

constexpr float kNear = 0.05f;          // metres
constexpr float kLeastFog = 95.0f;      // metres at which fog has taken 63 %
constexpr float kFogOfTarget = 5.0f;    // the same, in distances from the eye to its target
constexpr float kSightOfFog = 2.1f;     // beyond this many fog distances 1 % is left to see
constexpr float kNearShadow = 1.9f;     // reach of the near cascade, in distances to the target
constexpr float kFarShadow = 4.5f;      // reach of the far cascade, in reaches of the near one
constexpr double kCasterHeight = 30.0;  // metres above a cascade's sphere from which agents cast shadows

struct Eye {
  glm::dvec3 position, right, up, forward;
  double tanX = 1, tanY = 1, toTarget = 1;
};

Eye eyeOf(const View& view, uint32_t width, uint32_t height) {
  Eye eye;
  eye.position = view.eye;
  const glm::dvec3 ahead = glm::dvec3(view.target) - eye.position;
  eye.toTarget = glm::length(ahead);
  eye.forward = eye.toTarget > 1e-6 ? ahead / eye.toTarget : glm::dvec3(0, 0, 1);
  const glm::dvec3 skyward = std::abs(eye.forward.y) < 0.9999 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1);
  eye.right = glm::normalize(glm::cross(eye.forward, skyward));
  eye.up = glm::cross(eye.right, eye.forward);
  eye.tanY = std::tan(0.5 * std::clamp(double(view.fieldOfView), 0.01, 3.0));
  eye.tanX = eye.tanY * width / height;
  return eye;
}

// Reversed depth, infinite far plane: depth is kNear / distance.
glm::dmat4 cameraClip(const Eye& eye, const glm::dvec3& position) {
  const glm::dvec3 x = eye.right / eye.tanX, y = eye.up / eye.tanY, w = eye.forward;
  glm::dmat4 clip(0.0);
  for (int i = 0; i < 3; ++i) {
    clip[i][0] = x[i];
    clip[i][1] = y[i];
    clip[i][3] = w[i];
  }
  clip[3] = {-glm::dot(x, position), -glm::dot(y, position), kNear, -glm::dot(w, position)};
  return clip;
}

glm::vec4 planeThrough(const glm::dvec3& point, const glm::dvec3& inward) {
  const glm::dvec3 n = glm::normalize(inward);
  return glm::vec4(glm::dvec4(n, -glm::dot(n, point)));
}

struct Cascade {
  glm::dmat4 clip;
  double texel;
};

// An orthographic view along the sunlight of the sphere about all that the camera sees up to `reach`. A
// sphere keeps its size when the camera turns, and its centre moves by whole texels, so that edges do not
// shimmer.
Cascade fitCascade(const Eye& eye, const glm::dvec3& towards, const glm::dvec2& origin, double reach,
                   uint32_t texels) {
  const double spread2 = eye.tanX * eye.tanX + eye.tanY * eye.tanY;
  const double along = std::min(reach, 0.5 * reach * (1 + spread2));
  const double radius = std::sqrt((reach - along) * (reach - along) + reach * reach * spread2);
  const double sized = std::max(std::ceil(radius * 8) / 8, std::hypot(along, 1e-3)) * 1.02;
  const double texel = 2 * sized / texels;

  const glm::dvec3 x = glm::normalize(glm::cross(glm::dvec3(0, 0, 1), towards));
  const glm::dvec3 y = glm::cross(towards, x);
  const glm::dvec3 centre =
      eye.position + eye.forward * along;  // world, so that snapping is to one grid for ever
  const double snappedX = std::floor(glm::dot(centre, x) / texel) * texel;
  const double snappedY = std::floor(glm::dot(centre, y) / texel) * texel;
  const double depth = glm::dot(centre, towards);

  const glm::dvec3 shift(origin.x, 0, origin.y);
  const double top = depth + sized + kCasterHeight, range = 2 * sized + 2 * kCasterHeight;
  glm::dmat4 clip(0.0);
  for (int i = 0; i < 3; ++i) {
    clip[i][0] = x[i] / sized;
    clip[i][1] = y[i] / sized;
    clip[i][2] = -towards[i] / range;
  }
  clip[3] = {(glm::dot(x, shift) - snappedX) / sized, (glm::dot(y, shift) - snappedY) / sized,
             (top - glm::dot(towards, shift)) / range, 1};
  return {clip, texel};
}

}  // namespace

Composition compose(const View& view, const LightModel& light, const Heightfield& terrain, float lowest,
                    float highest, uint32_t width, uint32_t height, uint32_t shadowTexels) {
  const Eye eye = eyeOf(view, width, height);
  constexpr double tile = shared::TILE_SIZE;
  const glm::dvec2 tileAt(std::floor(eye.position.x / tile), std::floor(eye.position.z / tile));

  Composition c;
  c.origin = tileAt * tile;
  const glm::dvec3 position = eye.position - glm::dvec3(c.origin.x, 0, c.origin.y);
  const float suits = std::max(
      {kLeastFog, kFogOfTarget * float(eye.toTarget), 2 * (view.eye.y - highest), 2 * (lowest - view.eye.y)});
  const float fog = light.fog > 0 ? light.fog : suits;
  c.viewDistance = kSightOfFog * fog;

  shared::Picture& b = c.block;
  b.clipFromPicture[shared::VIEW_CAMERA] = glm::mat4(cameraClip(eye, position));
  b.planes[0] = planeThrough(position, eye.forward * eye.tanX + eye.right);
  b.planes[1] = planeThrough(position, eye.forward * eye.tanX - eye.right);
  b.planes[2] = planeThrough(position, eye.forward * eye.tanY + eye.up);
  b.planes[3] = planeThrough(position, eye.forward * eye.tanY - eye.up);
  b.eye = glm::vec4(glm::vec3(position), float(2 * eye.tanY / height));
  b.right = glm::vec4(glm::vec3(eye.right * eye.tanX), 0);
  b.up = glm::vec4(glm::vec3(eye.up * eye.tanY), 0);
  b.sun = glm::vec4(glm::vec3(light.towards), 0);
  b.tile = glm::vec4(float(tileAt.x), float(tileAt.y), c.viewDistance, 1 / fog);
  b.ground = glm::vec4(float(terrain.originX() - c.origin.x), float(terrain.originZ() - c.origin.y),
                       terrain.spacingX, terrain.spacingZ);

  const double nearReach = std::clamp(kNearShadow * eye.toTarget, 4.0, 400.0);
  const Cascade nearCascade = fitCascade(eye, light.towards, c.origin, nearReach, shadowTexels);
  const double farReach = nearReach * kFarShadow;
  const Cascade farCascade = fitCascade(eye, light.towards, c.origin, farReach, shadowTexels);
  b.forward = glm::vec4(glm::vec3(eye.forward), float(farReach));
  b.clipFromPicture[shared::VIEW_CAMERA + 1] = glm::mat4(nearCascade.clip);
  b.clipFromPicture[shared::VIEW_CAMERA + 2] = glm::mat4(farCascade.clip);
  b.shadow = glm::vec4(float(nearCascade.texel), float(farCascade.texel),
                       std::max(0.0f, view.eye.y - highest), float(shadowTexels));
  return c;
}

}  // namespace skitter::render
