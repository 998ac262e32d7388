#include "height_bytes.h"

namespace skitter::test {

std::vector<uint8_t> r16(const std::vector<uint16_t>& codes) {
  std::vector<uint8_t> bytes;
  for (const uint16_t code : codes) append(bytes, code);
  return bytes;
}

std::vector<uint8_t> r32f(const std::vector<float>& metres) {
  std::vector<uint8_t> bytes;
  for (const float value : metres) append(bytes, std::bit_cast<uint32_t>(value));
  return bytes;
}

std::vector<uint8_t> npy(int version, const std::string& dictionary, const std::vector<uint8_t>& samples) {
  const size_t start = version == 1 ? 10 : 12;
  std::string text = dictionary;
  text.append(63 - (start + text.size()) % 64, ' ');
  text += '\n';
  std::vector<uint8_t> bytes = {0x93, 'N', 'U', 'M', 'P', 'Y', static_cast<uint8_t>(version), 0};
  if (version == 1) append(bytes, static_cast<uint16_t>(text.size()));
  if (version != 1) append(bytes, static_cast<uint32_t>(text.size()));
  bytes.insert(bytes.end(), text.begin(), text.end());
  bytes.insert(bytes.end(), samples.begin(), samples.end());
  return bytes;
}

std::vector<uint8_t> hgt(uint32_t side, int16_t metres, const std::vector<HgtSample>& changed) {
  std::vector<uint8_t> bytes;
  bytes.reserve(size_t{side} * side * 2);
  for (size_t k = 0; k < size_t{side} * side; ++k) append(bytes, static_cast<uint16_t>(metres), true);
  for (const HgtSample& sample : changed) {
    const size_t at = 2 * (size_t{sample.row} * side + sample.column);
    bytes[at] = static_cast<uint8_t>(static_cast<uint16_t>(sample.metres) >> 8);
    bytes[at + 1] = static_cast<uint8_t>(sample.metres);
  }
  return bytes;
}

}  // namespace skitter::test
