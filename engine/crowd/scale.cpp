#include "crowd/scale.h"

namespace skitter::crowd {
namespace {

// Each names every member, so that a new one cannot be forgotten.
void scale(std::vector<SkinVertex>& vertices, float size) {
  for (auto& [position, normal, colour, bones, weights] : vertices) position *= size;
}

void scale(Leg& leg, float size) {
  auto& [name, group, bones, home, reach] = leg;
  home *= size;
  reach *= size;
  for (auto& [joint, start, direction, length, coneHalfAngle] : bones) {
    start *= size;
    length *= size;
  }
}

void scale(Clip& clip, float size) {
  auto& [name, seconds, channels, error, rootVelocity, speed, ground, least, most, times, rows, feet,
         stance] = clip;
  error *= static_cast<double>(size);
  for (glm::vec3* each : {&rootVelocity, &least, &most}) *each *= size;
  speed *= size;
  ground *= size;
  for (glm::vec4& row : rows) row.w *= size;
  for (glm::vec3& foot : feet) foot *= size;
}

}  // namespace

Rig scaled(Rig rig, float size) {
  auto& [name, legs, groups, legLength, bodyHeight, bodyRadius, vertices, indices, look, gaits] = rig;
  for (Leg& leg : legs) scale(leg, size);
  legLength *= size;
  bodyHeight *= size;
  bodyRadius *= size;
  scale(vertices, size);
  return rig;
}

ClipSet scaled(ClipSet set, float size) {
  auto& [name, extent, joints, vertices, indices, look, legs, clips, notes] = set;
  extent *= static_cast<double>(size);
  scale(vertices, size);
  for (auto& [entries, starts] : legs)
    for (glm::vec3& start : starts) start *= size;
  for (Clip& clip : clips) scale(clip, size);
  return set;
}

}  // namespace skitter::crowd
