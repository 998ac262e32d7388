#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "process.h"

// Wrong use: each gives one line that names the fault, the right exit code, and leaves nothing behind.
namespace skitter::test {
namespace {

struct Usage : AppTest {
  // Exit 2, and the folder is as it was.
  void expectInputError(const std::vector<std::string>& arguments, const std::vector<std::string>& words) {
    SCOPED_TRACE(::testing::PrintToString(arguments));
    const std::vector<std::string> before = files();
    expectRefusal(skitter(arguments), 2, words);
    EXPECT_EQ(files(), before);
  }
};

TEST_F(Usage, NoSubcommand) { expectRefusal(skitter({}), 2, {"subcommand", "ik, info, inspect"}); }
TEST_F(Usage, UnknownSubcommand) { expectRefusal(skitter({"walk"}), 2, {"walk"}); }
TEST_F(Usage, UnknownFlag) { expectInputError({"run", "--spiders", "3"}, {"--spiders"}); }

// The subcommands, as `skitter --help` lists them.
std::vector<std::string> subcommands() {
  std::istringstream help(runProgram({SKITTER_BINARY, "--help"}).out);
  std::vector<std::string> names;
  std::string line;
  while (std::getline(help, line) && !line.starts_with("Subcommands:")) continue;
  while (std::getline(help, line) && line.starts_with("  "))
    if (line[2] != ' ') names.push_back(line.substr(2, line.find(' ', 2) - 2));
  return names;
}

TEST_F(Usage, HelpAndVersionAreNoErrors) {
  std::vector<std::vector<std::string>> all = {{"--help"}, {"--version"}};
  for (const std::string& name : subcommands()) all.push_back({name, "--help"});
  EXPECT_GE(all.size(), 8u);
  for (const std::vector<std::string>& arguments : all) {
    SCOPED_TRACE(::testing::PrintToString(arguments));
    const Result result = runProgram([&] {
      std::vector<std::string> command = arguments;
      command.insert(command.begin(), SKITTER_BINARY);
      return command;
    }());
    EXPECT_EQ(result.code, 0);
    EXPECT_EQ(result.err, "");
    EXPECT_NE(result.out, "");
  }
  const std::string help = runProgram({SKITTER_BINARY, "run", "--help"}).out;
  for (const char* flag : {"--agents", "--terrain", "--spacing", "--heights", "--scale", "--exaggeration",
                           "--terrain-size", "--void-value", "--frames", "--dt", "--size", "--seed",
                           "--device", "--headless", "--out", "--json", "--trace", "--force", "Examples"}) {
    EXPECT_NE(help.find(flag), std::string::npos) << flag;
  }
}

TEST_F(Usage, Scene) {
  write("broken.json", "{\"seed\": ");
  write("field.json", "{\"herds\": [{\"agents\": -3}]}");
  write("rig.json", "{\"herds\": [{\"rig\": \"none.glb\"}]}");
  expectInputError({"run", file("none.json")}, {"none.json"});
  expectInputError({"run", file("")}, {file("")});
  expectInputError({"run", file("broken.json")}, {"broken.json"});
  expectInputError({"run", file("field.json")}, {"field.json", "herds[0].agents", "-3"});
  expectInputError({"run", file("rig.json"), "--frames", "1"}, {"none.glb"});
  expectInputError({"validate", file("none.json")}, {"none.json"});
}

TEST_F(Usage, Terrain) {
  write("text.png", "no picture");
  expectInputError({"run", "--terrain", file("none.png")}, {"none.png"});
  expectInputError({"run", "--terrain", file("")}, {file("")});
  expectInputError({"run", "--terrain", file("text.png")}, {"text.png", "PNG"});
  expectInputError({"run", "--spacing", "2"}, {"--spacing", "--terrain"});
  expectInputError({"run", "--heights", "0,1"}, {"--heights", "--terrain"});
  expectInputError({"run", "--scale", "2"}, {"--scale", "--terrain"});
  expectInputError({"run", "--exaggeration", "2"}, {"--exaggeration", "--terrain"});
  expectInputError({"run", "--terrain-size", "3x4"}, {"--terrain-size", "--terrain FILE"});
  expectInputError({"run", "--void-value", "0"}, {"--void-value", "--terrain"});
  expectInputError({"run", "--terrain", "noise", "--scale", "2"}, {"--scale", "noise generates"});
}

TEST_F(Usage, Numbers) {
  expectInputError({"run", "--agents", "-5"}, {"--agents", "-5"});
  expectInputError({"run", "--agents", "many"}, {"--agents", "many"});
  expectInputError({"run", "--agents", "1.5"}, {"--agents", "1.5"});
  expectInputError({"run", "--agents", "5000000000"}, {"--agents", "5000000000"});
  expectInputError({"run", "--agents", "99999999999999999999999"}, {"--agents"});
  expectInputError({"run", "--agents"}, {"--agents"});
  expectInputError({"run", "--frames", "-1"}, {"--frames", "-1"});
  expectInputError({"run", "--ticks-per-frame", "0"}, {"--ticks-per-frame"});
  expectInputError({"run", "--dt", "nan"}, {"--dt", "nan"});
  expectInputError({"run", "--dt", "0"}, {"--dt"});
  expectInputError({"run", "--dt", "-0.01"}, {"--dt", "-0.01"});
  expectInputError({"run", "--dt", "inf"}, {"--dt", "inf"});
  expectInputError({"run", "--dt", "0.151"}, {"--dt", "0.151", "0.15"});
  expectInputError({"run", "--size", "0x720"}, {"--size", "0x720"});
  expectInputError({"run", "--size", "1280"}, {"--size", "1280"});
  expectInputError({"run", "--size", "20000x20000"}, {"--size", "20000x20000"});
  expectInputError({"run", "--seed", "-1"}, {"--seed"});
  expectInputError({"run", "--spacing", "1,nan"}, {"--spacing", "nan"});
  expectInputError({"run", "--spacing", "0"}, {"--spacing"});
  expectInputError({"run", "--heights", "5"}, {"--heights", "5"});
  expectInputError({"run", "--heights", "5,1"}, {"--heights", "5,1"});
  expectInputError({"run", "--scale", "-1"}, {"--scale", "-1"});
  expectInputError({"run", "--exaggeration", "-1"}, {"--exaggeration", "-1"});
  expectInputError({"run", "--exaggeration", "1001"}, {"--exaggeration", "1001"});
  expectInputError({"run", "--terrain-size", "1x4"}, {"--terrain-size", "1x4"});
  expectInputError({"run", "--terrain-size", "16385x4"}, {"--terrain-size", "16385x4"});
  expectInputError({"run", "--void-value", "nan"}, {"--void-value", "nan"});
  expectInputError({"run", "--view", "sideways"}, {"--view", "sideways"});
  expectInputError({"validate", "--agents", "-5"}, {"--agents", "-5"});
  expectInputError({"validate", "--page-agents", "0"}, {"--page-agents", "0"});
}

TEST_F(Usage, AgentsBeyondTheMemory) {
  for (const char* command : {"run", "validate"})
    expectRefusal(skitter({command, "--agents", "2000000000"}), 3,
                  {"2000000000 agents need", "GiB", "available"});
}

TEST_F(Usage, Outputs) {
  write("file", "text");
  expectInputError({"run", "--out", file("file")}, {"--out", "file"});
  expectInputError({"run", "--out", file("file/below")}, {"--out", "file"});
  expectInputError({"run", "--out", file("none/walk.mp4")}, {"--out", "none"});
  expectInputError({"run", "--out", file("none/last.png")}, {"--out", "none"});
  expectInputError({"run", "--out", file("walk.avi")}, {"--out", ".avi"});
  expectInputError({"run", "--out", file("walk.mp4"), "--frames", "0"}, {"--out", "--frames"});
  expectInputError({"run", "--out", "/proc/none/walk.mp4"}, {"--out", "/proc/none"});
  expectInputError({"run", "--agents", "1", "--frames", "1", "--out", "/proc/none"}, {"/proc/none"});
  expectInputError({"run", "--json", file("none/figures.json")}, {"--json", "none"});
  expectInputError({"run", "--json", file("")}, {"--json"});
  ASSERT_EQ(mkfifo(file("pipe").c_str(), 0600), 0);
  expectInputError({"run", "--json", file("pipe")}, {"--json", "pipe", "regular"});
  expectInputError({"run", "--trace", file("file")}, {"--trace", "file"});
  expectInputError({"info", "--json", file("none/info.json")}, {"--json", "none"});
  expectInputError({"validate", "--json", file("none/v.json")}, {"--json", "none"});
}

TEST_F(Usage, OutWhereADirectoryHasAVideosName) {
  std::filesystem::create_directory(file("walk.mp4"));
  expectInputError({"run", "--out", file("walk.mp4")}, {"--out", "walk.mp4", "directory"});
}

TEST_F(Usage, TraceBeyondFourGibibytesNeedsLarge) {
  expectInputError({"run", "--headless", "--agents", "1000", "--frames", "10000", "--trace", file("trace")},
                   {"--trace", "--large"});
}

TEST_F(Usage, NoDevice) {
  const Environment nowhere = {{"VK_DRIVER_FILES", "/nowhere.json"}, {"VK_ICD_FILENAMES", "/nowhere.json"}};
  for (const char* command : {"info", "run", "validate"}) {
    SCOPED_TRACE(command);
    expectRefusal(skitter({command}, nowhere), 3, {"Vulkan"});
  }
  expectRefusal(skitter({"run", "--headless", "--device", "no such device"}), 3, {"no such device"});
  expectRefusal(skitter({"validate", "--device", "99"}), 3, {"99"});
  expectRefusal(skitter({"run", "--device", "99", "--out", file("walk.mp4"), "--json", file("f.json")}), 3,
                {"99"});
  EXPECT_TRUE(files().empty());
}

TEST_F(Usage, NoDisplayBehindTheName) {
  expectRefusal(skitter({"run"}, {{"DISPLAY", ":987"}}), 3, {"window", "--headless"});
}

}  // namespace
}  // namespace skitter::test
