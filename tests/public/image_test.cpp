#include "skitter/image.h"

#include <cstring>

#include "public/public.h"

namespace skitter::test {
namespace {

TEST(PublicImage, IsAPngOfItsSize) {
  const OwnFolder folder;
  writePng(folder / "own.png", 5, 3, std::vector<uint8_t>(5 * 3 * 4, 200));
  std::ifstream file(folder / "own.png", std::ios::binary);
  unsigned char head[24] = {};
  ASSERT_TRUE(file.read(reinterpret_cast<char*>(head), sizeof head));
  EXPECT_EQ(std::memcmp(head, "\x89PNG\r\n\x1a\n", 8), 0);
  EXPECT_EQ(head[19], 5);  // big-endian width and height
  EXPECT_EQ(head[23], 3);
}

TEST(PublicImage, RefusesWhatCannotBeWrittenAndLeavesNothing) {
  const OwnFolder folder;
  const std::vector<uint8_t> pixel(4, 1);
  expectRefused("own.png: a picture of 2 x 1 pixels in 4 bytes",
                [&] { writePng(folder / "own.png", 2, 1, pixel); });
  expectRefused("a picture of 0 x 1 pixels", [&] { writePng(folder / "own.png", 0, 1, {}); });
  EXPECT_FALSE(std::filesystem::exists(folder / "own.png"));
  expectRefused("nowhere", [&] { writePng(folder / "nowhere" / "own.png", 1, 1, pixel); });
}

}  // namespace
}  // namespace skitter::test
