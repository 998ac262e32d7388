// The example host, as a user runs it: with the validation layer, without a window and in one.
#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>

#include "app/process.h"

namespace skitter::test {
namespace {

class HostTest : public AppTest {
 protected:
  Result host(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), SKITTER_HOST_BINARY);
    arguments.push_back("--validate");
    return runProgram(arguments);
  }

  // The pixels of a PPM.
  std::vector<uint8_t> picture(const std::string& name) {
    std::ifstream in(file(name), std::ios::binary);
    std::string magic;
    size_t width = 0, height = 0, most = 0;
    in >> magic >> width >> height >> most;
    in.get();
    EXPECT_EQ(magic, "P6");
    std::vector<uint8_t> pixels(3 * width * height);
    in.read(reinterpret_cast<char*>(pixels.data()), static_cast<std::streamsize>(pixels.size()));
    EXPECT_TRUE(in) << name;
    return pixels;
  }
};

std::string hashIn(const std::string& text) {
  const size_t at = text.find("state hash ");
  return at == std::string::npos ? "no hash in " + text : text.substr(at + 11, 16);
}

// Its passes before and after change nothing of the crowd.
TEST_F(HostTest, WalksAsTheCommandDoes) {
  const std::string scene = SKITTER_ROOT "/assets/scenes/three_herds.json";
  const Result result =
      host({"--scene", scene, "--no-steer", "--frames", "40", "--size", "160x90", "--out", file("a.ppm")});
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.out, testing::HasSubstr("\n0 validation messages"));
  ASSERT_EQ(skitter({"run", scene, "--frames", "40", "--json", file("run.json")}).code, 0);
  EXPECT_EQ(hashIn(result.out), json("run.json")["stateHash"].get<std::string>());
}

TEST_F(HostTest, SteersAndDraws) {
  const auto shot = [&](const std::string& name, std::vector<std::string> more) {
    more.insert(more.end(), {"--size", "320x180", "--out", file(name)});
    const Result result = host(more);
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(result.err, "");
    EXPECT_THAT(result.out, testing::HasSubstr("\n0 validation messages"));
    return hashIn(result.out);
  };
  const std::string steered = shot("steered.ppm", {"--agents", "60", "--frames", "40"});
  EXPECT_EQ(shot("again.ppm", {"--agents", "60", "--frames", "40"}), steered);
  EXPECT_NE(shot("straight.ppm", {"--agents", "60", "--frames", "40", "--no-steer"}), steered);
  shot("empty.ppm", {"--agents", "0", "--frames", "40"});
  EXPECT_EQ(picture("steered.ppm"), picture("again.ppm"));
  // Agents cover a part of the picture, and the ground the rest.
  const std::vector<uint8_t> with = picture("steered.ppm"), without = picture("empty.ppm");
  size_t differ = 0;
  for (size_t i = 0; i < with.size(); i += 3) differ += !std::equal(&with[i], &with[i] + 3, &without[i]);
  EXPECT_GT(differ, with.size() / 3 / 200);
  EXPECT_LT(differ, with.size() / 3 / 2);
}

TEST_F(HostTest, RefusesScenesWhoseHerdsComeAndGo) {
  const Result result =
      host({"--scene", SKITTER_ROOT "/assets/scenes/waves.json", "--frames", "2", "--out", file("a.ppm")});
  EXPECT_EQ(result.code, 1);
  EXPECT_THAT(result.err, testing::HasSubstr("waves: an event adds or removes a herd"));
}

TEST_F(HostTest, ShowsAWindow) {
  const Result result = runProgram({"bash", "-c", R"sh(
    Xvfb -displayfd 3 -screen 0 640x480x24 -nolisten tcp 3> "$1/display" 2> /dev/null &
    server=$!
    trap 'kill $server' EXIT
    for i in $(seq 100); do [ -s "$1/display" ] || sleep 0.1; done
    DISPLAY=:$(cat "$1/display") timeout 120 "$2" --agents 20 --frames 20 --size 320x240 --validate
  )sh",
                                    "bash", file(""), SKITTER_HOST_BINARY});
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.out, testing::HasSubstr("20 ticks"));
  EXPECT_THAT(result.out, testing::HasSubstr("\n0 validation messages"));
}

}  // namespace
}  // namespace skitter::test
