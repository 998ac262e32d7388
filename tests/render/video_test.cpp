#include <gmock/gmock.h>
#include <signal.h>
#include <stdlib.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <fstream>
#include <thread>

#include "render/child.h"
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

// Half a second, whatever the pictures: every second one is left out, each is shown four times, one in three
// twice.
TEST(Video, playsAtTheRateOfItsPictures) {
  const ScratchFolder folder;
  for (const auto& [pictures, rate] : {std::pair{30, 60.0}, {4, 7.5}, {11, 22.5}, {500, 1000.0}}) {
    VideoWriter video(folder / "a.mp4", 64, 36, 30, rate);
    for (int i = 0; i < pictures; ++i) video.write(frame(64, 36, uint8_t(i)));
    video.finish();
    const std::string frames = probed(folder / "a.mp4").substr(std::string("h264,64,36,yuv420p,").size());
    EXPECT_NEAR(std::stod(frames), 30 * pictures / rate, 1)
        << pictures << " pictures, " << rate << " a second";
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

// A program that goes on without end and has a child that does so too, whose process it tells.
std::vector<std::string> hanging(const std::filesystem::path& told) {
  return {"sh", "-c", "sleep 1000 & echo $! > \"$0\"; wait", told.string()};
}

bool runs(const std::filesystem::path& told) {
  int process = 0;
  std::ifstream(told) >> process;
  EXPECT_GT(process, 0);
  // A process that was killed stays until it is waited for.
  std::ifstream status("/proc/" + std::to_string(process) + "/stat");
  std::string number, name, state;
  return bool(status >> number >> name >> state) && state != "Z";
}

TEST(Child, isKilledWithItsGroupWhenItHangs) {
  const ScratchFolder folder;
  const std::vector<std::byte> much(1 << 20);
  for (const bool whileWriting : {true, false}) {
    render::Child child(hanging(folder / "told"), folder / "output", std::chrono::milliseconds(500));
    while (!std::filesystem::exists(folder / "told") || std::filesystem::is_empty(folder / "told"))
      std::this_thread::yield();
    if (whileWriting) {
      EXPECT_FALSE(child.write(much));
    }
    EXPECT_FALSE(child.finish());
    EXPECT_TRUE(child.hung());
    while (runs(folder / "told")) std::this_thread::yield();
    std::filesystem::remove(folder / "told");
  }
}

TEST(Child, isNotHungWhileItsOutputGrows) {
  const ScratchFolder folder;
  render::Child child({"sh", "-c", "for i in 1 2 3 4 5 6 7 8; do echo $i >> \"$0\"; sleep 0.25; done",
                       (folder / "output").string()},
                      folder / "output", std::chrono::milliseconds(1500));
  EXPECT_TRUE(child.finish());
  EXPECT_FALSE(child.hung());
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
