#pragma once

#include <filesystem>
#include <span>

#include "glb_builder.h"

namespace skitter::test {

// Models with the oddities of those that people bring: joints that are turned at rest, feet without joints,
// names that mislead or are missing, armatures with a matrix, skins of twelve influences. docs/rigs.md tells
// of such files.
struct MadeModel {
  const char* file;
  Glb (*make)();
};
std::span<const MadeModel> madeModels();

// Writes all of them.
void writeMadeModels(const std::filesystem::path& folder);

// Speeds at which feet that stand go backward, in units a second.
inline constexpr double madeSpiderSpeed = 2.3, madeFoxWalk = 60, madeFoxRun = 120;
// The clip of the spider stands, then walks for a cycle and a half from this second on.
inline constexpr double madeSpiderWalks = 35 / 24.0, madeSpiderCycle = 16 / 24.0;

}  // namespace skitter::test
