#include <algorithm>
#include <cmath>

#include "process.h"
#include "read_png.h"

namespace skitter::test {
namespace {

// Before and after a script of commands for xdotool; `shot N` takes the N-th screenshot. Arguments: the
// folder, the command, and its arguments.
constexpr const char* prologue = R"sh(
  cd "$1"
  shift
  Xvfb -displayfd 3 -screen 0 800x600x24 -nolisten tcp 3> display 2> /dev/null &
  server=$!
  trap 'kill $server' EXIT
  for i in $(seq 100); do [ -s display ] || sleep 0.1; done
  export DISPLAY=:$(cat display)
  timeout 120 "$@" &
  skitter=$!
  window=$(timeout 60 xdotool search --sync --name '^skitter:' | head -1)
  xdotool windowfocus "$window" mousemove --window "$window" 240 180
  press() { xdotool key "$@"; }
  shot() {
    press F12
    for i in $(seq 200); do
      [ -e "$(printf 'skitter-%04d.png' "$1")" ] && return
      sleep 0.05
    done
    echo "no screenshot $1" >&2
    kill $skitter
  }
)sh";
constexpr const char* epilogue = R"sh(
  press Escape
  wait $skitter
)sh";

// A window on a display of its own, used by keys and mouse. It begins paused, so that pictures do not change
// by themselves.
class Viewer : public AppTest {
 protected:
  Result use(const std::string& script, const std::vector<std::string>& arguments = {}) {
    std::vector<std::string> command = {"bash",   "-c",       prologue + script + epilogue,
                                        "bash",   file(""),   SKITTER_BINARY,
                                        "run",    "--paused", "--agents",
                                        "5",      "--size",   "480x360",

                                        "--json", "run.json"};
    command.insert(command.end(), arguments.begin(), arguments.end());
    return runProgram(command);
  }

  std::vector<uint8_t> shot(int number) {
    const Png png(file("skitter-000" + std::to_string(number) + ".png"));
    EXPECT_EQ(png.image.width, 480u);
    EXPECT_EQ(png.image.height, 360u);
    return png.rgb;
  }
};

double shareThatDiffers(const std::vector<uint8_t>& a, const std::vector<uint8_t>& b) {
  double count = 0;
  for (size_t i = 0; i < std::min(a.size(), b.size()); i += 3)
    count += std::equal(a.begin() + static_cast<long>(i), a.begin() + static_cast<long>(i) + 3,
                        b.begin() + static_cast<long>(i))
                 ? 0
                 : 1;
  return 3 * count / static_cast<double>(a.size());
}

// The mean of 30 x 30 pixels from that corner.
double brightness(const std::vector<uint8_t>& p, std::pair<size_t, size_t> corner) {
  double sum = 0;
  for (size_t y = corner.second; y < corner.second + 30; ++y)
    for (size_t x = 3 * corner.first; x < 3 * (corner.first + 30); ++x) sum += p[y * 3 * 480 + x];
  return sum / (3 * 30 * 30);
}

// Colours that neither ground, sky nor spiders have.
int violetPixels(const std::vector<uint8_t>& p) {
  int count = 0;
  for (size_t i = 0; i < p.size(); i += 3) count += p[i + 2] > 200 && p[i + 2] - p[i + 1] > 90 ? 1 : 0;
  return count;
}

TEST_F(Viewer, PausesStepsAndRestarts) {
  const Result result = use(R"sh(
    shot 1
    shot 2
    press Right Right Right Right
    shot 3
    press r
    shot 4
    press Right Right Right
  )sh");
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(json("run.json").at("ticks"), 3);
  EXPECT_EQ(shareThatDiffers(shot(1), shot(2)), 0);
  EXPECT_GT(shareThatDiffers(shot(1), shot(3)), 0.001);
  EXPECT_EQ(shareThatDiffers(shot(1), shot(4)), 0);
}

TEST_F(Viewer, ShowsOverlaysFiguresAndHelp) {
  const Result result = use(R"sh(
    shot 1
    press Right F8
    sleep 1  # in which the camera comes to the agent
    shot 2
    press F8
    shot 3
    press F1
    shot 4
    press F1 F2
    shot 5
  )sh",
                            {"--validation"});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(violetPixels(shot(1)), 0);
  EXPECT_GT(violetPixels(shot(2)), 600);
  EXPECT_EQ(violetPixels(shot(3)), 0);
  // Panels are dark, and the sky is not.
  EXPECT_LT(brightness(shot(4), {100, 20}), 0.5 * brightness(shot(3), {100, 20}));
  EXPECT_LT(brightness(shot(5), {20, 20}), 0.5 * brightness(shot(3), {20, 20}));
  EXPECT_GT(brightness(shot(5), {400, 20}), 0.9 * brightness(shot(3), {400, 20}));
}

TEST_F(Viewer, TheMouseAndKeysMoveTheCamera) {
  const Result result = use(R"sh(
    shot 1
    xdotool mousedown 1 mousemove_relative 60 0 mousemove_relative 60 10 mouseup 1
    shot 2
    xdotool mousedown 3 mousemove_relative 0 40 mouseup 3
    shot 3
    xdotool click 4 click 4 click 4
    sleep 0.3
    shot 4
    xdotool keydown w; sleep 0.5; xdotool keyup w
    shot 5
    press c
    shot 6
    xdotool mousemove --window "$window" 20 10 click 1
    sleep 0.3
    shot 7
    xdotool mousemove --window "$window" 240 180 click 1
    sleep 0.3
    shot 8
  )sh");
  ASSERT_EQ(result.code, 0) << result.err;
  for (int number = 1; number < 5; ++number)
    EXPECT_GT(shareThatDiffers(shot(number), shot(number + 1)), 0.3) << number;
  EXPECT_EQ(shareThatDiffers(shot(1), shot(6)), 0);
  // There is nobody in the sky.
  EXPECT_EQ(shareThatDiffers(shot(1), shot(7)), 0);
  EXPECT_GT(shareThatDiffers(shot(1), shot(8)), 0.3);
}

// clip knows no limits, so there is no figure of how well it keeps them.
TEST_F(Viewer, ChoosesTheController) {
  const Result result = use("press Right 3 space\nwait $skitter\nexit", {"--frames", "5"});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(json("run.json").at("ticks"), 5);
  EXPECT_TRUE(json("run.json").at("fidelity").at("limitViolation").is_null());
}

// The quadruped has no clips, so the crowd goes on as it is.
TEST_F(Viewer, StaysWithAControllerWhereAnotherCannotBe) {
  const Result result = use("press Right 3 Right", {"--rig", SKITTER_ROOT "/assets/quadruped.rig.json"});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(json("run.json").at("ticks"), 2);
  EXPECT_FALSE(json("run.json").at("fidelity").at("limitViolation").is_null());
}

TEST_F(Viewer, DoesNotBreakATrace) {
  const Result result = use("press Right r Right 2 Right", {"--frames", "100", "--trace", "trace"});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(json("run.json").at("ticks"), 3);
  EXPECT_EQ(json("trace/trace.json").at("ticks"), 3);
}

}  // namespace
}  // namespace skitter::test
