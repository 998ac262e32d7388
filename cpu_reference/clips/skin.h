#pragma once

#include <array>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace skitter::reference {

// What carries a skin's vertices through a clip: docs/clip.md, Skin.

// P: the file's units and axes to metres of model space, with unit axes at a right angle.
glm::dmat4 placement(const glm::dvec3& origin, double scale, const glm::dvec3& up, const glm::dvec3& forward);

struct SkinWeight {
  int joint = 0;  // of the skin
  double weight = 0;
};
// The four heaviest, scaled to sum to 1.
std::vector<SkinWeight> heaviest(std::vector<SkinWeight>);
// The glTF way: P sum w_j G_j B_j x. `joints` are the skin's nodes.
glm::dvec3 skinVertex(const glm::dmat4& P, const std::vector<glm::dmat4>& pose, std::span<const int> joints,
                      std::span<const glm::dmat4> inverseBind, std::span<const SkinWeight>,
                      const glm::dvec3& vertex);

struct PaletteEntry {
  int node = 0;
  glm::dmat4 constant{1};  // C
};
// A of a skin or a rigid mesh: rest pose of a node times what binds the vertices to it; 1 if it cannot be
// inverted.
glm::dmat4 bindTransform(const glm::dmat4& restOfNode, const glm::dmat4& inverseBind);
// M = P G C P^-1 of every entry, its root's motion taken out.
std::vector<glm::dmat4> paletteAt(const glm::dmat4& P, const std::vector<glm::dmat4>& pose,
                                  std::span<const PaletteEntry>, const glm::dvec3& rootVelocity, double t);
// Where a joint lies at the start: P C^-1 (0, 0, 0, 1).
glm::dvec3 jointStart(const glm::dmat4& P, const PaletteEntry&);

// How far a box that entry e moves is displaced at most by the difference of two of its matrices.
double displacement(const glm::dmat4& a, const glm::dmat4& b, const glm::dvec3& low, const glm::dvec3& high);

}  // namespace skitter::reference
