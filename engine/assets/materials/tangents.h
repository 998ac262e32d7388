#pragma once

#include <glm/glm.hpp>

#include "skitter/model.h"

namespace skitter {

// A tangent as a linear map takes it, of unit length; its side changes where the map mirrors. Where it
// vanishes, X takes its place.
glm::dvec4 turnedTangent(const glm::dmat3& linear, const glm::dvec4& tangent);

// The tangents of a primitive that has none: its vertices are those of the model's look from `first` on, its
// triangles the last `indices` indices. A corner's is the way along which u of the normal texture increases,
// at right angles to the vertex's normal. A vertex takes the mean of its corners, weighed by their angles.
// So does MikkTSpace, which glTF names (section 3.7.2.1), but that splits vertices where sides differ.
void makeTangents(Model& model, size_t first, size_t indices, const Texture& normal);

}  // namespace skitter
