#pragma once

#include "cpu_reference/types.h"

namespace skitter::reference {

double heightAt(const Heights& heights, double x, double z);
glm::dvec3 normalAt(const Heights& heights, double x, double z);

// What bounds an error of heightAt near a point: the steepest slopes along x and z of the cells around it,
// and the largest absolute height.
struct Relief {
  double slopeX = 0, slopeZ = 0, height = 0;
};
Relief reliefNear(const Heights& heights, double x, double z);

}  // namespace skitter::reference
