#include "skitter/heightfield.h"

#include <algorithm>
#include <cmath>

namespace skitter {

float Heightfield::at(float x, float z) const {
  // !(u > 0) also sends a NaN to the edge.
  const auto locate = [](float u, uint32_t samples, size_t& index) {
    const float last = static_cast<float>(samples - 1);
    if (!(u > 0)) u = 0;
    u = std::min(u, last);
    index = std::min<size_t>(static_cast<size_t>(u), samples - 2);
    return u - static_cast<float>(index);
  };
  const auto mix = [](float a, float b, float t) { return a + t * (b - a); };
  size_t i = 0, j = 0;
  const float a = locate((x - originX()) / spacingX, columns, i);
  const float b = locate((z - originZ()) / spacingZ, rows, j);
  const float* north = heights.data() + j * columns + i;
  const float* south = north + columns;
  return mix(mix(north[0], north[1], a), mix(south[0], south[1], a), b);
}

}  // namespace skitter
