#include <signal.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <set>
#include <sstream>

#include "process.h"

namespace skitter::test {
namespace {

namespace fs = std::filesystem;
using Floats = std::vector<float>;

constexpr double boneLengths = 1e-4;  // share of the length that float32 may miss

struct Ik : AppTest {
  void write(const std::string& name, const Floats& values) const {
    std::string bytes(values.size() * sizeof(float), '\0');
    std::memcpy(bytes.data(), values.data(), bytes.size());
    AppTest::write(name, bytes);
  }
  Floats read(const std::string& name) const {
    std::ifstream in(file(name), std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    EXPECT_EQ(bytes.size() % sizeof(float), 0u);
    Floats values(bytes.size() / sizeof(float));
    std::memcpy(values.data(), bytes.data(), values.size() * sizeof(float));
    return values;
  }
  // `skitter ik ...` with figures in f.json, which are returned.
  nlohmann::json solve(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "ik");
    arguments.insert(arguments.end(), {"--json", file("f.json")});
    const Result result = skitter(arguments);
    EXPECT_EQ(result.code, 0) << result.err;
    return result.code == 0 ? json("f.json") : nlohmann::json();
  }
  void expectError(std::vector<std::string> arguments, const std::vector<std::string>& words) const {
    SCOPED_TRACE(::testing::PrintToString(arguments));
    const std::vector<std::string> before = files();
    arguments.insert(arguments.begin(), "ik");
    expectRefusal(skitter(arguments), 2, words);
    EXPECT_EQ(files(), before);
  }
};

// Targets on a spiral about the base, 0.3 to 0.9 of a length of 1 away.
Floats spiral(size_t count) {
  Floats targets;
  for (size_t i = 0; i < count; ++i) {
    const double a = 0.7 * static_cast<double>(i), h = std::sin(0.31 * static_cast<double>(i));
    const double r = 0.6 + 0.3 * std::sin(1.3 * static_cast<double>(i)), across = std::sqrt(1 - h * h);
    for (const double x : {across * std::cos(a), across * std::sin(a), h}) {
      targets.push_back(static_cast<float>(r * x));
    }
  }
  return targets;
}

double distance(const float* a, const float* b) {
  return std::hypot(double{a[0]} - b[0], double{a[1]} - b[1], double{a[2]} - b[2]);
}

TEST_F(Ik, JsonHasTheDocumentedFields) {
  const nlohmann::json figures = solve({"--joints", "5", "--chains", "100", "--seed", "9"});
  std::set<std::string> keys;
  for (const auto& [key, value] : figures.items()) keys.insert(key);
  EXPECT_EQ(keys, (std::set<std::string>{"manifest",
                                         "solver",
                                         "device",
                                         "joints",
                                         "chains",
                                         "rows",
                                         "solves",
                                         "solvesWanted",
                                         "interrupted",
                                         "start",
                                         "targets",
                                         "seed",
                                         "tolerance",
                                         "iterations",
                                         "restPull",
                                         "limits",
                                         "pole",
                                         "bones",
                                         "rest",
                                         "solvedFraction",
                                         "meanIterations",
                                         "p99Iterations",
                                         "maxError",
                                         "meanError",
                                         "maxLimitViolation",
                                         "maxBoneLengthError",
                                         "stopped",
                                         "nanosecondsPerSolve",
                                         "cpuNanosecondsPerSolve"}));
  EXPECT_EQ(figures.at("solver"), "stretch-align");
  EXPECT_EQ(figures.at("joints"), 5);
  EXPECT_EQ(figures.at("chains"), 100);
  EXPECT_EQ(figures.at("rows"), 1);
  EXPECT_EQ(figures.at("solves"), 100);
  EXPECT_EQ(figures.at("seed"), 9);
  EXPECT_TRUE(figures.at("targets").is_null());
  EXPECT_TRUE(figures.at("pole").is_null());
  EXPECT_EQ(figures.at("tolerance"), 0.0009);
  EXPECT_EQ(figures.at("iterations"), 20);
  EXPECT_EQ(figures.at("rest").size(), 5u);
  EXPECT_EQ(figures.at("rest").at(4).size(), 3u);
  EXPECT_EQ(figures.at("solvedFraction"), 1);
  EXPECT_LE(figures.at("maxError"), 1e-3);
  EXPECT_LE(figures.at("meanError"), figures.at("maxError"));
  EXPECT_EQ(figures.at("maxLimitViolation"), 0);
  EXPECT_LT(figures.at("maxBoneLengthError"), boneLengths);
  EXPECT_LE(figures.at("meanIterations"), figures.at("p99Iterations"));
  EXPECT_GT(figures.at("nanosecondsPerSolve"), 0);
  EXPECT_GT(figures.at("cpuNanosecondsPerSolve"), 0);
  uint64_t stopped = 0;
  for (const char* why : {"tolerance", "cap", "stall", "unreachable", "skipped", "held", "jumped"}) {
    stopped += figures.at("stopped").at(why).get<uint64_t>();
  }
  EXPECT_EQ(stopped, 100u);
  EXPECT_EQ(figures.at("stopped").size(), 7u);
}

TEST_F(Ik, TableAndQuiet) {
  const Result told = skitter({"ik", "--joints", "4", "--chains", "10", "--limits", "cone:60"});
  EXPECT_EQ(told.code, 0) << told.err;
  EXPECT_EQ(told.err, "");
  for (const char* word :
       {"device", "4 joints", "cone:60", "active-set", "solved", "iterations", "a solve"}) {
    EXPECT_NE(told.out.find(word), std::string::npos) << word << "\n" << told.out;
  }
  const Result quiet = skitter({"ik", "--joints", "4", "--chains", "10", "--quiet"});
  EXPECT_EQ(quiet.code, 0);
  EXPECT_EQ(quiet.out + quiet.err, "");
}

TEST_F(Ik, RestPoses) {
  const auto joint = [](const nlohmann::json& figures, size_t i) { return figures.at("rest").at(i); };
  const nlohmann::json bent = solve({"--joints", "4", "--chains", "1"});
  const double degrees[] = {60, -10, -80};
  double x = 0, y = 0;
  for (size_t i = 0; i < 3; ++i) {
    x += std::cos(degrees[i] * 3.14159265358979 / 180) / 3;
    y += std::sin(degrees[i] * 3.14159265358979 / 180) / 3;
    EXPECT_NEAR(joint(bent, i + 1).at(0), x, 1e-6);
    EXPECT_NEAR(joint(bent, i + 1).at(1), y, 1e-6);
    EXPECT_EQ(joint(bent, i + 1).at(2), 0);
  }
  const nlohmann::json one = solve({"--joints", "2", "--chains", "1"});
  EXPECT_NEAR(joint(one, 1).at(0), 0.5, 1e-6);
  const nlohmann::json straight = solve({"--bones", "2,0,1", "--rest", "straight", "--chains", "1"});
  EXPECT_EQ(straight.at("joints"), 4);
  EXPECT_EQ(straight.at("bones"), nlohmann::json({2.0, 0.0, 1.0}));
  EXPECT_EQ(joint(straight, 2), nlohmann::json({2.0, 0.0, 0.0}));
  EXPECT_EQ(joint(straight, 3), nlohmann::json({3.0, 0.0, 0.0}));
}

// Around the size of a work group: no chain is lost, none is moved, none knows the others.
TEST_F(Ik, SizesAroundAWorkGroup) {
  const Floats targets = spiral(65);
  Floats all;
  for (const size_t count : {65, 1, 63, 64}) {
    SCOPED_TRACE(count);
    write("t.f32", Floats(targets.begin(), targets.begin() + static_cast<std::ptrdiff_t>(3 * count)));
    const nlohmann::json figures =
        solve({"--joints", "6", "--targets", file("t.f32"), "--out", file("j.f32")});
    EXPECT_EQ(figures.at("chains"), count);
    EXPECT_EQ(figures.at("targets"), file("t.f32"));
    EXPECT_TRUE(figures.at("seed").is_null());
    EXPECT_EQ(figures.at("solvedFraction"), 1);
    const Floats joints = read("j.f32");
    ASSERT_EQ(joints.size(), count * 6 * 3);
    double worst = 0;
    for (size_t c = 0; c < count; ++c) {
      const float* pose = joints.data() + c * 18;
      EXPECT_EQ(Floats(pose, pose + 3), Floats(3, 0)) << "the base";
      worst = std::max(worst, distance(pose + 15, targets.data() + 3 * c));
      for (size_t i = 0; i < 5; ++i) EXPECT_NEAR(distance(pose + 3 * i, pose + 3 * i + 3), 0.2, boneLengths);
    }
    EXPECT_NEAR(worst, figures.at("maxError"), 1e-9) << "the figures are those of the file";
    if (all.empty()) all = joints;
    EXPECT_TRUE(std::equal(joints.begin(), joints.end(), all.begin()));
  }
}

TEST_F(Ik, SeedsRepeatAndDiffer) {
  const auto out = [&](const char* seed, const char* chains) {
    solve({"--joints", "3", "--seed", seed, "--chains", chains, "--out", file("j.f32")});
    return read("j.f32");
  };
  const Floats seven = out("7", "64");
  EXPECT_EQ(out("7", "64"), seven);
  EXPECT_NE(out("8", "64"), seven);
  const Floats fewer = out("7", "5");
  EXPECT_TRUE(std::equal(fewer.begin(), fewer.end(), seven.begin())) << "a chain's target is its own";
}

TEST_F(Ik, MadeTargetsLieWithinReachAllAround) {
  const nlohmann::json figures = solve({"--bones", "2,2,1,1", "--out", file("j.f32")});
  EXPECT_EQ(figures.at("chains"), 10000);
  const Floats joints = read("j.f32");
  double mean[3] = {}, sum = 0, least = 1, most = 0;
  for (size_t c = 0; c < 10000; ++c) {
    const float* tip = joints.data() + c * 15 + 12;
    const double share = std::hypot(double{tip[0]}, double{tip[1]}, double{tip[2]}) / 6;
    for (size_t k = 0; k < 3; ++k) mean[k] += tip[k] / (6 * share) / 1e4;
    sum += share / 1e4;
    least = std::min(least, share);
    most = std::max(most, share);
  }
  EXPECT_NEAR(least, 0.2, 2e-3);
  EXPECT_NEAR(most, 0.95, 2e-3);
  EXPECT_NEAR(sum, 0.575, 0.01);
  for (const double m : mean) EXPECT_NEAR(m, 0, 0.03);
}

TEST_F(Ik, PreviousGoesOnWhereTheRowBeforeEnded) {
  // Two chains, 30 rows of the same targets, an iteration each: what one row leaves the next goes on with.
  Floats rows;
  for (int r = 0; r < 30; ++r) rows.insert(rows.end(), {-0.8f, -0.3f, 0.1f, -0.2f, 0.1f, 0.85f});
  write("rows.f32", rows);
  const auto error = [&](const Floats& joints, size_t row, size_t chain) {
    return distance(joints.data() + (row * 2 + chain) * 15 + 12, rows.data() + 3 * chain);
  };
  const std::vector<std::vector<std::string>> cases = {
      {"--solver", "fabrik"},
      {"--solver", "fabrik", "--limits", "cone:150"},
      {"--solver", "dissertation-edge", "--limits", "cone:175"}};
  for (std::vector<std::string> arguments : cases) {
    for (const bool reference : {false, true}) {
      SCOPED_TRACE(::testing::PrintToString(arguments) + (reference ? " cpu" : ""));
      std::vector<std::string> cold = arguments;
      cold.insert(cold.end(), {"--joints", "5", "--targets", file("rows.f32"), "--iterations", "1",
                               "--chains", "2", "--out", file("j.f32")});
      if (reference) cold.insert(cold.end(), {"--device", "cpu"});
      std::vector<std::string> previous = cold;
      previous.insert(previous.end(), {"--start", "previous"});
      const nlohmann::json figures = solve(previous);
      EXPECT_EQ(figures.at("chains"), 2);
      EXPECT_EQ(figures.at("rows"), 30);
      EXPECT_EQ(figures.at("solves"), 60);
      EXPECT_EQ(figures.at("start"), "previous");
      const Floats joints = read("j.f32");
      ASSERT_EQ(joints.size(), 60u * 15);
      for (const size_t chain : {0, 1}) {
        EXPECT_GT(error(joints, 0, chain), 1e-3);
        EXPECT_LT(error(joints, 1, chain), error(joints, 0, chain));
        EXPECT_LT(error(joints, 29, chain), 1e-3);
      }

      EXPECT_EQ(solve(cold).at("rows"), 30);
      const Floats fromRest = read("j.f32");
      ASSERT_EQ(fromRest.size(), joints.size());
      EXPECT_TRUE(std::equal(fromRest.begin(), fromRest.begin() + 30, joints.begin()))
          << "row 0 is from rest";
      EXPECT_EQ(error(fromRest, 29, 0), error(fromRest, 0, 0));
    }
  }
}

TEST_F(Ik, PreviousWithoutChainsIsOneChain) {
  write("t.f32", spiral(7));
  const nlohmann::json figures = solve({"--joints", "3", "--targets", file("t.f32"), "--start", "previous"});
  EXPECT_EQ(figures.at("chains"), 1);
  EXPECT_EQ(figures.at("rows"), 7);
}

TEST_F(Ik, MadeRowsMoveALittle) {
  const nlohmann::json figures = solve({"--joints", "5", "--chains", "65", "--rows", "40", "--start",
                                        "previous", "--iterations", "20", "--out", file("j.f32")});
  EXPECT_EQ(figures.at("solves"), 65 * 40);
  EXPECT_GT(figures.at("solvedFraction"), 0.99);
  const Floats joints = read("j.f32");
  ASSERT_EQ(joints.size(), 65u * 40 * 15);
  for (size_t r = 1; r < 40; ++r) {
    for (size_t c = 0; c < 65; ++c) {
      const float* tip = joints.data() + (r * 65 + c) * 15 + 12;
      EXPECT_LT(distance(tip, tip - 65 * 15), 0.0225);
    }
  }
  EXPECT_EQ(solve({"--joints", "3", "--chains", "2", "--start", "previous"}).at("rows"), 100);
}

TEST_F(Ik, HingesThatFollowTheirTargetsArePulledToRestUnlessToldOtherwise) {
  const auto pull = [&](const char* limits, const char* start, std::vector<std::string> more = {}) {
    more.insert(more.end(), {"--joints", "3", "--chains", "2", "--limits", limits, "--start", start});
    return solve(more).at("restPull");
  };
  EXPECT_EQ(pull("hinge:0,0,1,-90,30", "previous"), 0.02);
  EXPECT_EQ(pull("hinge:0,0,1,-90,30", "previous", {"--rest-pull", "0"}), 0);
  EXPECT_EQ(pull("hinge:0,0,1,-90,30", "previous", {"--solver", "ccd"}), 0);
  EXPECT_EQ(pull("hinge:0,0,1,-90,30", "rest"), 0);
  EXPECT_EQ(pull("cone:60", "previous"), 0);
  EXPECT_EQ(pull("cone:60", "previous", {"--rest-pull", "0.1"}), 0.1);
}

TEST_F(Ik, EveryLimitHolds) {
  for (const char* limits :
       {"cone:40", "cone:120", "ellipse:40,70,30,20", "hinge:0,0,1,-90,30", "hinge:0,3,4,-60,60"}) {
    SCOPED_TRACE(limits);
    const nlohmann::json figures =
        solve({"--joints", "5", "--chains", "500", "--limits", limits, "--free-base"});
    EXPECT_EQ(figures.at("solver"), "active-set");
    EXPECT_EQ(figures.at("iterations"), 64);
    EXPECT_LT(figures.at("maxLimitViolation"), 1e-4);
    EXPECT_LT(figures.at("maxBoneLengthError"), boneLengths);
    EXPECT_EQ(figures.at("limits"), std::string(limits) + ", the first bone free");
  }
  // Without a free base no more is legal, and less is reached.
  const auto solved = [&](std::vector<std::string> more) {
    more.insert(more.end(), {"--joints", "5", "--chains", "500", "--limits", "cone:40"});
    return solve(more).at("solvedFraction").get<double>();
  };
  EXPECT_LT(solved({}), solved({"--free-base"}) - 0.1);
}

TEST_F(Ik, EverySolver) {
  for (const char* solver : {"auto", "fabrik", "dissertation-keep", "dissertation-edge", "ccd", "transpose",
                             "pseudoinverse", "dls", "target-attached", "two-bone", "stretch-align"}) {
    SCOPED_TRACE(solver);
    const nlohmann::json figures = solve({"--joints", "3", "--chains", "65", "--solver", solver});
    EXPECT_EQ(figures.at("solver"), std::string(solver) == "auto" ? "stretch-align" : solver);
    EXPECT_LT(figures.at("maxBoneLengthError"), boneLengths);
  }
  for (const char* solver : {"fabrik", "dissertation-keep", "dissertation-edge", "ccd", "transpose",
                             "pseudoinverse", "dls", "target-attached", "active-set"}) {
    SCOPED_TRACE(solver);
    EXPECT_EQ(
        solve({"--joints", "5", "--chains", "65", "--solver", solver, "--limits", "cone:60"}).at("solver"),
        solver);
  }
}

TEST_F(Ik, Rotations) {
  const std::vector<std::vector<std::string>> cases = {
      {},
      {"--limits", "cone:70"},
      {"--limits", "hinge:1,1,5,-90,90"},
      {"--limits", "cone:70", "--solver", "dissertation-edge"},
      {"--device", "cpu"},
      {"--limits", "cone:70", "--device", "cpu"},
      {"--limits", "hinge:1,1,5,-90,90", "--device", "cpu"},
      {"--limits", "cone:70", "--solver", "dissertation-edge", "--device", "cpu"}};
  for (std::vector<std::string> arguments : cases) {
    SCOPED_TRACE(::testing::PrintToString(arguments));
    arguments.insert(arguments.end(), {"--joints", "4", "--chains", "65", "--out", file("j.f32"),
                                       "--rotations", file("r.f32")});
    const nlohmann::json figures = solve(arguments);
    const Floats joints = read("j.f32"), rotations = read("r.f32");
    ASSERT_EQ(rotations.size(), 65u * 3 * 4);
    const nlohmann::json& rest = figures.at("rest");
    double worst = 0;
    for (size_t c = 0; c < 65; ++c) {
      for (size_t i = 0; i < 3; ++i) {
        const float* q = rotations.data() + (c * 3 + i) * 4;
        EXPECT_NEAR(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3], 1, 1e-5);
        const double w = q[3];
        double bone[3];
        for (size_t k = 0; k < 3; ++k) {
          bone[k] = rest.at(i + 1).at(k).get<double>() - rest.at(i).at(k).get<double>();
        }
        const auto cross = [](const auto& a, const auto& b, size_t k) {
          return double{a[(k + 1) % 3]} * b[(k + 2) % 3] - double{a[(k + 2) % 3]} * b[(k + 1) % 3];
        };
        const double twice[3] = {2 * cross(q, bone, 0), 2 * cross(q, bone, 1), 2 * cross(q, bone, 2)};
        const float* from = joints.data() + (c * 4 + i) * 3;
        for (size_t k = 0; k < 3; ++k) {
          const double turned = bone[k] + w * twice[k] + cross(q, twice, k);
          worst = std::max(worst, std::abs(turned - (double{from[k + 3]} - from[k])));
        }
      }
    }
    EXPECT_LT(worst, 1e-5);
  }
}

// The device and the reference reach the same targets; of double precision no float32 noise remains.
TEST_F(Ik, ReferenceAgrees) {
  const std::vector<std::vector<std::string>> cases = {{},
                                                       {"--limits", "cone:50", "--free-base"},
                                                       {"--limits", "hinge:0,0,1,-90,30", "--free-base"},
                                                       {"--limits", "ellipse:40,70,30,20"},
                                                       {"--limits", "cone:60", "--solver", "dls"},
                                                       {"--solver", "ccd"}};
  for (std::vector<std::string> arguments : cases) {
    SCOPED_TRACE(::testing::PrintToString(arguments));
    arguments.insert(arguments.end(), {"--joints", "5", "--chains", "500"});
    const nlohmann::json device = solve(arguments);
    arguments.insert(arguments.end(), {"--device", "cpu"});
    const nlohmann::json reference = solve(arguments);
    EXPECT_NE(reference.at("device"), device.at("device"));
    EXPECT_EQ(reference.at("solver"), device.at("solver"));
    EXPECT_NEAR(reference.at("solvedFraction"), device.at("solvedFraction"), 0.02);
    EXPECT_LT(reference.at("maxLimitViolation"), 1e-5);
    EXPECT_LT(reference.at("maxBoneLengthError"), 1e-6);
    EXPECT_GT(reference.at("cpuNanosecondsPerSolve"), 0);
  }
}

TEST_F(Ik, PoleChoosesTheSide) {
  write("t.f32", {0.6f, 0, 0});
  for (const float side : {1.0f, -1.0f}) {
    const nlohmann::json figures =
        solve({"--joints", "3", "--rest", "straight", "--targets", file("t.f32"), "--out", file("j.f32"),
               "--pole", side > 0 ? "0,0,1e-9" : "0,0,-5"});
    EXPECT_EQ(figures.at("pole"), nlohmann::json({0.0, 0.0, side}));
    EXPECT_GT(side * read("j.f32").at(5), 0.2f);
  }
}

TEST_F(Ik, OutOfReachAndOnTheBase) {
  write("t.f32", {3, 0, 0, 0, 0, 0, 0, 1e6f, 0, 1e-30f, 0, 0});
  for (const char* limits : {"none", "cone:60"}) {
    SCOPED_TRACE(limits);
    const nlohmann::json figures =
        solve({"--joints", "4", "--targets", file("t.f32"), "--limits", limits, "--out", file("j.f32")});
    EXPECT_EQ(figures.at("stopped").at("unreachable"), 2);
    for (const float value : read("j.f32")) EXPECT_TRUE(std::isfinite(value));
    EXPECT_TRUE(figures.at("maxError").is_number());
  }
}

TEST_F(Ik, InterruptedRowsAreWhole) {
  bool sent = false;
  const Result result = skitter({"ik", "--joints", "3", "--chains", "20", "--start", "previous", "--rows",
                                 "50000", "--out", file("j.f32"), "--json", file("f.json")},
                                {}, [&](int child) {
                                  std::error_code error;
                                  if (sent || !(fs::file_size(file("j.f32.part"), error) > 50000) || error)
                                    return;
                                  EXPECT_FALSE(fs::exists(file("j.f32")));
                                  kill(child, SIGINT);
                                  sent = true;
                                });
  ASSERT_TRUE(sent);
  EXPECT_EQ(result.code, 130) << result.err;
  EXPECT_NE(result.out.find("interrupted"), std::string::npos) << result.out;
  EXPECT_TRUE(json("f.json").at("interrupted"));
  EXPECT_EQ(json("f.json").at("solvesWanted"), 1000000);
  const uint64_t solves = json("f.json").at("solves");
  EXPECT_EQ(solves % 20, 0u);
  EXPECT_LT(solves, 1000000u);
  EXPECT_EQ(fs::file_size(file("j.f32")), solves * 36);
  EXPECT_EQ(files(), (std::vector<std::string>{"f.json", "j.f32"}));
}

TEST_F(Ik, ChainsThatCannotBe) {
  expectError({}, {"--joints", "--bones"});
  expectError({"--joints", "1"}, {"--joints", "1", "2 to 16"});
  expectError({"--joints", "17"}, {"--joints", "17"});
  expectError({"--joints", "-4"}, {"--joints", "-4"});
  expectError({"--joints", "five"}, {"--joints", "five"});
  expectError({"--joints", "5", "--bones", "1,1,1"}, {"--bones", "3", "4"});
  expectError({"--bones", "1,2,x"}, {"--bones", "x"});
  expectError({"--bones", "1,nan"}, {"--bones", "nan"});
  expectError({"--bones", "1,-1"}, {"--bones", "-1"});
  expectError({"--bones", "1,,1"}, {"--bones", "empty"});
  expectError({"--bones", "0,0"}, {"--bones", "0,0"});
  expectError({"--bones", ""}, {"--bones"});
  expectError({"--bones", "1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1"}, {"--bones", "16", "15"});
  expectError({"--joints", "3", "--rest", "curled"}, {"--rest", "curled"});
  expectError({"--joints", "3", "--pole", "0,0,0"}, {"--pole"});
  expectError({"--joints", "3", "--pole", "1,0"}, {"--pole", "3"});
}

TEST_F(Ik, LimitsThatCannotBe) {
  const auto refused = [&](const char* limits, const std::vector<std::string>& words) {
    expectError({"--joints", "4", "--limits", limits}, words);
  };
  refused("", {"--limits"});
  refused("cones:30", {"--limits", "cones:30"});
  refused("cone", {"--limits cone"});
  refused("cone:0", {"--limits cone", "0"});
  refused("cone:-30", {"--limits cone", "-30"});
  refused("cone:181", {"--limits cone", "181"});
  refused("cone:nan", {"--limits cone", "nan"});
  refused("cone:30,40", {"--limits cone", "30,40"});
  refused("ellipse:1,2,3", {"--limits ellipse", "4"});
  refused("ellipse:1,2,3,0", {"--limits ellipse", "0"});
  refused("hinge:0,0,1", {"--limits hinge"});
  refused("hinge:0,0,0,-10,10", {"--limits hinge"});
  refused("hinge:0,0,1,20,10", {"--limits hinge", "MIN"});
  refused("hinge:0,0,1,-190,10", {"--limits hinge", "-190"});
  expectError({"--joints", "4", "--rest", "straight", "--limits", "hinge:1,0,0,-10,10"},
              {"--limits", "bone 0", "axis"});
}

TEST_F(Ik, SolversThatCannot) {
  expectError({"--joints", "4", "--solver", "magic"}, {"--solver", "magic", "fabrik"});
  expectError({"--joints", "4", "--solver", "two-bone"}, {"two-bone", "3 joints", "4"});
  expectError({"--joints", "3", "--solver", "two-bone", "--limits", "cone:30"}, {"two-bone", "--limits"});
  expectError({"--joints", "4", "--solver", "stretch-align", "--limits", "cone:30"},
              {"stretch-align", "--limits", "cone:30"});
  expectError({"--joints", "4", "--solver", "active-set"}, {"active-set", "limits", "none"});
  for (const char* solver : {"dissertation-keep", "dissertation-edge"}) {
    expectError({"--joints", "4", "--solver", solver, "--limits", "hinge:0,0,1,-10,10"},
                {solver, "cones", "hinge"});
    expectError({"--joints", "4", "--solver", solver, "--limits", "ellipse:1,2,3,4"}, {solver, "cones"});
  }
}

TEST_F(Ik, NumbersThatCannotBe) {
  const auto refused = [&](const char* flag, const char* value) {
    expectError({"--joints", "3", flag, value}, {flag, value});
  };
  refused("--chains", "0");
  refused("--chains", "-1");
  refused("--chains", "16777217");
  refused("--chains", "99999999999999999999");
  refused("--rows", "0");
  refused("--rows", "1000001");
  refused("--tolerance", "-1");
  refused("--tolerance", "0");
  refused("--tolerance", "nan");
  refused("--tolerance", "2");
  refused("--iterations", "0");
  refused("--iterations", "1000000");
  refused("--seed", "-1");
  refused("--start", "middle");
  expectError({"--joints", "3", "--rows", "5"}, {"--rows", "--start previous"});
  expectError({"--joints", "3", "crab"}, {"crab"});
}

TEST_F(Ik, TargetsThatCannotBe) {
  const auto refused = [&](const char* name, const std::vector<std::string>& words) {
    expectError({"--joints", "3", "--targets", file(name), "--out", file("j.f32")}, words);
  };
  refused("none.f32", {"none.f32"});
  refused("", {file("")});
  AppTest::write("empty.f32", "");
  refused("empty.f32", {"empty.f32", "empty"});
  AppTest::write("odd.f32", std::string(25, 'x'));
  refused("odd.f32", {"odd.f32", "25", "12"});
  write("nan.f32", {0, 0, 1, std::nanf(""), 0, 0});
  refused("nan.f32", {"nan.f32", "target 1", "nan"});
  write("inf.f32", {0, -std::numeric_limits<float>::infinity(), 1});
  refused("inf.f32", {"inf.f32", "target 0", "inf"});
  write("seven.f32", spiral(7));
  for (const char* start : {"rest", "previous"}) {
    expectError({"--joints", "3", "--targets", file("seven.f32"), "--chains", "3", "--start", start},
                {"seven.f32", "7 targets", "rows of 3"});
  }
  const std::vector<std::string> with = {"--joints", "3", "--targets", file("seven.f32")};
  const auto and2 = [&](const char* flag, const char* value) {
    std::vector<std::string> all = with;
    all.insert(all.end(), {flag, value});
    return all;
  };
  expectError(and2("--rows", "7"), {"--rows", "--targets"});
  expectError(and2("--seed", "7"), {"--seed", "--targets"});
}

TEST_F(Ik, OutputsThatCannotBe) {
  for (const char* flag : {"--out", "--rotations", "--json"}) {
    expectError({"--joints", "3", flag, file("none/out")}, {flag, "none"});
    expectError({"--joints", "3", flag, file("")}, {flag, "directory"});
    expectError({"--joints", "3", flag, "/proc/none"}, {"/proc/none"});
    expectError({"--joints", "3", flag, "/dev/null"}, {flag, "/dev/null"});
  }
  expectError({"--joints", "16", "--chains", "100000", "--start", "previous", "--rows", "1000000", "--out",
               file("j.f32")},
              {"--out", "j.f32", "disk"});
  expectError({"--joints", "3", "--out", file("same"), "--json", file("same")}, {"--out", "--json", "same"});
}

TEST_F(Ik, NoDevice) {
  expectRefusal(skitter({"ik", "--joints", "3", "--device", "no such device", "--out", file("j.f32")}), 3,
                {"no such device"});
  EXPECT_TRUE(files().empty());
}

// Lines that begin with `skitter ik` in help and manual: each must run as it stands.
std::vector<std::string> examplesIn(const std::string& text) {
  std::vector<std::string> examples;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const size_t from = line.find_first_not_of(' ');
    if (from == std::string::npos || from < 2 || line.compare(from, 11, "skitter ik ") != 0) continue;
    examples.push_back(line.substr(from, line.find('#') - from));
  }
  return examples;
}

TEST_F(Ik, DocumentedExamplesRun) {
  std::ifstream manual(SKITTER_ROOT "/docs/ik-command.md");
  std::vector<std::string> examples =
      examplesIn({std::istreambuf_iterator<char>(manual), std::istreambuf_iterator<char>()});
  EXPECT_GE(examples.size(), 4u);
  for (const char* page : {"ik", "--help"}) {
    std::vector<std::string> command = {SKITTER_BINARY, page};
    if (command[1] == "ik") command.push_back("--help");
    const std::vector<std::string> more = examplesIn(runProgram(command).out);
    EXPECT_GE(more.size(), 1u);
    examples.insert(examples.end(), more.begin(), more.end());
  }
  write("targets.f32", spiral(90));
  const char* device = std::getenv("SKITTER_TEST_DEVICE");
  for (const std::string& example : examples) {
    SCOPED_TRACE(example);
    std::string command = "cd '" + file("") + "' && " SKITTER_BINARY + example.substr(7);
    if (device && command.find("--device") == std::string::npos) {
      command += " --device '" + std::string(device) + "'";
    }
    const Result result = runProgram({"sh", "-c", command});
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_NE(result.out.find("solved"), std::string::npos) << result.out;
  }
}

}  // namespace
}  // namespace skitter::test
