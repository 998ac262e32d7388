#include <fcntl.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "../assets/files.h"
#include "process.h"

namespace skitter::test {
namespace {

namespace fs = std::filesystem;

// What may happen to people's files, and what must not.
struct Files : AppTest {
  std::string text(const std::string& name) const {
    std::ifstream in(file(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  void writeTargets(const std::string& name) const { write(name, std::string(12, '\0')); }

  // A walk of one agent with pictures into a folder.
  Result draw(const std::string& folder, const std::vector<std::string>& more = {},
              const Environment& environment = {}) const {
    std::vector<std::string> arguments = {"run", "--agents", "1", "--size", "32x32", "--out", file(folder)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return skitter(arguments, environment);
  }

  // A program of the name ffmpeg that does this; returns the environment in which it is found.
  Environment ffmpegThat(const std::string& does) const {
    fs::create_directory(file("bin"));
    write("bin/ffmpeg", "#!/bin/bash\n" + does + "\n");
    fs::permissions(file("bin/ffmpeg"), fs::perms::owner_all);
    return {{"PATH", file("bin") + ":" + std::getenv("PATH")}};
  }

  Result ik(std::vector<std::string> more, const Environment& environment = {}) const {
    std::vector<std::string> arguments = {"ik", "--joints", "3", "--device", "cpu", "--quiet"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return skitter(arguments, environment);
  }
};

Result inShell(const std::string& script, const std::vector<std::string>& arguments) {
  std::vector<std::string> command = {"bash", "-c", script, "bash", SKITTER_BINARY};
  command.insert(command.end(), arguments.begin(), arguments.end());
  return runProgram(command);
}

#if defined(SKITTER_BENCH)
constexpr bool hasBench = true;
#else
constexpr bool hasBench = false;
#endif

// Without those that the program was built without.
std::vector<std::string> built(std::vector<std::string> commands) {
  if (!hasBench)
    std::erase_if(commands, [](const std::string& name) { return name == "bench" || name == "reproduce"; });
  return commands;
}
const std::vector<std::string> commands =
    built({"bench", "ik", "info", "inspect", "reproduce", "rig", "run", "validate"});

TEST_F(Files, EmptyNamesAreRefused) {
  const auto refused = [](std::vector<std::string> arguments) {
    expectRefusal(skitter(arguments), 2, {arguments.at(arguments.size() - 2), "is empty", "expected"});
  };
  for (const char* option : {"--out", "--trace", "--footfalls", "--json", "--rig", "--terrain"})
    refused({"run", "--headless", option, ""});
  for (const char* option : {"--targets", "--out", "--rotations", "--json"})
    refused({"ik", "--joints", "3", option, ""});
  for (const char* option : {"--out", "--json"}) refused({"inspect", "model.glb", option, ""});
  for (const std::string& command : built({"info", "validate", "bench"})) refused({command, "--json", ""});
  refused({"rig", "model.glb", "--out", ""});
  for (const std::string& command : built({"reproduce"})) refused({command, "--out", ""});
}

TEST_F(Files, NoFileIsWrittenTwice) {
  write("there", "mine");
  fs::create_symlink("there", file("link"));
  fs::create_hard_link(file("there"), file("hard"));
  fs::create_directory(file("folder"));
  fs::create_directory_symlink("folder", file("elsewhere"));
  const std::vector<std::array<std::string, 2>> pairs = {{"new", "new"},
                                                         {"new", "./new"},
                                                         {"there", "link"},
                                                         {"there", "hard"},
                                                         {"folder/new", "elsewhere/new"},
                                                         {"folder/../new", "new"}};
  for (const auto& [one, two] : pairs) {
    SCOPED_TRACE(one + " " + two);
    for (const auto& [a, b] :
         {std::pair("--out", "--rotations"), {"--out", "--json"}, {"--rotations", "--json"}})
      expectRefusal(ik({a, file(one), b, file(two)}), 2, {a, b, one, two, "same file"});
    expectRefusal(skitter({"run", "--headless", "--json", file(one), "--footfalls", file(two)}), 2,
                  {"--json", "--footfalls", "same file"});
  }
  expectRefusal(ik({"--out", file("new"), "--json", file("new.part")}), 2, {"--json", "new.part", "--out"});
  expectRefusal(skitter({"run", "--out", file("x.png"), "--json", file("x.png")}), 2, {"--out", "--json"});
  expectRefusal(skitter({"run", "--out", file("new"), "--trace", file("elsewhere/../new")}), 2,
                {"--out", "--trace", "same folder"});
  for (const char* claimed : {"frame_00001.png", "skitter.mp4"})
    expectRefusal(
        skitter({"run", "--out", file("folder"), "--json", file(std::string("elsewhere/") + claimed)}), 2,
        {"--json", claimed, "--out"});
  expectRefusal(skitter({"run", "--trace", file("folder"), "--json", file("folder/trace.json")}), 2,
                {"--json", "trace.json", "--trace"});
  EXPECT_EQ(text("there"), "mine");
  EXPECT_EQ(files(), (std::vector<std::string>{"hard", "there", "there"})) << "the link as what it leads to";
}

TEST_F(Files, NothingThatIsReadIsWritten) {
  writeTargets("t");
  fs::create_symlink("t", file("link"));
  fs::create_hard_link(file("t"), file("hard"));
  for (const char* name : {"t", "link", "hard"})
    for (const char* option : {"--out", "--rotations", "--json"})
      expectRefusal(ik({"--targets", file("t"), option, file(name)}), 2,
                    {option, name, "--targets", "reads"});
  EXPECT_EQ(text("t"), std::string(12, '\0'));

  write("hills_2x2.r32f", std::string(16, '\0'));
  write("hills_2x2.json", R"({"min_m": 0, "max_m": 1})");
  write("scene.json", R"({"terrain": {"kind": "file", "file": "hills_2x2.r32f"}, "herds": [{"agents": 1}]})");
  for (const std::string& command : built({"run", "validate", "bench"}))
    for (const char* read : {"scene.json", "hills_2x2.r32f"}) {
      const std::string before = text(read);
      expectRefusal(skitter({command, file("scene.json"), "--json", file(read)}), 2,
                    {"--json", read, "reads"});
      EXPECT_EQ(text(read), before);
    }
  // What only the file itself names.
  for (const char* command : {"run", "validate"})
    expectRefusal(skitter({command, file("scene.json"), "--json", file("hills_2x2.json")}), 2,
                  {"--json", "hills_2x2.json", "reads"});
  EXPECT_EQ(text("hills_2x2.json"), R"({"min_m": 0, "max_m": 1})");
  write("crab.glb", "not read");
  expectRefusal(skitter({"inspect", file("crab.glb"), "--json", file("crab.glb")}), 2, {"--json", "reads"});
  for (const std::string& command : built({"reproduce"}))
    expectRefusal(skitter({command, "--terrain", "hill=" + file("page/figure1.csv"), "--out", file("page")}),
                  2, {"--terrain", "figure1.csv", "--out"});
}

TEST_F(Files, NamesMayBeAsLongAsNamesMay) {
  for (const size_t length : {250u, 251u, 255u}) {
    const std::string name(length, 'n');
    EXPECT_EQ(ik({"--chains", "2", "--out", file(name), "--json", file("f.json")}).code, 0) << length;
    EXPECT_EQ(files(), (std::vector<std::string>{"f.json", name}));
    fs::remove(file(name));
  }
  fs::remove(file("f.json"));
  expectRefusal(ik({"--out", file(std::string(256, 'n'))}), 2, {"--out", "too long"});
  expectRefusal(skitter({"run", "--trace", file(std::string(256, 'n'))}), 2, {"--trace", "too long"});
  EXPECT_TRUE(files().empty());
}

TEST_F(Files, LinksAreWrittenThrough) {
  fs::create_directories(file("far"));
  write("far/old.json", "old");
  fs::create_symlink("far/old.json", file("a.json"));
  fs::create_symlink("a.json", file("b.json"));
  fs::create_symlink("far/new.f32", file("dangling"));
  fs::create_symlink("far/last.png", file("last.png"));
  fs::create_directory_symlink("far", file("trace"));
  ASSERT_EQ(ik({"--chains", "2", "--out", file("dangling"), "--json", file("b.json")}).code, 0);
  EXPECT_EQ(json("far/old.json").at("solves"), 2);
  EXPECT_EQ(fs::file_size(file("far/new.f32")), 2u * 36);
  const Result drawn = skitter({"run", "--agents", "1", "--frames", "1", "--size", "8x8", "--out",
                                file("last.png"), "--trace", file("trace"), "--force"});
  ASSERT_EQ(drawn.code, 0) << drawn.err;
  EXPECT_TRUE(fs::exists(file("far/last.png")));
  EXPECT_TRUE(fs::exists(file("far/trace.json")));
  for (const char* link : {"a.json", "b.json", "dangling", "last.png", "trace"})
    EXPECT_TRUE(fs::is_symlink(file(link))) << link;
  fs::create_symlink("loop", file("loop"));
  expectRefusal(ik({"--out", file("loop")}), 2, {"--out", "loop", "levels"});
}

TEST_F(Files, StalePartsGoAndOthersStay) {
  write("j.json.part", "of a killed run");
  ASSERT_EQ(ik({"--chains", "2", "--json", file("j.json")}).code, 0);
  EXPECT_EQ(files(), std::vector<std::string>{"j.json"});

  write("j.json.part", "another program's");
  const int held = open(file("j.json.part").c_str(), O_RDONLY | O_CLOEXEC);
  ASSERT_EQ(flock(held, LOCK_EX), 0);
  expectRefusal(ik({"--json", file("j.json")}), 2, {"--json", "j.json", "another program"});
  EXPECT_EQ(text("j.json.part"), "another program's");
  close(held);
  fs::remove(file("j.json.part"));
  write("mine", "mine");
  fs::create_symlink("mine", file("j.json.part"));
  expectRefusal(ik({"--json", file("j.json")}), 2, {"--json", "j.json.part", "in the way"});
  EXPECT_EQ(text("mine"), "mine");
}

TEST_F(Files, StandardOutputIsNoNameForAnOutput) {
  const Result result =
      inShell(R"("$1" run --headless --agents 1 --frames 1 --json "$2" > "$2")", {file("o")});
  EXPECT_EQ(result.code, 2);
  EXPECT_NE(result.err.find("standard output"), std::string::npos) << result.err;
  EXPECT_EQ(inShell(R"("$1" ik --joints 3 --chains 2 --device cpu --json "$2" >&-)", {file("f.json")}).code,
            0);
  EXPECT_EQ(json("f.json").at("solves"), 2);
}

TEST_F(Files, AFolderOfSomebodyElseNeedsForce) {
  fs::create_directory(file("out"));
  write("out/frame_00001.png", "the user's");
  write("out/frame_00500.png", "the user's");
  expectRefusal(draw("out"), 2, {"--out", "not empty", "--force"});
  EXPECT_EQ(files(), (std::vector<std::string>{"out/frame_00001.png", "out/frame_00500.png"}));
  ASSERT_EQ(draw("out", {"--frames", "2", "--force"}).code, 0);
  EXPECT_NE(text("out/frame_00001.png"), "the user's");
  EXPECT_EQ(text("out/frame_00500.png"), "the user's");
  // Known as ours from now on, but for what never was.
  expectRefusal(draw("out", {"--frames", "1"}), 2, {"--out", "frame_00500.png", "--force"});
  fs::remove(file("out/frame_00500.png"));
  write("out/notes.txt", "the user's");
  ASSERT_EQ(draw("out", {"--frames", "1"}).code, 0);
  EXPECT_EQ(files(), (std::vector<std::string>{"out/.skitter-files", "out/frame_00000.png", "out/notes.txt",
                                               "out/skitter.mp4"}));

  fs::create_directory(file("trace"));
  write("trace/heights.npy", "the user's");
  expectRefusal(skitter({"run", "--headless", "--trace", file("trace")}), 2, {"--trace", "--force"});
  EXPECT_EQ(text("trace/heights.npy"), "the user's");
}

TEST_F(Files, AMarkNamesNothingOutsideOfItsFolder) {
  fs::create_directory(file("out"));
  write("mine", "mine");
  write("out/.skitter-files", "../mine\n" + file("mine") + "\n./../mine\n");
  ASSERT_EQ(draw("out", {"--frames", "1"}).code, 0);
  EXPECT_EQ(text("mine"), "mine");
}

TEST_F(Files, AnEarlierRunsFramesStayUntilTheNewOnesAreWhole) {
  ASSERT_EQ(draw("out", {"--frames", "3"}).code, 0);
  const std::vector<std::string> before = files();
  const std::string frame = text("out/frame_00002.png"), video = text("out/skitter.mp4");
  fs::create_directory(file("nothing"));
  expectRefusal(draw("out", {}, {{"PATH", file("nothing")}}), 2, {"ffmpeg", "install"});
  expectRefusal(draw("out", {"--frames", "0"}), 2, {"--out", "--frames"});
  const Result failed = draw("out", {"--frames", "1", "--seed", "7"}, ffmpegThat("cat > /dev/null; exit 1"));
  EXPECT_EQ(failed.code, 2) << failed.err;
  fs::remove_all(file("bin"));
  EXPECT_EQ(files(), before);
  EXPECT_EQ(text("out/frame_00002.png"), frame);
  EXPECT_EQ(text("out/skitter.mp4"), video);
}

TEST_F(Files, AVideoThatIsNoneReplacesNoVideo) {
  ASSERT_EQ(draw("walk.mp4", {"--frames", "2"}).code, 0);
  const std::string video = text("walk.mp4");
  for (const char* does : {"cat > /dev/null", "cat > /dev/null; echo 'no video' > \"${!#}\""}) {
    expectRefusal(draw("walk.mp4", {"--frames", "2"}, ffmpegThat(does)), 2, {"walk.mp4", "wrote no video"});
    fs::remove_all(file("bin"));
    EXPECT_EQ(text("walk.mp4"), video);
    EXPECT_EQ(files(), std::vector<std::string>{"walk.mp4"});
  }
}

TEST_F(Files, ATraceReplacesAnEarlierOneWhole) {
  write("two.json", R"({"herds": [{"agents": 1}, {"agents": 1}]})");
  const auto trace = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"run", "--headless", "--frames", "1", "--trace", file("trace")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return skitter(arguments);
  };
  EXPECT_EQ(trace({file("two.json")}).out.find("earlier"), std::string::npos);
  ASSERT_TRUE(fs::exists(file("trace/herd1/body.npy")));
  const Result second = trace({"--agents", "1"});
  ASSERT_EQ(second.code, 0) << second.err;
  EXPECT_NE(second.out.find("in place of an earlier trace"), std::string::npos) << second.out;
  EXPECT_FALSE(fs::exists(file("trace/herd1")));
  EXPECT_EQ(json("trace/trace.json").at("herds").size(), 1u);
}

TEST_F(Files, AFullDiskUnderStandardOutputIsNoSuccess) {
  const std::string model = std::string(SKITTER_ROOT) + "/assets/spider.glb";
  for (const std::string& arguments :
       {std::string("--version"), std::string("--help"), std::string("info"),
        std::string("ik --joints 3 --chains 2 --device cpu"), "inspect " + model,
        "rig " + model + " --out " + file("s.rig.json"), std::string("run --headless --agents 1 --frames 1"),
        std::string("validate --agents 1 --frames 1")}) {
    const Result result = inShell("\"$1\" " + arguments + " > /dev/full", {});
    EXPECT_EQ(result.code, 2) << arguments << result.err;
    EXPECT_NE(result.err.find("skitter: standard output: cannot be written"), std::string::npos)
        << arguments << result.err;
  }
}

TEST_F(Files, ALimitOnFilesIsAFullDisk) {
  const Result result =
      inShell(R"(ulimit -f 4; "$1" run --headless --agents 20 --frames 20 --trace "$2")", {file("trace")});
  EXPECT_EQ(result.code, 2) << result.err;
  for (const char* word : {"joints.npy", "too large", "ulimit -f"})
    EXPECT_NE(result.err.find(word), std::string::npos) << word << result.err;
  EXPECT_FALSE(fs::exists(file("trace")));
}

// Before the first tick a whole crowd is made, which no signal stops.
TEST_F(Files, AnInterruptedStartTellsOfNoTicks) {
  for (const char* command : {"run", "validate"}) {
    SCOPED_TRACE(command);
    bool sent = false;
    const Result result = skitter(
        {command, "--agents", "100", "--frames", "100000", "--json", file("j.json")}, {}, [&](int child) {
          if (sent || !catches(child, SIGHUP)) return;
          kill(child, SIGHUP);
          sent = true;
        });
    ASSERT_TRUE(sent);
    EXPECT_EQ(result.code, 130) << result.err;
    EXPECT_NE(result.err.find("interrupted after"), std::string::npos) << result.err;
    EXPECT_TRUE(json("j.json").at("interrupted"));
    EXPECT_EQ(json("j.json").at("ticksWanted"), 100000);
    EXPECT_LT(json("j.json").at("ticks"), 100000);
  }
}

TEST_F(Files, EveryHelpListsTheExitCodes) {
  std::vector<std::vector<std::string>> all = {{"--help"}};
  for (const std::string& command : commands) all.push_back({command, "--help"});
  for (std::vector<std::string>& arguments : all) {
    arguments.insert(arguments.begin(), SKITTER_BINARY);
    const std::string help = runProgram(arguments).out;
    for (const char* words :
         {"Exit codes: 0 ", "1 a check failed", "2 wrong usage", "3 no usable", "130 interr"})
      EXPECT_NE(help.find(words), std::string::npos) << arguments[1] << words << help;
  }
}

}  // namespace
}  // namespace skitter::test
