#include "npy.h"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

namespace skitter::test {

namespace {

uint64_t flatIndex(const std::vector<uint64_t>& shape, const std::vector<uint64_t>& index) {
  uint64_t flat = 0;
  for (size_t axis = 0; axis < shape.size(); ++axis) flat = flat * shape[axis] + index.at(axis);
  return flat;
}

}  // namespace

float Npy::at(const std::vector<uint64_t>& index) const { return values.at(flatIndex(shape, index)); }
float& Npy::at(const std::vector<uint64_t>& index) { return values.at(flatIndex(shape, index)); }

Npy readNpy(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  Npy npy;
  if (bytes.size() < 10 || bytes.compare(0, 8, std::string("\x93NUMPY\x01\x00", 8)) != 0) {
    ADD_FAILURE() << file << " is no NumPy file";
    return npy;
  }
  const size_t length = static_cast<unsigned char>(bytes[8]) + 256u * static_cast<unsigned char>(bytes[9]);
  EXPECT_EQ((10 + length) % 64, 0u);
  const std::string header = bytes.substr(10, length);
  EXPECT_EQ(header.back(), '\n');
  EXPECT_NE(header.find("'fortran_order': False"), std::string::npos);
  const size_t type = header.find("'descr': '") + 10;
  npy.type = header.substr(type, header.find('\'', type) - type);
  std::string shape = header.substr(header.find('(') + 1);
  std::istringstream axes(shape.substr(0, shape.find(')')));
  for (std::string axis; std::getline(axes, axis, ',');) npy.shape.push_back(std::stoull(axis));

  uint64_t count = 1;
  for (uint64_t axis : npy.shape) count *= axis;
  const size_t width = npy.type == "<f4" ? 4 : 1;
  EXPECT_EQ(bytes.size(), 10 + length + count * width) << file;
  npy.values.resize(count);
  for (uint64_t i = 0; i < count && 10 + length + (i + 1) * width <= bytes.size(); ++i) {
    const char* value = bytes.data() + 10 + length + i * width;
    if (width == 4) {
      std::memcpy(&npy.values[i], value, 4);
    } else {
      npy.values[i] = static_cast<unsigned char>(*value);
    }
  }
  return npy;
}

void writeNpy(const std::string& file, const Npy& npy) {
  std::filesystem::create_directories(std::filesystem::path(file).parent_path());
  std::string header = "{'descr': '" + npy.type + "', 'fortran_order': False, 'shape': (";
  for (const uint64_t axis : npy.shape) header += std::to_string(axis) + ",";
  header += ")}";
  header.resize((10 + header.size()) / 64 * 64 + 64 - 11, ' ');
  header += '\n';
  std::ofstream out(file, std::ios::binary);
  out << std::string("\x93NUMPY\x01\x00", 8) << static_cast<char>(header.size() % 256)
      << static_cast<char>(header.size() / 256) << header;
  for (const float value : npy.values) {
    if (npy.type == "<f4") {
      out.write(reinterpret_cast<const char*>(&value), 4);
    } else {
      out.put(static_cast<char>(value));
    }
  }
}

}  // namespace skitter::test
