#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

#include "skitter/export.h"
#include "skitter/material.h"

namespace skitter {

// A glTF 2.0 file as it comes, in its own units and axes: nodes and the mesh at rest, and what moves with
// what. Every index is in range, every number finite. docs/rigs.md tells how a model becomes a rig.
struct SKITTER_API Model {
  struct Node {
    std::string name;    // may be empty, and may be another node's too
    int parent = -1;     // -1: none
    bool joint = false;  // of a skin
    glm::dmat4 modelFromNode{1};

    glm::dvec3 position() const { return glm::dvec3(modelFromNode[3]); }
  };
  struct Influence {
    uint32_t node = 0;
    double weight = 0;  // of a vertex they sum to 1
  };
  struct Vertex {
    glm::dvec3 position{0};
    glm::vec3 normal{0, 1, 0};
    glm::vec3 colour{1};                          // linear RGB
    uint32_t firstInfluence = 0, influences = 0;  // a run of Model::influences, at least one
  };
  struct Clip {
    std::string name;
    double seconds = 0;
    size_t channels = 0;
  };

  std::string name;  // of the file, as messages give it
  std::vector<Node> nodes;
  std::vector<int> parentsFirst;  // every node, after its parent
  size_t skins = 0, meshes = 0, primitives = 0;
  std::vector<Vertex> vertices;
  std::vector<Influence> influences;
  std::vector<uint32_t> indices;  // triangles, counter-clockwise from outside
  Look look;                      // tangents at rest; none where colours at the vertices are all there is
  std::vector<Clip> clips;
  std::vector<std::string> notes;  // what is odd or was left out, a line each

  size_t jointCount() const;
  // A `node` that the model does not have throws Error(input); node -1 has no ancestor.
  bool isAncestor(int ancestor, int node) const;
  // A node's name in a sidecar: its own, or #INDEX where it has none or shares it. Throws likewise.
  std::string reference(int node) const;
};

// Reads a .glb or .gltf with its buffers. Throws Error(input) that names the file and the fault.
SKITTER_API Model loadModel(const std::filesystem::path& file);

}  // namespace skitter
