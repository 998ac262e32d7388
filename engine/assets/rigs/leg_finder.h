#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "skitter/model.h"

namespace skitter {

// A chain of joints that ends near the ground.
struct Limb {
  std::vector<int> chain;   // nodes, from where it leaves the body's joints to its end
  std::vector<int> joints;  // of these, those with a bone of their own, and the foot
  size_t inBody = 0;        // so many of the first joints are no part of the leg
  glm::dvec3 tip{0};        // where it meets the ground
  bool footJoint = true;    // the last joint is at the tip
  double reach = 0;         // from the first joint that is not in the body to the tip

  int root() const { return joints[inBody]; }
  size_t boneCount() const;
  // The foot is where the last joint is, whatever skin hangs from it.
  void endAtJoint(const Model& model);
  void measure(const Model& model);  // the reach
};

// Chains whose ends lie low along `up`, that are long enough to be legs, and whose ends are about level.
std::vector<Limb> findLimbs(const Model& model, const glm::dvec3& up);

// The words of a joint's name in lower case: "Leg4IK.L" is leg, 4, ik, l.
std::vector<std::string> wordsOf(const std::string& name);

}  // namespace skitter
