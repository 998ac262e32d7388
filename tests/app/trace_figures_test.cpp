// scripts/trace-figures on a trace whose figures are known by hand.
#include <array>
#include <cmath>
#include <regex>

#include "npy.h"
#include "process.h"

namespace skitter::test {
namespace {

constexpr uint64_t kTicks = 120, perSecond = 20, kAgents = 2, kLegs = 4;
constexpr double dt = 1.0 / perSecond, legLength = 2;

// A second is one cycle, in which each leg is in the air for four ticks, one leg after another.
constexpr std::array<uint64_t, kLegs> firstTickInAir = {0, 10, 5, 15};
constexpr uint64_t ticksInAir = 4;
constexpr std::array<std::array<double, 2>, kLegs> homes = {{{1, 1}, {1, -1}, {-1, 1}, {-1, -1}}};

uint64_t sinceLift(uint64_t tick, uint64_t leg) {
  return (tick + perSecond - firstTickInAir[leg]) % perSecond;
}

class TraceFigures : public AppTest {
 protected:
  TraceFigures() {
    nlohmann::json herd = {{"rig", "table"},           {"agents", kAgents},
                           {"legLength", legLength},   {"legNames", {"a", "b", "c", "d"}},
                           {"groupNames", {"A", "B"}}, {"groups", {0, 1, 1, 0}}};
    for (uint64_t leg = 0; leg < kLegs; ++leg) {
      herd["boneLengths"].push_back({legLength});
      herd["restDirections"].push_back({{0, -1, 0}});
      herd["limits"].push_back({0.1});
    }
    const nlohmann::json trace = {
        {"dt", dt},
        {"ticks", kTicks},
        {"terrain", {{"originX", -100}, {"originZ", -300}, {"spacingX", 50}, {"spacingZ", 100}}},
        {"herds", {herd}}};
    write("trace.json", trace.dump());
    // Ground that rises by 0.1 m a metre of x.
    Npy heights{"<f4", {7, 5}, std::vector<float>(35)};
    for (uint64_t row = 0; row < 7; ++row)
      for (uint64_t column = 0; column < 5; ++column)
        heights.at({row, column}) = 5 * static_cast<float>(column) - 10;
    writeNpy(file("heights.npy"), heights);

    for (uint64_t tick = 0; tick < kTicks; ++tick)
      for (uint64_t agent = 0; agent < kAgents; ++agent) {
        putBody(tick, agent, 0, 0);
        for (uint64_t leg = 0; leg < kLegs; ++leg)
          put(tick, agent, leg, homes[leg][0], 0, homes[leg][1], sinceLift(tick, leg) >= ticksInAir);
      }
  }

  static double ground(double x) { return 0.1 * x; }

  void putBody(uint64_t tick, uint64_t agent, double x, double z) {
    body.at({tick, agent, 0}) = static_cast<float>(x);
    body.at({tick, agent, 2}) = static_cast<float>(z);
    body.at({tick, agent, 6}) = 1;
  }

  // A straight leg of one bone, upright over its foot.
  void put(uint64_t tick, uint64_t agent, uint64_t leg, double x, double above, double z, bool stands) {
    for (uint64_t joint = 0; joint < 2; ++joint) {
      joints.at({tick, agent, leg, joint, 0}) = static_cast<float>(x);
      joints.at({tick, agent, leg, joint, 1}) =
          static_cast<float>(ground(x) + above + (joint == 0 ? legLength : 0));
      joints.at({tick, agent, leg, joint, 2}) = static_cast<float>(z);
    }
    rotations.at({tick, agent, leg, 0, 3}) = 1;
    stance.at({tick, agent, leg}) = stands ? 1 : 0;
  }

  std::string figures(const std::vector<std::string>& arguments = {}) const {
    for (const auto& [name, npy] :
         {std::pair{"joints", &joints}, {"rotations", &rotations}, {"stance", &stance}, {"body", &body}})
      writeNpy(file("herd0/" + std::string(name) + ".npy"), *npy);
    std::vector<std::string> command = {SKITTER_ROOT "/scripts/trace-figures", file("")};
    command.insert(command.end(), arguments.begin(), arguments.end());
    const Result result = runProgram(command);
    EXPECT_EQ(result.code, 0) << result.err;
    return result.out;
  }

  // The numbers of the row that begins so.
  static std::vector<double> row(const std::string& text, const std::string& name) {
    std::vector<double> numbers;
    const size_t at = text.find("\n  " + name);
    EXPECT_NE(at, std::string::npos) << name << " is not in:\n" << text;
    if (at == std::string::npos) return std::vector<double>(9, NAN);
    std::string line = text.substr(at + 3 + name.size());
    line = line.substr(0, line.find('\n'));
    static const std::regex number(R"((^|[\s(])(-?\d+(\.\d+)?(e[-+]\d+)?))");
    for (std::sregex_iterator i(line.begin(), line.end(), number), end; i != end; ++i)
      numbers.push_back(std::stod((*i)[2]));
    return numbers;
  }

  Npy joints{"<f4", {kTicks, kAgents, kLegs, 2, 3}, std::vector<float>(kTicks* kAgents* kLegs * 6)};
  Npy rotations{"<f4", {kTicks, kAgents, kLegs, 1, 4}, std::vector<float>(kTicks* kAgents* kLegs * 4)};
  Npy stance{"|u1", {kTicks, kAgents, kLegs}, std::vector<float>(kTicks* kAgents* kLegs)};
  Npy body{"<f4", {kTicks, kAgents, 7}, std::vector<float>(kTicks* kAgents * 7)};
};

TEST_F(TraceFigures, OfFeetThatStayAreNone) {
  const std::string text = figures();
  for (const char* name : {"slip", "worst slide", "skating", "penetration", "float", "swing penetration"})
    EXPECT_NEAR(row(text, name).at(0), 0, 1e-4) << name;
  EXPECT_NEAR(row(text, "limits exceeded by").at(0), 0, 1e-6);
  EXPECT_NEAR(row(text, "bone length error").at(0), 0, 1e-6);
  EXPECT_EQ(row(text, "groups overlap").at(0), 0);
  EXPECT_EQ(row(text, "speed achieved").at(0), 0);
  // Each leg stands for 16 of 20 ticks, and moves in one interval more than it is seen in the air.
  EXPECT_NEAR(row(text, "duty factor").at(0), 0.75, 0.005);
  EXPECT_EQ(row(text, "cycle").at(0), 1);
  EXPECT_NE(text.find("order, left        b-a "), std::string::npos) << text;
  EXPECT_NE(text.find("order, right       d-c "), std::string::npos) << text;
  // Leg d lifts first of its group and a quarter of a cycle before a; b follows c by a quarter.
  EXPECT_NE(text.find("lags in group A    d 0.000, a 0.250 "), std::string::npos) << text;
  EXPECT_NE(text.find("lags in group B    b 0.000, c -0.250 "), std::string::npos) << text;
}

TEST_F(TraceFigures, SlipIsOfPlantedFeetAndPerStance) {
  // Leg a of agent 1 slides by 4 cm in one interval of each second, and on its way through the air by more.
  for (uint64_t tick = 0; tick < kTicks; ++tick) {
    const uint64_t since = sinceLift(tick, 0);
    put(tick, 1, 0, since >= 10 ? 1.04 : 1, 0, 1, since >= ticksInAir);
    if (since == 2) put(tick, 1, 0, 1.5, 0, 1, false);
  }
  const std::string text = figures();
  // There are six slides. Leg a is in the air at first, so 5 of its stances end, and 6 of each other leg.
  EXPECT_NEAR(row(text, "slip").at(0), 100 * 6 * 0.04 / legLength / (kAgents * 23), 1e-4);
  EXPECT_NEAR(row(text, "worst slide").at(0), 100 * 0.04 / legLength, 1e-3);
  // Leg a stands at both ends of 90 intervals, each other leg of 89.
  EXPECT_NEAR(row(text, "skating").at(0), 100.0 * 6 / (kAgents * 357), 1e-3);
}

// Agent 1 is half as large; its leg a slides by 4 cm in one interval of each second.
TEST_F(TraceFigures, SizesAreMeasuredByThemselves) {
  nlohmann::json trace = json("trace.json");
  trace["herds"][0]["sizes"] = {
      {{"firstAgent", 0}, {"agents", 1}, {"size", 1}, {"legLength", legLength}},
      {{"firstAgent", 1}, {"agents", 1}, {"size", 0.5}, {"legLength", legLength / 2}}};
  write("trace.json", trace.dump());
  for (uint64_t tick = 0; tick < kTicks; ++tick) {
    const uint64_t since = sinceLift(tick, 0);
    put(tick, 1, 0, since >= 10 ? 1.04 : 1, 0, 1, since >= ticksInAir);
  }
  const std::string text = figures();
  const size_t second = text.find("herd 0: table, size 0.5, 1 agents");
  ASSERT_NE(second, std::string::npos) << text;
  EXPECT_NE(text.find("herd 0: table, size 1, 1 agents"), std::string::npos) << text;
  EXPECT_NEAR(row(text.substr(0, second), "worst slide").at(0), 0, 1e-4);
  EXPECT_NEAR(row(text.substr(second), "worst slide").at(0), 100 * 0.04 / (legLength / 2), 1e-3);
  // Its legs are drawn as long as those of agent 0.
  EXPECT_NEAR(row(text.substr(second), "bone length error").at(0), 1, 1e-6);
}

TEST_F(TraceFigures, DepthIsOfAllFeetAndHeightOfPlantedOnes) {
  for (uint64_t tick = 0; tick < kTicks; ++tick) {
    const bool stands = sinceLift(tick, 1) >= ticksInAir;
    put(tick, 0, 1, 1, stands ? 0.03 : 0.5, -1, stands);
    put(tick, 0, 2, -1, sinceLift(tick, 2) == 2 ? -0.06 : 0, 1, sinceLift(tick, 2) >= ticksInAir);
  }
  const std::string text = figures();
  const double all = kTicks * kLegs * kAgents, planted = 0.8 * all, swung = 0.2 * all;
  EXPECT_NEAR(row(text, "float").at(0), 100 * 0.03 / legLength * 0.8 * kTicks / planted, 1e-4);
  EXPECT_NEAR(row(text, "penetration").at(0), 100 * 0.06 / legLength * 6 / all, 1e-4);
  const std::vector<double> swing = row(text, "swing penetration");
  EXPECT_NEAR(swing.at(0), 3, 1e-2);
  EXPECT_NEAR(swing.at(1), 3 * 6 / swung, 1e-4);
  EXPECT_NEAR(swing.at(3), 100 * 6 / swung, 1e-3);
}

TEST_F(TraceFigures, LimitsAndBonesAreHeldAgainstTheRig) {
  // A bone that leans by 0.3 rad, is 0.05 m too long, and whose rotation says that it leans by 0.1 rad.
  const double reach = legLength + 0.05;
  joints.at({50, 1, 3, 1, 2}) = static_cast<float>(-1 + reach * std::sin(0.3));
  joints.at({50, 1, 3, 1, 1}) = joints.at({50, 1, 3, 0, 1}) - static_cast<float>(reach * std::cos(0.3));
  rotations.at({50, 1, 3, 0, 0}) = static_cast<float>(-std::sin(0.05));
  rotations.at({50, 1, 3, 0, 3}) = static_cast<float>(std::cos(0.05));
  const std::string text = figures();
  EXPECT_NEAR(row(text, "limits exceeded by").at(0), 0.2, 1e-3);
  EXPECT_NEAR(row(text, "bone length error").at(0), 0.05 / legLength, 1e-4);
  EXPECT_NEAR(row(text, "bone length error").at(1), 2 * std::sin(0.1), 1e-3);
}

TEST_F(TraceFigures, SpeedLeavesTheFirstSecondOut) {
  const double speeds[kAgents] = {1.2, 2.8};
  for (uint64_t tick = perSecond; tick < kTicks; ++tick)
    for (uint64_t agent = 0; agent < kAgents; ++agent)
      putBody(tick, agent, 0, speeds[agent] * dt * static_cast<double>(tick - perSecond));
  const std::vector<double> speed = row(figures({"4"}), "speed achieved");
  ASSERT_EQ(speed.size(), 4u);
  EXPECT_NEAR(speed.at(0), 50, 0.01);
  EXPECT_NEAR(speed.at(1), 4, 0);
  EXPECT_NEAR(speed.at(2), 30, 0.01);
  EXPECT_NEAR(speed.at(3), 50.0 * 99 / 119, 0.01);
}

// Bodies stand off the middle of a square of feet. With all feet down the nearest edge is 0.6 m away. With
// one in the air it is the diagonal: 0.7 m / sqrt(2) outside (a) or inside (d), 0.1 m / sqrt(2) inside (b) or
// outside (c), each for as long.
TEST_F(TraceFigures, MarginIsTheDistanceFromTheHullsEdge) {
  for (uint64_t tick = 0; tick < kTicks; ++tick)
    for (uint64_t agent = 0; agent < kAgents; ++agent) putBody(tick, agent, 0.3, 0.4);
  putBody(18, 1, 1.96, 1.28);  // in the first second 1 m beyond the corner a
  const std::vector<double> margin = row(figures(), "stability margin");
  ASSERT_EQ(margin.size(), 4u);
  EXPECT_NEAR(margin.at(0), -100 * 0.7 / std::sqrt(2) / legLength, 0.1);
  EXPECT_NEAR(margin.at(1), 100 * 0.6 * 0.2 / legLength, 0.1);
  EXPECT_NEAR(margin.at(2), 40, 1e-3);
  EXPECT_NEAR(margin.at(3), -100 / legLength, 0.1);
}

// A body that goes to and fro by 2 A every tick has third differences of 8 A, whatever A is: 16 W^4. The
// other one halts at each end, which is 8 W^4, and goes less far than counts.
TEST_F(TraceFigures, JerkIsOfThoseWhoMove) {
  for (uint64_t tick = 0; tick < kTicks; ++tick) {
    putBody(tick, 0, 0, tick % 2 == 0 ? 0.05 : -0.05);
    putBody(tick, 1, 0, tick % 4 < 2 ? 0.01 : -0.01);
  }
  const std::vector<double> jerk = row(figures(), "normalised jerk");
  ASSERT_EQ(jerk.size(), 2u);
  EXPECT_EQ(jerk.at(0), 0);
  constexpr double window = 0.4 * perSecond;
  EXPECT_NEAR(jerk.at(1), 16 * std::pow(window, 4), 10);
}

}  // namespace
}  // namespace skitter::test
