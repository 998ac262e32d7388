#pragma once

#include <bit>
#include <cstdint>
#include <string>
#include <vector>

namespace skitter::test {

template <typename Bits>
void append(std::vector<uint8_t>& bytes, Bits bits, bool bigEndian = false) {
  for (size_t k = 0; k < sizeof(Bits); ++k) {
    bytes.push_back(static_cast<uint8_t>(bits >> (8 * (bigEndian ? sizeof(Bits) - 1 - k : k))));
  }
}

std::vector<uint8_t> r16(const std::vector<uint16_t>& codes);
std::vector<uint8_t> r32f(const std::vector<float>& metres);

// A .npy file: `dictionary` is padded as NumPy pads it, and `samples` follow.
std::vector<uint8_t> npy(int version, const std::string& dictionary, const std::vector<uint8_t>& samples);

// An SRTM3 tile of one height but for those at `changed`.
struct HgtSample {
  uint32_t column, row;
  int16_t metres;
};
std::vector<uint8_t> hgt(uint32_t side, int16_t metres, const std::vector<HgtSample>& changed = {});

}  // namespace skitter::test
