#include <gtest/gtest.h>

#include <cmath>

#include "files.h"
#include "height_bytes.h"
#include "skitter/heightfield.h"

namespace skitter {
namespace {

using test::append;
using test::inputFault;
using test::npy;
using test::TemporaryFolder;
using ::testing::Test;

std::string dictionary(const std::string& descr, const std::string& shape, bool fortran = false) {
  return "{'descr': '" + descr + "', 'fortran_order': " + (fortran ? "True" : "False") +
         ", 'shape': " + shape + ", }";
}

struct NpyHeights : Test {
  TemporaryFolder folder;

  Heightfield load(const std::vector<uint8_t>& bytes, const HeightfieldUnits& units = {}) {
    test::writeBytes(folder / "a.npy", bytes);
    return loadHeightfield(folder / "a.npy", units);
  }
  std::string fault(const std::vector<uint8_t>& bytes) {
    const std::string what = inputFault([&] { load(bytes); });
    EXPECT_NE(what.find("a.npy: "), std::string::npos) << what;
    return what;
  }
};

TEST_F(NpyHeights, EverySampleType) {
  const int values[] = {1, 2, 3, 4, 5, 9};
  const auto bytesOf = [&](auto convert, bool bigEndian) {
    std::vector<uint8_t> bytes;
    for (const int value : values) append(bytes, convert(value), bigEndian);
    return bytes;
  };
  const auto i2 = [](int v) { return static_cast<uint16_t>(v); };
  const auto i4 = [](int v) { return static_cast<uint32_t>(v); };
  const auto f4 = [](int v) { return std::bit_cast<uint32_t>(static_cast<float>(v)); };
  const auto f8 = [](int v) { return std::bit_cast<uint64_t>(static_cast<double>(v)); };
  const std::pair<std::string, std::vector<uint8_t>> metres[] = {
      {"<i2", bytesOf(i2, false)}, {">i2", bytesOf(i2, true)},  {"<i4", bytesOf(i4, false)},
      {">i4", bytesOf(i4, true)},  {"<f4", bytesOf(f4, false)}, {">f4", bytesOf(f4, true)},
      {"<f8", bytesOf(f8, false)}, {">f8", bytesOf(f8, true)}};
  for (const auto& [descr, bytes] : metres) {
    for (const int version : {1, 2, 3}) {
      const Heightfield field = load(npy(version, dictionary(descr, "(2, 3)"), bytes));
      EXPECT_EQ(field.columns, 3u) << descr;
      EXPECT_EQ(field.rows, 2u) << descr;
      EXPECT_EQ(field.heights, (std::vector<float>{-4, -3, -2, -1, 0, 4})) << descr;
    }
  }

  HeightfieldUnits units;
  units.minHeight = 0;
  units.maxHeight = 255;
  const auto u1 = [](int v) { return static_cast<uint8_t>(v); };
  EXPECT_NEAR(load(npy(1, dictionary("|u1", "(2, 3)"), bytesOf(u1, false)), units).heights[5], 4, 1e-4);
  units.maxHeight = 65535;
  EXPECT_NEAR(load(npy(1, dictionary("<u2", "(2, 3)"), bytesOf(i2, false)), units).heights[5], 4, 1e-3);
}

TEST_F(NpyHeights, FortranOrderIsTurned) {
  std::vector<uint8_t> bytes;
  for (const int value : {1, 4, 2, 5, 3, 9}) append(bytes, static_cast<uint16_t>(value));
  EXPECT_EQ(load(npy(1, dictionary("<i2", "(2, 3)", true), bytes)).heights,
            (std::vector<float>{-4, -3, -2, -1, 0, 4}));
}

TEST_F(NpyHeights, Voids) {
  std::vector<uint8_t> bytes;
  for (const int value : {-32768, 7, 7, 7}) append(bytes, static_cast<uint16_t>(value));
  EXPECT_EQ(load(npy(1, dictionary("<i2", "(2, 2)"), bytes)).filledVoids, 1u);
  bytes.clear();
  for (const double value : {7.0, std::nan(""), 7.0, 7.0}) append(bytes, std::bit_cast<uint64_t>(value));
  const Heightfield field = load(npy(1, dictionary("<f8", "(2, 2)"), bytes));
  EXPECT_EQ(field.filledVoids, 1u);
  EXPECT_EQ(field.heights, std::vector<float>(4, 0));
  bytes.clear();
  for (const double value : {7.0, 1e300, 7.0, 7.0}) append(bytes, std::bit_cast<uint64_t>(value));
  EXPECT_NE(fault(npy(1, dictionary("<f8", "(2, 2)"), bytes)).find("column 1, row 0"), std::string::npos);
}

TEST_F(NpyHeights, RefusesEveryTruncationAndTrailingBytes) {
  const std::vector<uint8_t> whole = npy(1, dictionary("<f4", "(2, 2)"), test::r32f({1, 2, 3, 4}));
  EXPECT_NO_THROW(load(whole));
  for (size_t size = 1; size < whole.size(); ++size) {
    EXPECT_FALSE(fault({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)}).empty()) << size;
  }
  std::vector<uint8_t> more = whole;
  more.push_back(0);
  EXPECT_NE(fault(more).find("17 bytes of samples"), std::string::npos);
}

TEST_F(NpyHeights, RefusesStrangeHeaders) {
  const std::vector<uint8_t> four = test::r32f({1, 2, 3, 4});
  const std::pair<std::string, const char*> cases[] = {
      {dictionary("|O", "(2, 2)"), "type \"|O\""},
      {dictionary("<c8", "(2, 2)"), "type \"<c8\""},
      {dictionary("|f4", "(2, 2)"), "type \"|f4\""},
      {dictionary("f4", "(2, 2)"), "type \"f4\""},
      {dictionary("", "(2, 2)"), "type \"\""},
      {dictionary("<f4", "(4,)"), "1 dimensions"},
      {dictionary("<f4", "()"), "0 dimensions"},
      {dictionary("<f4", "(1, 2, 2)"), "3 dimensions"},
      {dictionary("<f4", "(1, 4)"), "4 x 1"},
      {dictionary("<f4", "(2, 3)"), "24"},
      {dictionary("<f4", "(16385, 2)"), "16385"},
      {dictionary("<f4", "(18446744073709551615, 2)"), "18446744073709551615"},
      {dictionary("<f4", "(18446744073709551616, 2)"), "no whole number"},
      {dictionary("<f4", "(-2, 2)"), "no whole number"},
      {dictionary("<f4", "(2, 2"), "no whole number"},
      {dictionary("<f4", "2"), "( is missing"},
      {"{'descr': [('z', '<f4')], 'fortran_order': False, 'shape': (2, 2), }", "structure"},
      {"{'descr': '<f4', 'descr': '<f4', 'fortran_order': False, 'shape': (2, 2), }", "twice"},
      {"{'descr': '<f4', 'fortran_order': 0, 'shape': (2, 2), }", "neither True nor False"},
      {"{'fortran_order': False, 'shape': (2, 2), }", "descr is missing"},
      {"{'descr': '<f4', 'shape': (2, 2), }", "fortran_order is missing"},
      {"{'descr': '<f4', 'fortran_order': False, }", "shape is missing"},
      {"{'descr': '<f4', 'fortran_order': False, 'shape': (2, 2), 'more': 1}", "unknown key"},
      {"{'descr': '<f4', 'fortran_order': False, 'shape': (2, 2), } x", "follows"},
      {"{'descr': '<f4 }", "does not end"},
      {"{'descr'", ": is missing"},
      {"[]", "{ is missing"},
      {"", "{ is missing"}};
  for (const auto& [header, words] : cases) {
    const std::string what = fault(npy(1, header, four));
    EXPECT_NE(what.find(words), std::string::npos) << header << ": " << what;
  }

  std::vector<uint8_t> bytes = npy(1, dictionary("<f4", "(2, 2)"), four);
  bytes[0] = 'N';
  EXPECT_NE(fault(bytes).find("wrong signature"), std::string::npos);
  EXPECT_NE(fault(npy(4, dictionary("<f4", "(2, 2)"), four)).find("version 4"), std::string::npos);
  EXPECT_NE(fault(npy(0, dictionary("<f4", "(2, 2)"), four)).find("version 0"), std::string::npos);
  bytes = npy(2, dictionary("<f4", "(2, 2)"), four);
  bytes[10] = bytes[11] = 0xff;
  EXPECT_NE(fault(bytes).find("claims"), std::string::npos);
}

}  // namespace
}  // namespace skitter
