#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "skitter/model.h"

namespace skitter {

// The vertices that follow each node most.
using SkinOfNodes = std::vector<std::vector<size_t>>;
SkinOfNodes skinOfNodes(const Model& model);

// A chain of joints that ends near the ground.
struct Limb {
  std::vector<int> chain;   // nodes, from where it leaves the body's joints to its end
  std::vector<int> joints;  // of these, those with a bone of their own, and the foot
  size_t inBody = 0;        // so many of the first joints are no part of the leg
  glm::dvec3 tip{0};        // where it meets the ground
  bool footJoint = true;    // the last joint is at the tip
  bool sole = false;        // the last bone is a foot whose skin lies on the ground
  glm::dvec3 toes{0};       // of a sole, from the ankle to the middle of the foot's skin, level
  bool strides = false;     // rests in mid-stride, its foot away from its home
  double reach = 0;         // from the first joint that is not in the body to the tip
  int pair = -1;            // the limb on the other side has the same number

  int root() const { return joints[inBody]; }
  size_t boneCount() const;
  // The foot is where the last joint is, whatever skin hangs from it.
  void endAtJoint(const Model& model);
  void measure(const Model& model);  // the reach
};

struct LimbSearch {
  std::vector<Limb> limbs;
  std::vector<std::string> notes;  // why chains that look like legs are none
};
// Chains that skin follows, whose ends lie within `lowShare` of the model's height above the ground along
// `up`, that are long enough to be legs, and whose ends are about level. A foot that hangs from a joint
// outside its chain, as those of inverse kinematics do, is the chain's last joint.
constexpr double footShare = 0.2;    // a foot that stands
constexpr double liftedShare = 0.5;  // a foot in mid-stride
LimbSearch findLimbs(const Model& model, const SkinOfNodes& skin, const glm::dvec3& up, double lowShare);

}  // namespace skitter
