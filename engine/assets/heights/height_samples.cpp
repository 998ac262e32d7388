#include "assets/heights/height_samples.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <type_traits>

#include "assets/heights/heightfield_limits.h"
#include "skitter/error.h"

namespace skitter {
namespace {

template <typename Bits>
Bits load(const uint8_t* from, bool bigEndian) {
  Bits bits = 0;
  for (size_t k = 0; k < sizeof(Bits); ++k) {
    const size_t shift = 8 * (bigEndian ? sizeof(Bits) - 1 - k : k);
    bits = static_cast<Bits>(bits | static_cast<Bits>(from[k]) << shift);
  }
  return bits;
}

// Narrowing a double beyond float's range is undefined.
float narrow(double value) {
  if (std::fabs(value) <= std::numeric_limits<float>::max() || std::isnan(value)) {
    return static_cast<float>(value);
  }
  return std::copysign(std::numeric_limits<float>::infinity(), value < 0 ? -1.0f : 1.0f);
}

template <typename Bits, typename Stored>
void decode(const uint8_t* from, size_t count, bool bigEndian, std::optional<double> voidValue, float* to) {
  const auto marked = static_cast<Stored>(
      std::clamp(voidValue.value_or(0), static_cast<double>(std::numeric_limits<Stored>::lowest()),
                 static_cast<double>(std::numeric_limits<Stored>::max())));
  for (size_t k = 0; k < count; ++k) {
    const auto stored = std::bit_cast<Stored>(load<Bits>(from + k * sizeof(Bits), bigEndian));
    bool isVoid = voidValue && marked == stored;
    if constexpr (std::is_same_v<Stored, int16_t>) isVoid = isVoid || stored == -32768;
    if (isVoid) {
      to[k] = std::numeric_limits<float>::quiet_NaN();
    } else if constexpr (std::is_unsigned_v<Stored>) {
      to[k] = static_cast<float>(stored) / static_cast<float>(std::numeric_limits<Stored>::max());
    } else {
      to[k] = narrow(static_cast<double>(stored));
    }
  }
}

template <typename Stored>
bool canHold(double value) {
  // A written decimal such as -3.4028235e38 may round to just beyond the largest float, which it means.
  const double slack = std::is_same_v<Stored, float> ? 1e-7 : 0;
  return value >= static_cast<double>(std::numeric_limits<Stored>::lowest()) * (1 + slack) &&
         value <= static_cast<double>(std::numeric_limits<Stored>::max()) * (1 + slack) &&
         (std::is_floating_point_v<Stored> || value == std::floor(value));
}

}  // namespace

size_t SampleType::bytes() const {
  switch (kind) {
    case Kind::u1:
      return 1;
    case Kind::u2:
    case Kind::i2:
      return 2;
    case Kind::i4:
    case Kind::f4:
      return 4;
    case Kind::f8:
      break;
  }
  return 8;
}

void decodeSamples(const uint8_t* from, size_t count, SampleType type, std::optional<double> voidValue,
                   float* to) {
  switch (type.kind) {
    case SampleType::Kind::u1:
      return decode<uint8_t, uint8_t>(from, count, type.bigEndian, voidValue, to);
    case SampleType::Kind::u2:
      return decode<uint16_t, uint16_t>(from, count, type.bigEndian, voidValue, to);
    case SampleType::Kind::i2:
      return decode<uint16_t, int16_t>(from, count, type.bigEndian, voidValue, to);
    case SampleType::Kind::i4:
      return decode<uint32_t, int32_t>(from, count, type.bigEndian, voidValue, to);
    case SampleType::Kind::f4:
      return decode<uint32_t, float>(from, count, type.bigEndian, voidValue, to);
    case SampleType::Kind::f8:
      return decode<uint64_t, double>(from, count, type.bigEndian, voidValue, to);
  }
}

void checkVoidValue(const std::string& file, SampleType type, std::optional<double> voidValue) {
  if (!voidValue) return;
  const auto possible = [&] {
    switch (type.kind) {
      case SampleType::Kind::u1:
        return canHold<uint8_t>(*voidValue);
      case SampleType::Kind::u2:
        return canHold<uint16_t>(*voidValue);
      case SampleType::Kind::i2:
        return canHold<int16_t>(*voidValue);
      case SampleType::Kind::i4:
        return canHold<int32_t>(*voidValue);
      case SampleType::Kind::f4:
        return canHold<float>(*voidValue);
      case SampleType::Kind::f8:
        break;
    }
    return canHold<double>(*voidValue);
  }();
  if (!possible) {
    throw inputError(fmt::format("{}: void value {} is none that its samples can have", file, *voidValue));
  }
}

void checkSampleCounts(const std::string& file, uint64_t columns, uint64_t rows) {
  if (columns < minSamples || columns > maxSamples || rows < minSamples || rows > maxSamples) {
    throw inputError(fmt::format("{}: is {} x {} samples, expected {} to {} a side", file, columns, rows,
                                 minSamples, maxSamples));
  }
}

}  // namespace skitter
