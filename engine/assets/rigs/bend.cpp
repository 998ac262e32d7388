#include "assets/rigs/bend.h"

#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <vector>

#include "assets/materials/tangents.h"

namespace skitter {
namespace {

glm::dquat shortestArc(const glm::dvec3& from, const glm::dvec3& to) {
  const double cosine = glm::dot(from, to);
  if (cosine < -0.999999) return {1, 0, 0, 0};  // no bend turns a bone round
  return glm::normalize(glm::dquat(1 + cosine, glm::cross(from, to)));
}

}  // namespace

void bendLeg(Rig& rig, size_t leg, const glm::dvec3& direction, double degrees) {
  std::vector<Bone>& bones = rig.legs[leg].bones;
  std::vector<glm::dvec3> points;
  for (const Bone& bone : bones) points.emplace_back(bone.start);
  points.push_back(points.back() + glm::dvec3(bones.back().direction) * double{bones.back().length});
  const glm::dvec3 chord = points.back() - points.front();
  const double chordLength = glm::length(chord);
  glm::dvec3 side = direction;
  if (chordLength > 0) side -= chord * (glm::dot(direction, chord) / (chordLength * chordLength));
  if (!(glm::length(side) > 1e-9) || !(chordLength > 0)) return;
  side = glm::normalize(side);

  // A parabola over the chain, which at its middle leaves the chord as far as two bones at that angle would.
  const double height = 0.5 * chordLength * std::tan(0.5 * degrees * 3.14159265358979323846 / 180);
  std::vector<glm::dvec3> bent = points;
  double along = 0;
  for (size_t i = 1; i < points.size(); ++i) {
    along += double{bones[i - 1].length} / double{rig.legs[leg].reach};
    bent[i] += side * (height * 4 * along * (1 - along));
  }
  std::vector<glm::dquat> turns;
  std::vector<glm::dvec3> starts{points.front()};
  glm::dquat turn(1, 0, 0, 0);
  for (size_t i = 0; i < bones.size(); ++i) {
    const glm::dvec3 to = glm::normalize(bent[i + 1] - bent[i]);
    turn = glm::normalize(shortestArc(turn * glm::dvec3(bones[i].direction), to) * turn);
    turns.push_back(turn);
    starts.push_back(starts.back() + to * double{bones[i].length});
    bones[i].start = glm::vec3(starts[i]);
    bones[i].direction = glm::vec3(to);
  }

  const int first = 1 + static_cast<int>(leg) * rig.maxBones();
  for (size_t v = 0; v < rig.vertices.size(); ++v) {
    SkinVertex& vertex = rig.vertices[v];
    glm::dvec3 position(0), normal(0);
    glm::dmat3 turned(0);
    for (int k = 0; k < 4; ++k) {
      const double weight = double{vertex.weights[k]};
      const int bone = vertex.bones[k] - first;
      if (bone < 0 || bone >= static_cast<int>(turns.size())) {
        position += weight * glm::dvec3(vertex.position);
        normal += weight * glm::dvec3(vertex.normal);
        turned += weight * glm::dmat3(1);
        continue;
      }
      const auto b = static_cast<size_t>(bone);
      position += weight * (starts[b] + turns[b] * (glm::dvec3(vertex.position) - points[b]));
      normal += weight * (turns[b] * glm::dvec3(vertex.normal));
      turned += weight * glm::mat3_cast(turns[b]);
    }
    if (rig.look) {
      glm::vec4& tangent = rig.look.vertices[v].tangent;
      tangent = glm::vec4(turnedTangent(turned, glm::dvec4(tangent)));
    }
    vertex.position = glm::vec3(position);
    if (glm::length(normal) > 1e-9) vertex.normal = glm::vec3(glm::normalize(normal));
  }
}

}  // namespace skitter
