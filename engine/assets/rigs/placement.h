#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "skitter/rig_setup.h"

namespace skitter {

inline constexpr double maxCoordinate = 1e4;  // metres, of all that a rig or a clip holds

// How a model becomes the creature of its setup: the joints of its legs found, turned, moved and scaled.
struct Placement {
  std::vector<std::vector<int>> chains;  // a leg's joints, nodes from root to foot
  std::vector<std::vector<glm::dvec3>>
      points;  // where these rest, and the tip; in the model's units and axes
  // What each node goes with: the leg's bone that begins at it or at its nearest ancestor with one, else the
  // body.
  struct Carrier {
    int leg = -1, bone = -1;
  };
  std::vector<Carrier> carriers;
  glm::dmat3 rotation{1};
  glm::dvec3 origin{0};
  double scale = 1;

  glm::dvec3 toCreature(const glm::dvec3& position) const { return rotation * ((position - origin) * scale); }
  glm::dmat4 creatureFromModel() const;
};

// Messages begin with `name`, paths in them with `path`. Throws Error(input) naming the key that does not
// fit the model. A setup without legs leaves the model where it is unless it says its origin.
Placement placeModel(const Model& model, const RigSetup& setup, const std::string& name,
                     const std::string& path);

}  // namespace skitter
