#include "app/common/noise_option.h"

#include <fmt/format.h>

#include <set>

#include "app/common/values.h"
#include "assets/heights/heightfield_limits.h"
#include "skitter/error.h"
#include "skitter/scene.h"

namespace skitter::app {
namespace {

constexpr std::string_view noiseKind = "noise";
constexpr double minLength = 1e-4;  // minSpacing as messages show it
static_assert(static_cast<float>(minLength) == minSpacing);

void set(TerrainNoise& noise, const std::string& option, const std::string& key, const std::string& value) {
  const std::string name = fmt::format("{}: {}", option, key);
  const auto number = [&](double least, double most) {
    return static_cast<float>(parseNumber(name, value, least, most));
  };
  const auto side = [&] { return static_cast<uint32_t>(parseWhole(name, value, minSamples, maxSamples)); };
  if (key == "columns") {
    noise.columns = side();
  } else if (key == "rows") {
    noise.rows = side();
  } else if (key == "spacing") {
    noise.spacing = number(minLength, maxSpacing);
  } else if (key == "amplitude") {
    noise.amplitude = number(0, Scene::maxCoordinate);
  } else if (key == "wavelength") {
    noise.wavelength = number(minLength, maxHeightMagnitude);
  } else if (key == "octaves") {
    noise.octaves = static_cast<int>(parseWhole(name, value, 1, TerrainNoise::maxOctaves));
  } else if (key == "gain") {
    noise.gain = number(0, 1);
  } else if (key == "seed") {
    noise.seed = parseWhole(name, value, 0, UINT64_MAX);
  } else {
    throw inputError(
        fmt::format("{}: {} is no key of noise, expected columns, rows, spacing, amplitude, wavelength, "
                    "octaves, gain or seed",
                    option, key.empty() ? "an empty word" : key));
  }
}

}  // namespace

bool isNoise(const std::string& text) {
  return text == noiseKind || text.rfind(std::string(noiseKind) + ":", 0) == 0;
}

TerrainNoise parseNoise(const std::string& option, const std::string& text) {
  TerrainNoise noise;
  std::set<std::string> seen;
  for (size_t at = noiseKind.size(); at < text.size();) {
    const size_t end = std::min(text.find(',', at + 1), text.size());
    const std::string word = text.substr(at + 1, end - at - 1);
    const size_t equals = word.find('=');
    if (equals == std::string::npos) {
      throw inputError(fmt::format("{}: {} has no value, expected KEY=VALUE", option,
                                   word.empty() ? "an empty word" : word));
    }
    const std::string key = word.substr(0, equals);
    if (!seen.insert(key).second) throw inputError(fmt::format("{}: {} is given twice", option, key));
    set(noise, option, key, word.substr(equals + 1));
    at = end;
  }
  return noise;
}

}  // namespace skitter::app
