#pragma once

#include <cmath>
#include <glm/glm.hpp>

#include "skitter/renderer.h"

namespace skitter::test {

// A view's pyramid in world metres and doubles, worked out without the renderer's matrices.
struct Sight {
  glm::dvec3 eye, forward, right, up;
  double tanX, tanY;  // half the picture's width and height one metre ahead

  Sight(const View& view, uint32_t width, uint32_t height)
      : eye(view.eye),
        forward(glm::normalize(glm::dvec3(view.target) - eye)),
        right(glm::normalize(glm::cross(forward, glm::dvec3(0, 1, 0)))),
        up(glm::cross(right, forward)),
        tanX(std::tan(0.5 * double(view.fieldOfView)) * width / height),
        tanY(std::tan(0.5 * double(view.fieldOfView))) {}

  // x and y are -1 to 1 across the picture; depth is metres along `forward`.
  glm::dvec3 at(double depth, double x, double y) const {
    return eye + depth * (forward + x * tanX * right + y * tanY * up);
  }
};

}  // namespace skitter::test
