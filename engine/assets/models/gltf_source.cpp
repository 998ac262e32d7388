#include "assets/models/gltf_source.h"

#include <cmath>

namespace skitter::gltf {

void Source::checkIndex(int index, size_t count, const std::string& what) const {
  if (index < 0 || static_cast<size_t>(index) >= count) {
    fail("{} is {}, but there are {} of these", what, index, count);
  }
}

void Source::checkFinite(const std::vector<double>& values, size_t expected, const std::string& what) const {
  if (!values.empty() && values.size() != expected) {
    fail("{} has {} numbers, expected {}", what, values.size(), expected);
  }
  for (double value : values) {
    if (!std::isfinite(value) || std::fabs(value) > 1e15) fail("{} holds {}", what, value);
  }
}

}  // namespace skitter::gltf
