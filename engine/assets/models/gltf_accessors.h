#pragma once

#include <glm/glm.hpp>
#include <initializer_list>
#include <span>
#include <string>
#include <vector>

#include "assets/models/gltf_source.h"

namespace skitter::gltf {

struct Values {
  std::vector<double> numbers;
  size_t components = 1, count = 0;
  size_t notFinite = 0;  // numbers
};
enum class NotFinite { refused, zero, kept };

// All numbers of an accessor whose type has one of the given component counts; sparse and normalized ones as
// well. It may have no elements. `use` is what the file has it for.
Values readAccessor(Source& source, int index, std::initializer_list<int> types, bool integers,
                    const std::string& use, NotFinite notFinite = NotFinite::refused);

// The bytes of a buffer view, whole.
std::span<const uint8_t> viewedBytes(const Source& source, int index, const std::string& use);

// The first three components of each.
std::vector<glm::dvec3> toVectors(const Values& values);

}  // namespace skitter::gltf
