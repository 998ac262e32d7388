#include <gmock/gmock.h>

#include <csignal>
#include <filesystem>
#include <fstream>

#include "process.h"

namespace skitter::test {
namespace {

namespace fs = std::filesystem;
using Picture = AppTest;

int framesIn(const std::string& video) {
  const Result result = runProgram({"ffprobe", "-v", "error", "-count_frames", "-select_streams", "v:0",
                                    "-show_entries", "stream=nb_read_frames", "-of", "csv=p=0", video});
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  return std::atoi(result.out.c_str());
}

// Width and height from a PNG's header.
std::pair<int, int> sizeOf(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  unsigned char header[24] = {};
  in.read(reinterpret_cast<char*>(header), sizeof header);
  EXPECT_EQ(std::string(header + 1, header + 4), "PNG");
  const auto number = [&](int at) {
    return header[at] << 24 | header[at + 1] << 16 | header[at + 2] << 8 | header[at + 3];
  };
  return {number(16), number(20)};
}

TEST_F(Picture, FolderOfFramesAndVideo) {
  ASSERT_EQ(skitter({"run", "--agents", "1", "--frames", "5", "--size", "64x48", "--out", file("out")}).code,
            0);
  write("out/mine.png", "the user's");
  const Result result = skitter({"run", "--agents", "10", "--frames", "3", "--size", "64x48", "--out",
                                 file("out"), "--json", file("r.json")});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_NE(result.out.find("in place of an earlier run's 6 files"), std::string::npos) << result.out;
  EXPECT_EQ(files(),
            (std::vector<std::string>{"out/.skitter-files", "out/frame_00000.png", "out/frame_00001.png",
                                      "out/frame_00002.png", "out/mine.png", "out/skitter.mp4", "r.json"}));
  EXPECT_EQ(sizeOf(file("out/frame_00002.png")), std::pair(64, 48));
  EXPECT_EQ(framesIn(file("out/skitter.mp4")), 3);
  EXPECT_TRUE(json("r.json").at("cpuMicrosecondsPerAgentTick").is_null());
  EXPECT_GT(json("r.json").at("tickMilliseconds").at("median"), 0);
}

TEST_F(Picture, AVideoPlaysInRealTimeOrSlower) {
  struct Case {
    std::vector<std::string> options;
    int frames;
  };
  for (const Case& c : {Case{{"--dt", "0.1"}, 60},                 // 10 ticks of 0.1 s
                        Case{{"--dt", "0.1", "--fps", "30"}, 30},  //
                        Case{{"--ticks-per-frame", "2"}, 20},      // 20 ticks of 1/60 s
                        Case{{"--slow", "4"}, 40},                 // each picture is shown four times
                        Case{{"--slow", "4", "--dt", "0.0041666666667"}, 10}}) {  // and here once
    std::vector<std::string> command = {"run",    "--agents", "1",     "--frames",      "10",
                                        "--size", "64x48",    "--out", file("walk.mp4")};
    command.insert(command.end(), c.options.begin(), c.options.end());
    const Result result = skitter(command);
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_NEAR(framesIn(file("walk.mp4")), c.frames, 1) << c.options.back();
  }
  expectRefusal(skitter({"run", "--headless", "--slow", "4"}), 2, {"--slow", "--out"});
  expectRefusal(skitter({"run", "--frames", "1", "--dt", "0.002", "--out", file("short.mp4")}), 2,
                {"short.mp4", "no frame", "--slow"});
}

TEST_F(Picture, LastFrameOfAnEmptyTerrain) {
  const Result result =
      skitter({"run", "--agents", "0", "--frames", "2", "--size", "65x33", "--out", file("last.png")});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(files(), std::vector<std::string>{"last.png"});
  EXPECT_EQ(sizeOf(file("last.png")), std::pair(65, 33));
}

TEST_F(Picture, TimingsTellEveryPassOfAFrame) {
  const std::vector<std::string> command{"run",    "--agents",    "5",     "--frames",       "2",
                                         "--size", "65x33",       "--out", file("last.png"), "--render-scale",
                                         "0.5",    "--occlusion", "on"};
  const Result plain = skitter(command);
  std::vector<std::string> timed = command;
  timed.push_back("--timings");
  const Result result = skitter(timed);
  ASSERT_EQ(result.code, 0) << result.err;
  std::vector<std::string> passes{"simulation", "cull",     "splats",  "shadow",   "crowd",
                                  "ground",     "sky",      "enlarge", "readback", "encode",
                                  "occlusion",  "revealed", "contacts"};
  // Only a software device smooths edges by a pass; a GPU takes four samples.
  for (const char* software : {"llvmpipe", "SwiftShader"})
    if (result.out.find(software) != std::string::npos) passes.push_back("filter");
  for (const std::string& pass : passes)
    EXPECT_THAT(result.out, ::testing::ContainsRegex(pass + std::string(" +[0-9.]+ ms a frame"))) << pass;
  EXPECT_EQ(plain.out.find("ms a frame"), std::string::npos) << plain.out;
}

TEST_F(Picture, InterruptedVideoIsPlayable) {
  bool sent = false;
  const Result result =
      skitter({"run", "--agents", "2", "--frames", "20000", "--size", "64x48", "--out", file("walk.mp4"),
               "--trace", file("trace"), "--large", "--json", file("run.json")},
              {}, [&](int child) {
                const std::string joints = file("trace/.skitter.part/herd0/joints.npy.part");
                std::error_code error;
                if (sent || !(fs::file_size(joints, error) > 20000) || error) return;
                EXPECT_TRUE(fs::exists(file("walk.mp4.part")));
                EXPECT_FALSE(fs::exists(file("walk.mp4")));
                kill(child, SIGINT);
                sent = true;
              });
  ASSERT_TRUE(sent);
  EXPECT_EQ(result.code, 130) << result.err;
  EXPECT_NE(result.out.find("interrupted"), std::string::npos);
  EXPECT_TRUE(json("run.json").at("interrupted"));
  EXPECT_EQ(json("run.json").at("ticksWanted"), 20000);
  for (const std::string& name : files()) EXPECT_EQ(name.find(".part"), std::string::npos) << name;
  const int ticks = json("run.json").at("ticks");
  EXPECT_GT(ticks, 0);
  EXPECT_LT(ticks, 20000);
  EXPECT_EQ(framesIn(file("walk.mp4")), ticks);
  EXPECT_EQ(json("trace/trace.json").at("ticks"), ticks);
}

TEST_F(Picture, ASecondInterruptKills) {
  int sent = 0;
  const Result result = skitter({"run", "--headless", "--agents", "10", "--frames", "1000000", "--size",
                                 "64x48", "--out", file("walk.mp4")},
                                {}, [&](int child) {
                                  if (!fs::exists(file("walk.mp4.part")) || sent == 2) return;
                                  kill(child, SIGINT);
                                  ++sent;
                                });
  EXPECT_TRUE(result.code == 128 + SIGINT || result.code == 130) << result.code;
  if (result.code != 130) {
    EXPECT_FALSE(fs::exists(file("walk.mp4")));
  }
}

// On a display of its own, under the validation layer.
TEST_F(Picture, Window) {
  const char* script = R"(
    Xvfb -displayfd 1 -screen 0 800x600x24 -nolisten tcp > "$1" 2> /dev/null &
    server=$!
    trap 'kill $server' EXIT
    for i in $(seq 100); do [ -s "$1" ] || sleep 0.1; done
    export DISPLAY=:$(cat "$1")
    "$2" run --agents 5 --frames 8 --size 320x240 --validation --json "$3"
  )";
  const Result result =
      runProgram({"bash", "-c", script, "bash", file("display"), SKITTER_BINARY, file("run.json")});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(json("run.json").at("ticks"), 8);
  EXPECT_NE(result.out.find("frames      8"), std::string::npos) << result.out;
}

}  // namespace
}  // namespace skitter::test
