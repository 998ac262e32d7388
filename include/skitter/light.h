#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "skitter/enum_names.h"

namespace skitter {

// What lights pictures; docs/stages/pictures.md#light has the numbers of each.
enum class Sky {
  day,       // a warm sun in a blue sky
  overcast,  // grey clouds all over: hardly any shadow
  evening,   // a low red sun
  night,     // a moon, and stars
};
inline constexpr std::array allSkies = {Sky::day, Sky::overcast, Sky::evening, Sky::night};
constexpr const char* nameOf(Sky sky) {
  constexpr std::array names = {"day", "overcast", "evening", "night"};
  static_assert(names.size() == allSkies.size());
  return names[static_cast<size_t>(sky)];
}
constexpr std::optional<Sky> skyNamed(std::string_view name) { return enumNamed(allSkies, name); }

struct Light {
  // A lower sun's shadows would be longer than shadow maps hold.
  static constexpr float minElevation = 0.1f, maxElevation = 1.5707964f;  // radians
  static constexpr float minExposure = 0.05f, maxExposure = 20;
  static constexpr float minFog = 5, maxFog = 100000;  // metres

  Sky sky = Sky::day;
  // Where sun or moon stands: azimuth, radians about +Y from +Z, and elevation above the horizon, radians;
  // none: as of the sky.
  std::optional<glm::vec2> sun = {};
  float exposure = 1;  // times the sky's own
  // Metres at which fog has taken 63 %; none: as far as suits the camera.
  std::optional<float> fog = {};

  bool operator==(const Light&) const = default;
};

}  // namespace skitter
