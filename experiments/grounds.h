#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "skitter/heightfield.h"

namespace skitter::experiments {

// Ground that agents are judged on; `what` says where it comes from.
struct Ground {
  std::string name, what;
  Heightfield field;
};

// A terrain file that a user named. Without a scale its samples come to lie 0.5 m apart: half a leg length of
// the built-in spider.
struct TerrainFileChoice {
  std::string name;
  std::filesystem::path file;
  std::optional<double> scale;
};

Heightfield flatGround();
Heightfield rollingGround();  // the built-in scene's
Heightfield steepGround();

// flat, rolling and steep, then the files, then those of jacksboro and everest (assets/terrain) that no file
// replaces. Throws Error(input) for a file that cannot be read.
std::vector<Ground> allGrounds(const std::vector<TerrainFileChoice>& files);

}  // namespace skitter::experiments
