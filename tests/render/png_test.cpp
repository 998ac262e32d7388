#include <gmock/gmock.h>
#include <png.h>
#include <signal.h>
#include <sys/resource.h>

#include <fstream>
#include <random>

#include "render/png.h"
#include "scratch_folder.h"
#include "skitter/error.h"
#include "skitter/image.h"

namespace skitter::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::vector<uint8_t> noise(uint32_t width, uint32_t height) {
  std::mt19937 random(7);
  std::vector<uint8_t> rgba(size_t(width) * height * 4);
  for (uint8_t& value : rgba) value = uint8_t(random());
  return rgba;
}

std::string faultOf(const std::filesystem::path& file, uint32_t width, uint32_t height) {
  try {
    writePng(file, width, height, noise(width, height));
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::input);
    return error.what();
  }
  return "no error";
}

void expectHolds(const std::filesystem::path& file, uint32_t width, uint32_t height,
                 const std::vector<uint8_t>& rgba) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  ASSERT_TRUE(png_image_begin_read_from_file(&image, file.c_str())) << image.message;
  ASSERT_EQ(image.width, width);
  ASSERT_EQ(image.height, height);
  image.format = PNG_FORMAT_RGBA;
  std::vector<uint8_t> read(PNG_IMAGE_SIZE(image));
  ASSERT_TRUE(png_image_finish_read(&image, nullptr, read.data(), 0, nullptr)) << image.message;
  for (size_t i = 0; i < rgba.size(); ++i) ASSERT_EQ(read[i], i % 4 == 3 ? 255 : rgba[i]) << "byte " << i;
}

TEST(Png, holdsTheColoursItWasGiven) {
  const ScratchFolder folder;
  for (const auto& [width, height] : {std::pair{1u, 1u}, {7u, 3u}, {64u, 33u}}) {
    const std::vector<uint8_t> rgba = noise(width, height);
    writePng(folder / "a.png", width, height, rgba);
    expectHolds(folder / "a.png", width, height, rgba);
    const std::string small = render::pngOf(width, height, rgba, render::PngEffort::small);
    std::ofstream(folder / "b.png", std::ios::binary) << small;
    expectHolds(folder / "b.png", width, height, rgba);
  }
}

TEST(Png, namesFileAndFaultWhenTheFolderIsMissing) {
  const ScratchFolder folder;
  EXPECT_THAT(faultOf(folder / "nowhere/a.png", 4, 4),
              AllOf(HasSubstr("nowhere/a.png"), HasSubstr("No such file")));
}

TEST(Png, replacesNothingAndLeavesNothingWhenTheDiskIsFull) {
  const ScratchFolder folder;
  std::ofstream(folder / "a.png") << "before";
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const auto handler = signal(SIGXFSZ, SIG_IGN);
  const rlimit tight{10000, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &tight);
  const std::string fault = faultOf(folder / "a.png", 200, 200);
  setrlimit(RLIMIT_FSIZE, &before);
  signal(SIGXFSZ, handler);
  EXPECT_THAT(fault, AllOf(HasSubstr("a.png"), HasSubstr("File too large")));
  EXPECT_EQ(std::filesystem::file_size(folder / "a.png"), 6u);
  EXPECT_FALSE(std::filesystem::exists(folder / "a.png.part"));
}

}  // namespace
}  // namespace skitter::test
