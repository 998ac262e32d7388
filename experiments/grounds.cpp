#include "experiments/grounds.h"

#include <fmt/format.h>

#include <algorithm>

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
  for (const char* name : {"jacksboro", "everest"}) {
    const bool there =
        std::any_of(grounds.begin(), grounds.end(), [&](const Ground& g) { return g.name == name; });
    if (!there) grounds.push_back({name, "absent: its terrain file was not given", {}});
  }
  return grounds;
}

}  // namespace skitter::experiments
