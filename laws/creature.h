#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <utility>
#include <vector>

namespace skitter::laws {

struct SkinVertex {
  glm::dvec3 rest{0};  // metres, model space: +Y up, the origin on the ground below the body
  std::array<uint32_t, 4> bones = {};
  std::array<double, 4> weights = {1, 0, 0, 0};
};

// Joints of a leg from its root to its foot, where they are at rest, and the bones that carry them.
struct LegJoint {
  glm::dvec3 rest{0};
  uint32_t bone = 0;
};
using Leg = std::vector<LegJoint>;

// A model as it is drawn. Bones are numbered as the transforms of a Moment are.
struct Creature {
  std::vector<SkinVertex> vertices = {};
  std::vector<uint32_t> triangles = {};  // into `vertices`, three each
  std::vector<Leg> legs = {};
  std::vector<int> legOfBone = {};  // that a bone is of, -1: of none, it moves with the body
  double legLength = 1;             // metres, of the longest
  glm::dvec3 forward{0, 0, 1};
};

// What the judge finds in a creature's skin at rest.
struct Anatomy {
  struct Edge {
    uint32_t a, b;
    double rest;  // metres
  };
  struct Knee {
    uint32_t joint;   // of the leg
    glm::dvec3 axis;  // unit, at rest: about which the leg bends there
  };
  struct Limb {
    std::vector<uint32_t> foot;  // vertices about the end of the leg
    std::vector<uint32_t> sole;  // the lowest of them
    std::vector<Knee> knees;     // that are bent at rest
    std::vector<double> radii;   // metres, of the skin about each bone
  };
  static constexpr size_t planes = 13;  // pairs

  explicit Anatomy(const Creature& creature);

  std::vector<Limb> limbs;
  std::vector<uint32_t> body;  // vertices that no leg moves and no foot has
  std::vector<Edge> edges;     // whose ends follow different bones
  // Pairs of bones of two legs, as leg and bone, that lie apart at rest.
  struct Pair {
    uint32_t legA, boneA, legB, boneB;
    double reach;  // metres: half of both bones' lengths
  };
  std::vector<Pair> pairs;
  double footprint = 0;  // metres: from the origin to the farthest foot at rest
  // The body between planes: from least to most along each direction.
  struct Hull {
    std::array<double, planes> least{}, most{};
    glm::dvec3 centre{0};
    double radius = 0;  // about `centre`, metres; 0: no body
  } hull;
};

// The directions of the planes of a hull, unit.
const std::array<glm::dvec3, Anatomy::planes>& hullDirections();
// Points of two segments that are nearest to each other: their distance.
double distanceOf(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d);

}  // namespace skitter::laws
