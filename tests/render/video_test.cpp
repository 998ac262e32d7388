#include <gmock/gmock.h>
#include <signal.h>
#include <stdlib.h>
#include <unistd.h>

#include <cstdio>

#include "scratch_folder.h"
#include "skitter/error.h"
#include "skitter/video.h"

namespace skitter::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::vector<uint8_t> frame(uint32_t width, uint32_t height, uint8_t value) {
  return std::vector<uint8_t>(size_t(width) * height * 4, value);
}

// "WIDTH,HEIGHT,PIXEL FORMAT,FRAMES" as ffprobe decodes it.
std::string probed(const std::filesystem::path& file) {
  const std::string command =
      "ffprobe -v error -count_frames -select_streams v -show_entries "
      "stream=codec_name,width,height,pix_fmt,nb_read_frames -of csv=p=0 " +
      file.string();
  FILE* pipe = popen(command.c_str(), "r");
  char line[256] = "";
  if (!fgets(line, sizeof line, pipe)) line[0] = '\0';
  pclose(pipe);
  return line;
}

template <class Call>
std::string faultOf(Call&& call) {
  try {
    call();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::input);
    return error.what();
  }
  return "no error";
}

TEST(Video, holdsEveryFrameAndPadsOddSizes) {
  const ScratchFolder folder;
  for (const auto& [width, height, says] :
       {std::tuple{64u, 36u, "h264,64,36,yuv420p,5\n"}, {33u, 17u, "h264,34,18,yuv420p,5\n"}}) {
    VideoWriter video(folder / "a.mp4", width, height, 30);
    for (int i = 0; i < 5; ++i) video.write(frame(width, height, uint8_t(40 * i)));
    EXPECT_EQ(video.frames(), 5u);
    EXPECT_FALSE(std::filesystem::exists(folder / "a.mp4"));
    video.finish();
    EXPECT_EQ(probed(folder / "a.mp4"), says);
    std::filesystem::remove(folder / "a.mp4");
    EXPECT_TRUE(folder.empty());
  }
}

TEST(Video, leavesNothingWhenItIsNotFinished) {
  const ScratchFolder folder;
  {
    VideoWriter video(folder / "a.mp4", 64, 36, 30);
    video.write(frame(64, 36, 100));
  }
  EXPECT_TRUE(folder.empty());
  EXPECT_THAT(faultOf([&] { VideoWriter(folder / "a.mp4", 64, 36, 30).finish(); }), HasSubstr("no frame"));
  EXPECT_TRUE(folder.empty());
}

TEST(Video, namesFileAndFaultWhenTheFolderIsMissing) {
  const ScratchFolder folder;
  EXPECT_THAT(faultOf([&] { VideoWriter(folder / "nowhere/a.mp4", 64, 36, 30); }),
              AllOf(HasSubstr("nowhere/a.mp4"), HasSubstr("No such file")));
}

TEST(Video, saysWhatToInstallWhenThereIsNoFfmpeg) {
  const ScratchFolder folder;
  const std::string path = getenv("PATH");
  setenv("PATH", "/nonexistent", 1);
  const std::string fault = faultOf([&] { VideoWriter(folder / "a.mp4", 64, 36, 30); });
  setenv("PATH", path.c_str(), 1);
  EXPECT_THAT(fault, AllOf(HasSubstr("ffmpeg"), HasSubstr("install")));
  EXPECT_TRUE(folder.empty());
}

TEST(Video, reportsAnEncoderThatFailsWithoutSigpipe) {
  const ScratchFolder folder;
  const std::string path = getenv("PATH");
  std::filesystem::create_symlink("/bin/false", folder / "ffmpeg");
  setenv("PATH", (folder / "").c_str(), 1);
  const std::string fault = faultOf([&] {
    VideoWriter video(folder / "a.mp4", 512, 512, 30);
    for (int i = 0; i < 100; ++i) video.write(frame(512, 512, 1));
    video.finish();
  });
  setenv("PATH", path.c_str(), 1);
  EXPECT_THAT(fault, HasSubstr("ffmpeg failed"));
  EXPECT_FALSE(std::filesystem::exists(folder / "a.mp4"));
  EXPECT_FALSE(std::filesystem::exists(folder / "a.mp4.part"));
}

// In a process group of its own, so that the interrupt reaches what a terminal's Ctrl-C would reach.
[[noreturn]] void interruptAndFinish(const std::filesystem::path& file) {
  setpgid(0, 0);
  signal(SIGINT, [](int) {});
  VideoWriter video(file, 64, 36, 30);
  for (int i = 0; i < 3; ++i) video.write(frame(64, 36, uint8_t(40 * i)));
  kill(0, SIGINT);
  usleep(200000);
  video.finish();
  _exit(0);
}

TEST(VideoDeathTest, isPlayableAfterAnInterrupt) {
  testing::FLAGS_gtest_death_test_style = "fast";
  const ScratchFolder folder;
  EXPECT_EXIT(interruptAndFinish(folder / "a.mp4"), testing::ExitedWithCode(0), "");
  EXPECT_EQ(probed(folder / "a.mp4"), "h264,64,36,yuv420p,3\n");
}

}  // namespace
}  // namespace skitter::test
