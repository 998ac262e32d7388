#include "assets/models/gltf_accessors.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace skitter::gltf {
namespace {

constexpr size_t maxElements = size_t{1} << 24;  // of an accessor
constexpr size_t maxZeros = size_t{1} << 20;     // elements of an accessor without data
constexpr size_t maxNumbers = size_t{1} << 26;   // of all accessors, each as often as it is used

// `size` bytes of a buffer view from `offset`, whole.
const uint8_t* view(const Source& source, int index, uint64_t offset, uint64_t size,
                    const std::string& what) {
  source.checkIndex(index, source.model.bufferViews.size(), what + ".bufferView");
  const tinygltf::BufferView& from = source.model.bufferViews[static_cast<size_t>(index)];
  const std::string viewName = fmt::format("bufferViews[{}]", index);
  source.checkIndex(from.buffer, source.file.buffers.size(), viewName + ".buffer");
  const auto& data = source.file.buffers[static_cast<size_t>(from.buffer)];
  if (data.empty()) {
    // The data are in the extension's own buffer view, this one is for what unpacks them.
    const nlohmann::json& view = source.file.json.at("bufferViews")[static_cast<size_t>(index)];
    for (const char* packer : {"EXT_meshopt_compression", "KHR_meshopt_compression"})
      if (view.contains("extensions") && view.at("extensions").contains(packer))
        source.fail("{} {}", viewName, unpackHint(packer));
    source.fail("{} is of buffers[{}], which has no data", viewName, from.buffer);
  }
  if (from.byteOffset > data.size() || from.byteLength > data.size() - from.byteOffset) {
    source.fail("{} reaches past the {} bytes of its buffer", viewName, data.size());
  }
  if (offset > from.byteLength || size > from.byteLength - offset) {
    source.fail("{} reaches past the {} bytes of {}", what, from.byteLength, viewName);
  }
  return data.data() + from.byteOffset + offset;
}

double component(const uint8_t* at, int type, bool normalized) {
  const auto as = [at](auto value) {
    std::memcpy(&value, at, sizeof(value));
    return value;
  };
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return normalized ? std::max(as(int8_t{}) / 127.0, -1.0) : as(int8_t{});
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return normalized ? *at / 255.0 : *at;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return normalized ? std::max(as(int16_t{}) / 32767.0, -1.0) : as(int16_t{});
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return normalized ? as(uint16_t{}) / 65535.0 : as(uint16_t{});
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return as(uint32_t{});
    default:
      return static_cast<double>(as(float{}));
  }
}

template <typename Decode>
void readSparse(const Source& source, const tinygltf::Accessor& from, const std::string& what, size_t size,
                const Decode& decode, size_t count) {
  const auto& sparse = from.sparse;
  const int type = sparse.indices.componentType;
  if (sparse.count < 1 || static_cast<size_t>(sparse.count) > count || sparse.indices.byteOffset < 0 ||
      sparse.values.byteOffset < 0 ||
      (type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE && type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
       type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT)) {
    source.fail("{} has malformed sparse values", what);
  }
  const size_t width = static_cast<size_t>(tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(type)));
  const size_t entries = static_cast<size_t>(sparse.count);
  const uint8_t* indices =
      view(source, sparse.indices.bufferView, static_cast<uint64_t>(sparse.indices.byteOffset),
           entries * width, what + ".sparse.indices");
  const uint8_t* data =
      view(source, sparse.values.bufferView, static_cast<uint64_t>(sparse.values.byteOffset), entries * size,
           what + ".sparse.values");
  for (size_t i = 0; i < entries; ++i) {
    const double element = component(indices + i * width, type, false);
    if (element >= static_cast<double>(count))
      source.fail("{} replaces element {} of {}", what, element, count);
    decode(data + i * size, static_cast<size_t>(element));
  }
}

}  // namespace

Values readAccessor(Source& source, int index, std::initializer_list<int> types, bool integers,
                    const std::string& use, NotFinite notFinite) {
  source.checkIndex(index, source.model.accessors.size(), use);
  const tinygltf::Accessor& from = source.model.accessors[static_cast<size_t>(index)];
  const std::string what = fmt::format("accessors[{}] ({})", index, use);
  if (std::find(types.begin(), types.end(), from.type) == types.end())
    source.fail("{} has the wrong type", what);
  const int width = tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(from.componentType));
  const bool isInteger = from.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                         from.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
                         from.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
  if (width <= 0 || from.componentType == TINYGLTF_COMPONENT_TYPE_DOUBLE ||
      from.componentType == TINYGLTF_COMPONENT_TYPE_INT || (integers && !isInteger) ||
      (from.type == TINYGLTF_TYPE_MAT4 && from.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT)) {
    source.fail("{} has component type {}, which does not fit", what, from.componentType);
  }
  if (from.count > maxElements) {
    source.fail("{} has {} elements, expected up to {}", what, from.count, maxElements);
  }
  Values values;
  values.count = from.count;
  values.components = static_cast<size_t>(tinygltf::GetNumComponentsInType(static_cast<uint32_t>(from.type)));
  if (values.count == 0) return values;
  const size_t size = values.components * static_cast<size_t>(width);
  const uint8_t* data = nullptr;
  size_t stride = size;
  if (from.bufferView != -1) {
    source.checkIndex(from.bufferView, source.model.bufferViews.size(), what + ".bufferView");
    const size_t given = source.model.bufferViews[static_cast<size_t>(from.bufferView)].byteStride;
    if (given != 0) stride = given;
    if (stride < size || stride > 252 + size)
      source.fail("{} has a stride of {}, its elements {} bytes", what, stride, size);
    data = view(source, from.bufferView, from.byteOffset, stride * (values.count - 1) + size, what);
  } else if (values.count > maxZeros) {
    // Nothing in the file stands behind these elements, so their number is limited apart.
    source.fail("{} has {} elements without data, expected at most {}", what, values.count, maxZeros);
  }
  source.numbersRead += values.count * values.components;
  if (source.numbersRead > maxNumbers)
    source.fail("its accessors are read as over {} numbers in all", maxNumbers);
  values.numbers.resize(values.count * values.components);
  const auto decode = [&](const uint8_t* at, size_t element) {
    for (size_t k = 0; k < values.components; ++k) {
      double number = component(at + k * static_cast<size_t>(width), from.componentType, from.normalized);
      if (!std::isfinite(number)) {
        if (notFinite == NotFinite::refused) source.fail("{} holds {} in element {}", what, number, element);
        if (notFinite == NotFinite::zero) number = 0;
        ++values.notFinite;
      }
      values.numbers[element * values.components + k] = number;
    }
  };
  for (size_t i = 0; data && i < values.count; ++i) decode(data + i * stride, i);
  if (from.sparse.isSparse) readSparse(source, from, what, size, decode, values.count);
  return values;
}

std::span<const uint8_t> viewedBytes(const Source& source, int index, const std::string& use) {
  source.checkIndex(index, source.model.bufferViews.size(), use + ".bufferView");
  const size_t size = source.model.bufferViews[static_cast<size_t>(index)].byteLength;
  return {view(source, index, 0, size, use), size};
}

std::vector<glm::dvec3> toVectors(const Values& values) {
  std::vector<glm::dvec3> vectors(values.count);
  for (size_t i = 0; i < values.count; ++i) {
    const double* at = values.numbers.data() + i * values.components;
    vectors[i] = {at[0], at[1], at[2]};
  }
  return vectors;
}

}  // namespace skitter::gltf
