#include "skitter/video.h"

#include <limits>
#include <utility>

#include "public/public.h"

namespace skitter::test {
namespace {

TEST(PublicVideo, AppearsWhenItIsFinished) {
  const OwnFolder folder;
  const std::filesystem::path file = folder / "own.mp4";
  VideoWriter video(file, 32, 16, 30);
  for (int i = 0; i < 3; ++i) video.write(std::vector<uint8_t>(32 * 16 * 4, 90));
  EXPECT_EQ(video.frames(), 3u);
  EXPECT_FALSE(std::filesystem::exists(file));
  VideoWriter moved = std::move(video);
  moved.finish();
  EXPECT_GT(std::filesystem::file_size(file), 0u);
}

TEST(PublicVideo, RefusesSizesAndRatesThatCannotBe) {
  const OwnFolder folder;
  const std::filesystem::path file = folder / "own.mp4";
  expectRefused("own.mp4: cannot be written: frames of 0 x 16 pixels", [&] { VideoWriter(file, 0, 16, 30); });
  for (const double rate : {0.0, -1.0, 1001.0, std::numeric_limits<double>::quiet_NaN()})
    expectRefused("own.mp4: cannot be written: ", [&] { VideoWriter(file, 32, 16, rate); });
  expectRefused("own.mp4: cannot be written: ", [&] { VideoWriter(file, 32, 16, 30, -1); });
  expectRefused("nowhere", [&] { VideoWriter(folder / "nowhere" / "own.mp4", 32, 16, 30); });
  VideoWriter video(file, 32, 16, 30);
  expectRefused("a frame of 4 bytes, expected 2048", [&] { video.write(std::vector<uint8_t>(4)); });
  expectRefused("there is no frame", [&] { video.finish(); });
  EXPECT_FALSE(std::filesystem::exists(file));
}

}  // namespace
}  // namespace skitter::test
