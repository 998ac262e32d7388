#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <vector>

// Buffers of floats as the vec4 that they are.
namespace skitter::validation {

inline glm::dvec4 load(const std::vector<float>& records, size_t index) {
  const float* r = records.data() + 4 * index;
  return {r[0], r[1], r[2], r[3]};
}

inline void store(std::vector<float>& records, size_t index, const glm::dvec4& value) {
  for (int i = 0; i < 4; ++i) records[4 * index + static_cast<size_t>(i)] = static_cast<float>(value[i]);
}

// Two a vec4, the last one alone where their number is odd.
inline void storePairs(std::vector<float>& records, size_t index, const std::vector<glm::dvec2>& pairs) {
  for (size_t i = 0; i < pairs.size(); i += 2)
    store(records, index + i / 2, {pairs[i], i + 1 < pairs.size() ? pairs[i + 1] : glm::dvec2(0)});
}

// The index of the vec4 with which a record begins.
inline size_t at(size_t record, int stride) { return record * static_cast<size_t>(stride); }

}  // namespace skitter::validation
