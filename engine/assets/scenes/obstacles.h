#pragma once

#include <string>

#include "skitter/ways.h"

namespace skitter::scenes {

// Throws Error(input) where a number is not finite or out of its range, or a polygon is not convex; `what` is
// the obstacle's name in messages.
void checkObstacle(const Obstacle& obstacle, const std::string& what);
void checkThreat(const Threat& threat, const std::string& what);

}  // namespace skitter::scenes
