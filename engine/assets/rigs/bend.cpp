#include "assets/rigs/bend.h"

#include <algorithm>
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

std::vector<glm::dvec3> pointsOf(const Leg& leg) {
  std::vector<glm::dvec3> points;
  for (const Bone& bone : leg.bones) points.emplace_back(bone.start);
  points.push_back(points.back() + glm::dvec3(leg.bones.back().direction) * double{leg.bones.back().length});
  return points;
}

// The rotation of each bone from its rest as `from` points to `to`: the shortest arc from the way that the
// bone before it carries it.
std::vector<glm::dquat> turnsOf(const std::vector<glm::dvec3>& from, const std::vector<glm::dvec3>& to) {
  std::vector<glm::dquat> turns;
  glm::dquat turn(1, 0, 0, 0);
  for (size_t i = 0; i + 1 < from.size(); ++i) {
    const glm::dvec3 bone = glm::normalize(from[i + 1] - from[i]);
    turn = glm::normalize(shortestArc(turn * bone, glm::normalize(to[i + 1] - to[i])) * turn);
    turns.push_back(turn);
  }
  return turns;
}

// Poses a leg at rest so that its bones point from one of `bent` to the next, skin and all. Its root stays.
void poseLeg(Rig& rig, size_t leg, const std::vector<glm::dvec3>& bent) {
  std::vector<Bone>& bones = rig.legs[leg].bones;
  const std::vector<glm::dvec3> points = pointsOf(rig.legs[leg]);
  const std::vector<glm::dquat> turns = turnsOf(points, bent);
  std::vector<glm::dvec3> starts{points.front()};
  for (size_t i = 0; i < bones.size(); ++i) {
    const glm::dvec3 to = glm::normalize(bent[i + 1] - bent[i]);
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

// The part of `direction` across `chord`, unit; 0 where there is none.
glm::dvec3 acrossOf(const glm::dvec3& direction, const glm::dvec3& chord) {
  const double square = glm::dot(chord, chord);
  const glm::dvec3 side = square > 0 ? direction - chord * (glm::dot(direction, chord) / square) : direction;
  return glm::length(side) > 1e-9 ? glm::normalize(side) : glm::dvec3(0);
}

// Adds a parabola over the chain from one point to another.
void arch(std::vector<glm::dvec3>& points, size_t first, size_t last, const glm::dvec3& by) {
  double length = 0, along = 0;
  for (size_t i = first; i < last; ++i) length += glm::length(points[i + 1] - points[i]);
  const std::vector<glm::dvec3> before = points;
  for (size_t i = first + 1; i <= last; ++i) {
    along += glm::length(before[i] - before[i - 1]) / length;
    points[i] += by * (4 * along * (1 - along));
  }
}

// Bends and turns points[first .. ankle] so that the ankle comes to `target`, bones keeping their lengths.
void bringAnkle(std::vector<glm::dvec3>& points, size_t first, size_t ankle, const glm::dvec3& target,
                const glm::dvec3& direction) {
  const std::vector<glm::dvec3> old = points;
  const glm::dvec3 root = old[first], chord = old[ankle] - root, wanted = target - root;
  if (!(glm::length(chord) > 0) || !(glm::length(wanted) > 0)) return;
  const glm::dvec3 way = glm::normalize(chord);
  if (const glm::dvec3 side = acrossOf(direction, chord); side != glm::dvec3(0)) {
    for (size_t i = first + 1; i < ankle; ++i) points[i] = root + way * glm::dot(points[i] - root, way);
    arch(points, first, ankle, side * (0.1 * glm::length(chord)));
  }
  // Each bone's part across the chord is scaled until root and ankle are as far apart as they shall be.
  const std::vector<glm::dvec3> shape = points;
  const auto spread = [&](double scale) {
    for (size_t i = first; i < ankle; ++i) {
      const glm::dvec3 bone = shape[i + 1] - shape[i], along = way * glm::dot(bone, way);
      const glm::dvec3 to = along + (bone - along) * scale;
      points[i + 1] =
          points[i] + (glm::length(to) > 1e-12 ? glm::normalize(to) : way) * glm::length(old[i + 1] - old[i]);
    }
    return glm::length(points[ankle] - root);
  };
  double least = 0, most = 64;
  for (int step = 0; step < 60; ++step) {
    const double scale = 0.5 * (least + most);
    (spread(scale) > glm::length(wanted) ? least : most) = scale;
  }
  const glm::dquat turn = shortestArc(glm::normalize(points[ankle] - root), glm::normalize(wanted));
  for (size_t i = first + 1; i <= ankle; ++i) points[i] = root + turn * (points[i] - root);
}

}  // namespace

void bendLeg(Rig& rig, size_t leg, const glm::dvec3& direction, double degrees) {
  std::vector<glm::dvec3> points = pointsOf(rig.legs[leg]);
  const glm::dvec3 chord = points.back() - points.front();
  const glm::dvec3 side = acrossOf(direction, chord);
  if (side == glm::dvec3(0) || !(glm::length(chord) > 0)) return;
  // In its middle a parabola leaves the chord as far as two bones at that angle would.
  const double height = 0.5 * glm::length(chord) * std::tan(0.5 * degrees * 3.14159265358979323846 / 180);
  arch(points, 0, points.size() - 1, side * height);
  poseLeg(rig, leg, points);
}

void settleLeg(Rig& rig, size_t leg, size_t footBones, const glm::dvec3& direction) {
  const std::vector<glm::dvec3> old = pointsOf(rig.legs[leg]);
  const size_t ankle = old.size() - 1 - footBones;
  const auto length = [&](size_t i) { return glm::length(old[i + 1] - old[i]); };
  const glm::dvec3 home(rig.legs[leg].home), foot = old.back() - old[ankle];
  // A short first bone is a hip or a shoulder within the body: it stays where the others suffice.
  size_t first = 0;
  while (first + 2 < ankle && length(first) < 0.25 * double{rig.legs[leg].reach}) ++first;
  double reach = 0;
  for (size_t i = first; i < ankle; ++i) reach += length(i);
  if (glm::length(home - foot - old[first]) > 0.97 * reach) first = 0;
  // The arcs that carry the foot there may leave it tilted. The foot is turned about +Y so that it stays
  // level.
  const auto pose = [&](double turn) {
    const glm::dquat about = glm::angleAxis(turn, glm::dvec3(0, 1, 0));
    std::vector<glm::dvec3> posed = old;
    bringAnkle(posed, first, ankle, home - about * foot, direction);
    for (size_t i = ankle; i + 1 < old.size(); ++i) posed[i + 1] = posed[i] + about * (old[i + 1] - old[i]);
    return posed;
  };
  const auto tilt = [&](double turn) {
    const glm::dvec3 up = turnsOf(old, pose(turn)).back() * glm::dvec3(0, 1, 0);
    return std::acos(std::clamp(up.y, -1.0, 1.0)) + 0.02 * std::fabs(turn);
  };
  double best = 0, least = footBones > 0 ? tilt(0) : 0;
  for (double step = 0.05; footBones > 0 && step > 1e-4; step *= 0.1) {
    const double middle = best;
    for (int k = -15; k <= 15; ++k) {
      const double turn = middle + step * k, value = tilt(turn);
      if (value >= least) continue;
      least = value;
      best = turn;
    }
  }
  const std::vector<glm::dvec3> posed = pose(best);
  poseLeg(rig, leg, posed);
}

}  // namespace skitter
