#include "experiments/grounds.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

namespace skitter::experiments {
namespace {

constexpr float spacingWanted = 0.5f;  // metres a sample

Heightfield noise(const char* name, const TerrainNoise& settings) {
  Heightfield field = generateHeightfield(settings);
  field.name = name;
  return field;
}

Ground fromFile(const TerrainFileChoice& choice) {
  HeightfieldUnits units;
  Heightfield field = loadHeightfield(choice.file, units);
  const double scale = choice.scale.value_or(spacingWanted / std::max(field.spacingX, field.spacingZ));
  units.scale = static_cast<float>(scale);
  field = loadHeightfield(choice.file, units);
  std::string what = fmt::format("{}, scaled by {:.3g} to {:.2g} x {:.2g} m a sample",
                                 choice.file.filename().string(), scale, field.spacingX, field.spacingZ);
  return {choice.name, std::move(what), std::move(field)};
}

}  // namespace

Heightfield flatGround() {
  return noise("flat", {.columns = 257, .rows = 257, .spacing = 0.5f, .amplitude = 0});
}
Heightfield rollingGround() { return noise("rolling", {}); }
Heightfield steepGround() {
  return noise("steep", {.amplitude = 6, .wavelength = 14, .octaves = 5, .gain = 0.42f, .seed = 3});
}

std::vector<Ground> allGrounds(const std::vector<TerrainFileChoice>& files) {
  std::vector<Ground> grounds = {
      {"flat", "generated, level", flatGround()},
      {"rolling", "generated, hills of 8 m every 48 m, six octaves", rollingGround()},
      {"steep", "generated, hills of 6 m every 14 m, five octaves", steepGround()},
  };
  for (const TerrainFileChoice& choice : files) grounds.push_back(fromFile(choice));
  for (const char* file : {"jacksboro_403x344.png", "everest_513x513.png"}) {
    const std::string name(file, std::strchr(file, '_'));
    const bool replaced =
        std::any_of(files.begin(), files.end(), [&](const auto& choice) { return choice.name == name; });
    if (!replaced) grounds.push_back(fromFile({name, std::filesystem::path(SKITTER_TERRAIN) / file, {}}));
  }
  return grounds;
}

}  // namespace skitter::experiments
