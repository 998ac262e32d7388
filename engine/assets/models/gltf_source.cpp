#include "assets/models/gltf_source.h"

#include <cmath>

namespace skitter::gltf {

void Notes::add(const std::string& kind, std::string line) {
  const auto [known, isNew] = kinds_.try_emplace(kind, Kind{lines.size(), 0});
  if (isNew) {
    lines.push_back(std::move(line));
  } else {
    ++known->second.more;
  }
}

std::vector<std::string> Notes::finished() const {
  std::vector<std::string> all = lines;
  for (const auto& [name, kind] : kinds_)
    if (kind.more > 0) all[kind.line] += fmt::format(", and {} more like it", kind.more);
  return all;
}

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
