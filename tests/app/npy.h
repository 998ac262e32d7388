#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace skitter::test {

// A NumPy file of format 1.0, its header read as text; values of "<f4" and "|u1" as float.
struct Npy {
  std::string type;
  std::vector<uint64_t> shape;
  std::vector<float> values;

  // The value at a full index.
  float at(const std::vector<uint64_t>& index) const;
  float& at(const std::vector<uint64_t>& index);
};
// Fails the test where the file breaks the format or is not as long as its shape says.
Npy readNpy(const std::string& file);
// Writes type "<f4" or "|u1", and makes the folders of its path.
void writeNpy(const std::string& file, const Npy& npy);

}  // namespace skitter::test
