#pragma once

#include <glm/glm.hpp>
#include <string>
#include <utility>
#include <vector>

#include "assets/models/gltf.h"
#include "assets/rigs/leg_finder.h"

namespace skitter {

// How a creature stands, as far as it is known of its model yet: which way is up, which way it walks, and
// which of its chains of joints are legs. Coordinates are the file's.
struct BodyPlan {
  const Model& model;
  const SkinOfNodes& skin;
  const gltf::Document* document = nullptr;  // the model's, for its clips; may be absent
  std::vector<Limb> limbs = {};
  glm::dvec3 up{0, 1, 0}, forward{0, 0, 1}, left{1, 0, 0};
  double middle = 0;                    // of the body, along `left`
  double confidence = 1;                // that it walks along `forward`, 0 to 1
  std::vector<std::string> notes = {};  // for people, a line each

  glm::dvec3 at(int node) const { return model.nodes[static_cast<size_t>(node)].position(); }
  double height(const glm::dvec3& p) const { return glm::dot(p, up); }
  glm::dvec3 flat(const glm::dvec3& p) const { return p - up * height(p); }
  // The ends of a leg's bones, from root to foot.
  std::vector<glm::dvec3> pointsOf(const Limb& limb) const {
    std::vector<glm::dvec3> points;
    for (size_t j = limb.inBody; j < limb.joints.size(); ++j) points.push_back(at(limb.joints[j]));
    if (!limb.footJoint) points.push_back(limb.tip);
    return points;
  }
  void note(std::string text) { notes.push_back(std::move(text)); }
};

}  // namespace skitter
