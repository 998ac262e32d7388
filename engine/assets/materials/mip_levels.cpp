#include "assets/materials/mip_levels.h"

#include <glm/glm.hpp>
#include <utility>

#include "base/srgb.h"

namespace skitter {
namespace {

// A texel of a level covers two of the level before. Where their number 2 m + 1 is odd, it covers shares of
// three: texel i of m all from i (2 m + 1) / m to (i + 1) (2 m + 1) / m.
struct Cover {
  uint32_t first = 0, count = 1;
  float weights[3] = {1, 0, 0};  // sum to 1
};

std::vector<Cover> coversOf(uint32_t size) {
  const uint32_t half = size / 2;
  if (half == 0) return {Cover{}};
  std::vector<Cover> covers;
  for (uint32_t i = 0; i < half; ++i) {
    if (size % 2 == 0) {
      covers.push_back({2 * i, 2, {0.5f, 0.5f, 0}});
      continue;
    }
    const auto whole = static_cast<float>(size);
    covers.push_back({2 * i,
                      3,
                      {static_cast<float>(half - i) / whole, static_cast<float>(half) / whole,
                       static_cast<float>(i + 1) / whole}});
  }
  return covers;
}

// Linear, 0 to 1.
glm::vec4 numbersOf(const uint8_t* texel, TexelKind kind) {
  glm::vec4 numbers;
  for (int k = 0; k < 4; ++k) {
    numbers[k] =
        kind == TexelKind::srgb && k < 3 ? base::linearOfByte(texel[k]) : static_cast<float>(texel[k]) / 255;
  }
  return numbers;
}

void store(const glm::vec4& numbers, TexelKind kind, uint8_t* texel) {
  for (int k = 0; k < 4; ++k) {
    texel[k] = kind == TexelKind::srgb && k < 3 ? base::byteOfLinear(numbers[k])
                                                : static_cast<uint8_t>(255 * numbers[k] + 0.5f);
  }
}

Texels halved(const Texels& from, TexelKind kind) {
  const std::vector<Cover> columns = coversOf(from.width), rows = coversOf(from.height);
  Texels to{static_cast<uint32_t>(columns.size()), static_cast<uint32_t>(rows.size()), {}};
  to.rgba.resize(size_t{4} * to.width * to.height);
  for (uint32_t y = 0; y < to.height; ++y) {
    for (uint32_t x = 0; x < to.width; ++x) {
      const Cover &across = columns[x], &down = rows[y];
      glm::vec4 sum(0);
      for (uint32_t j = 0; j < down.count; ++j) {
        for (uint32_t i = 0; i < across.count; ++i) {
          const size_t at = size_t{down.first + j} * from.width + across.first + i;
          sum += down.weights[j] * across.weights[i] * numbersOf(&from.rgba[4 * at], kind);
        }
      }
      store(sum, kind, &to.rgba[4 * (size_t{y} * to.width + x)]);
    }
  }
  return to;
}

}  // namespace

std::vector<Texels> mipLevels(Texels image, TexelKind kind) {
  std::vector<Texels> levels;
  levels.push_back(std::move(image));
  while (levels.back().width > 1 || levels.back().height > 1) levels.push_back(halved(levels.back(), kind));
  return levels;
}

}  // namespace skitter
