#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <string>
#include <vector>

#include "glb_builder.h"

namespace skitter::test {

class Creature;

// Where the joints of a creature are at a time, in the model's space.
class Pose {
 public:
  explicit Pose(const Creature& creature);

  // A joint and what hangs from it, about the joint.
  void turn(size_t joint, const glm::dquat& by);
  void move(size_t joint, const glm::dvec3& by);
  void stretch(size_t joint, double by) { scales[joint] *= by; }
  // Bends a limb of two bones at the knee, so that its end comes to `target` without turning.
  void reach(size_t root, const glm::dvec3& target);

  std::vector<glm::dvec3> places;
  std::vector<glm::dquat> turns;  // from rest
  std::vector<double> scales;     // of the joint's own skin: only for joints without children

 private:
  bool below(size_t joint, size_t ancestor) const;

  const Creature& creature_;
};

// A skinned model out of boxes, one along each bone. Joints are turned at rest: their +Y runs along the bone.
class Creature {
 public:
  struct Joint {
    std::string name;
    int parent = -1;
    glm::dvec3 at{0}, end{0};  // the box reaches from one to the other
    double radius = 0;         // half the width of the box; 0: no box
  };
  using Motion = std::function<void(Pose&, double seconds)>;

  size_t joint(const std::string& name, int parent, const glm::dvec3& at, const glm::dvec3& end,
               double radius);
  // A limb along `points`: a joint at each but the last, and there too if `foot` names one.
  size_t limb(const std::vector<std::string>& names, int parent, const std::vector<glm::dvec3>& points,
              double radius);
  // `scaled` gives all joints channels of all kinds; otherwise only what moves is animated.
  void clip(const std::string& name, double seconds, size_t keys, const Motion& motion,
            bool allChannels = false);

  Glb glb() const;

  const std::vector<Joint>& joints() const { return joints_; }

  bool indexed = true, named = true;
  bool zUp = false;      // the armature's matrix turns +Z up to +Y
  double weightSum = 1;  // of every second vertex
  std::string meshName = "skin";

 private:
  struct Clip {
    std::string name;
    std::vector<float> times;
    std::vector<Pose> poses;
    bool allChannels = false;
  };

  void addNodes(Glb& glb) const;
  void addSkin(Glb& glb) const;
  void addClip(Glb& glb, const Clip& clip) const;
  glm::dquat turnAtRest(size_t joint) const;
  glm::dquat armature() const;

  std::vector<Joint> joints_;
  std::vector<Clip> clips_;
};

// The shortest turn from one direction to another.
glm::dquat arc(const glm::dvec3& from, const glm::dvec3& to);

}  // namespace skitter::test
