#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "skitter/material.h"

// What a rig needs of a glTF 2.0 file, as plain data in which every index is in range and every number
// finite.
namespace skitter::gltf {

struct Node {
  std::string name;
  int parent = -1;
  int mesh = -1, skin = -1;
  bool inScene = false;  // reachable from the default scene, or any node of a file without scenes
  // At rest. A node with a matrix has only that: it cannot be animated.
  bool hasMatrix = false;
  glm::dvec3 translation{0}, scale{1};
  glm::dquat rotation{1, 0, 0, 0};
  glm::dmat4 parentFromNode{1};
  glm::dmat4 modelFromNode{1};
};

struct Influence {
  uint32_t joint = 0;  // into Skin::joints
  double weight = 0;
};

struct Primitive {
  std::vector<glm::dvec3> positions;
  std::vector<glm::dvec3> normals;  // empty where the file has none
  std::vector<glm::dvec3> colours;  // linear, the material's base colour included
  std::vector<double> opacities;    // likewise
  int material = -1;                // into Document::materials; -1: the default one
  // Read where the material looks textures up; else, and where the file has none, empty.
  std::array<std::vector<glm::dvec2>, 2> uvs;  // TEXCOORD_0 and TEXCOORD_1
  std::vector<glm::dvec4> tangents;
  std::vector<Influence> influences;  // influencesPerVertex for each vertex, not all 0
  size_t influencesPerVertex = 0;
  size_t weightless = 0;          // vertices whose weights are all 0 in the file: the first counts as 1
  std::vector<uint32_t> indices;  // triangles
};

struct Mesh {
  std::vector<Primitive> primitives;
  uint32_t highestJoint = 0;  // of all influences
};

struct Skin {
  std::vector<int> joints;  // into Document::nodes
  std::vector<glm::dmat4> nodeFromBind;
};

enum class Path { translation, rotation, scale };
enum class Interpolation { step, linear, cubicSpline };

// Keys: times that rise strictly from 0 or later, at least one where a channel has it, and their values: 4
// numbers each (xyzw) for a rotation, of unit length but for cubic splines, else 3; for a cubic spline three
// runs of those a key: in-tangent, value, out-tangent.
struct Sampler {
  Path path = Path::translation;
  Interpolation interpolation = Interpolation::linear;
  std::vector<double> times, values;
};

struct Channel {
  int node = 0;
  size_t sampler = 0;
};

struct Clip {
  std::string name;
  double seconds = 0;           // the last time of all channels of the file
  size_t channelCount = 0;      // of the file
  std::vector<Channel> moving;  // those that move nodes, each property of a node once
  std::vector<Sampler> samplers;
};

struct Document {
  std::vector<Node> nodes;
  std::vector<int> parentsFirst;  // every node, after its parent
  std::vector<Mesh> meshes;
  std::vector<Skin> skins;
  std::vector<Clip> clips;
  Materials materials;             // as many as the file's
  std::vector<std::string> notes;  // what was left out, a line each
  nlohmann::json extras;  // `skitter` of the default scene's extras or of the first node that has it, or null
};

// A .glb or .gltf; buffers in other files are relative to `folder`, and refused without one. Throws
// Error(input) that begins with `name`.
Document parse(std::span<const uint8_t> bytes, const std::string& name,
               const std::filesystem::path& folder = {});

}  // namespace skitter::gltf
