// The opponents of grid and stage avoid: one against the reference, the other against what its method
// promises.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "bench/cpu_crowd/avoid/kd_tree.h"
#include "bench/cpu_crowd/avoid/orca.h"
#include "bench/cpu_crowd/avoid/orca_check.h"
#include "bench/cpu_crowd/avoid/walkers.h"
#include "cpu_reference/stages/avoid.h"

namespace skitter::test {
namespace {

using cpu_avoid::Aim;
using cpu_avoid::Allowed;
using cpu_avoid::Avoider;
using cpu_avoid::KdTree;
using cpu_avoid::Velocity;
using cpu_avoid::Walkers;
using cpu_crowd::Width;

constexpr float metre = 1024;  // quanta

// Drawn agents, in a square of so many metres a side.
struct Drawn {
  size_t agents = 100;
  double side = 15;
  bool areAlike = true;             // of one size, and all avoid
  double middleX = 0, middleZ = 0;  // of the square
  uint32_t seed = 1;
};
Walkers draw(const Drawn& drawn) {
  std::mt19937 random(drawn.seed);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  Walkers walkers;
  walkers.quanta = metre;
  walkers.look = 2 * static_cast<int32_t>(metre);
  const auto putPlace = [](double at, std::vector<float>& tile, std::vector<float>& local) {
    tile.push_back(static_cast<float>(std::floor(at / 16)));
    local.push_back(static_cast<float>(at - 16 * std::floor(at / 16)));
    if (local.back() >= 16) local.back() = 15.9f;
  };
  for (size_t i = 0; i < drawn.agents; ++i) {
    putPlace(drawn.middleX + between(-0.5, 0.5) * drawn.side, walkers.tileX, walkers.localX);
    putPlace(drawn.middleZ + between(-0.5, 0.5) * drawn.side, walkers.tileZ, walkers.localZ);
    const double heading = between(-3, 3), wanted = between(-3, 3), fast = between(0, 1.3);
    walkers.headingX.push_back(static_cast<float>(std::sin(heading)));
    walkers.headingZ.push_back(static_cast<float>(std::cos(heading)));
    walkers.speed.push_back(static_cast<float>(between(0, 1.2)));
    walkers.wantedX.push_back(static_cast<float>(fast * std::sin(wanted)));
    walkers.wantedZ.push_back(static_cast<float>(fast * std::cos(wanted)));
    walkers.radius.push_back(drawn.areAlike ? 357 : static_cast<int32_t>(between(100, 900)));
    walkers.share.push_back(drawn.areAlike || between(0, 1) < 0.7 ? 0.5f : 1.0f);
  }
  return walkers;
}

reference::AgentBody bodyOf(const Walkers& walkers, size_t i) {
  reference::AgentBody body;
  body.tileX = walkers.tileX[i], body.tileZ = walkers.tileZ[i];
  body.localX = walkers.localX[i], body.localZ = walkers.localZ[i];
  body.heading = {walkers.headingX[i], walkers.headingZ[i]};
  body.speed = walkers.speed[i];
  return body;
}

std::vector<reference::Walker> referenceOf(const Walkers& walkers) {
  std::vector<reference::Walker> all;
  for (size_t i = 0; i < walkers.size(); ++i)
    all.push_back(reference::walkerOf(bodyOf(walkers, i), static_cast<int64_t>(i), walkers.radius[i],
                                      walkers.share[i] < 0.75f, walkers.quanta));
  return all;
}

// Who is further from the reference than float32 accounts for, of those whose side no rounding decides.
struct Comparison {
  size_t compared = 0, undecided = 0;
  std::string fault;  // of the first one
};
Comparison compare(const Walkers& walkers, const std::vector<float>& records) {
  // As in bench/crowd/avoid_contest.cpp.
  constexpr double tolerance = 1e-3;
  Comparison comparison;
  const reference::AvoidTuning tuning{
      .quanta = walkers.quanta, .look = walkers.look, .legLength = walkers.legLength};
  const std::vector<reference::Walker> all = referenceOf(walkers);
  for (size_t i = 0; i < walkers.size(); ++i) {
    const reference::AvoidResult expected =
        reference::avoid(tuning, {walkers.tick, double{walkers.dt}}, bodyOf(walkers, i), all[i], all,
                         {walkers.wantedX[i], walkers.wantedZ[i]}, false);
    const bool isDecided = std::ranges::all_of(
        expected.planes, [](const reference::HalfPlane& plane) { return plane.sideMargin > 1e-5; });
    ++(isDecided ? comparison.compared : comparison.undecided);
    const float* got = &records[4 * i];
    const double error = std::hypot(got[0] - expected.velocity.x, got[1] - expected.velocity.y);
    // Times for a metre, for a speed errs much where hardly anything bounds it.
    const double slowness = 1 / expected.mostSpeed;
    const double slower = std::abs(1 / static_cast<double>(got[3]) - slowness);
    const bool isSame = -static_cast<double>(got[2]) == static_cast<double>(expected.seen) &&
                        slower <= tolerance * (1 + slowness) && (!isDecided || error <= tolerance);
    if (isSame || !comparison.fault.empty()) continue;
    comparison.fault = "agent " + std::to_string(i) + " of " + std::to_string(walkers.size()) + ": (" +
                       std::to_string(got[0]) + ", " + std::to_string(got[1]) + "), " +
                       std::to_string(-got[2]) + " in reach, expected (" +
                       std::to_string(expected.velocity.x) + ", " + std::to_string(expected.velocity.y) +
                       "), " + std::to_string(expected.seen) + "; at most " + std::to_string(got[3]) +
                       " m/s, expected " + std::to_string(expected.mostSpeed);
  }
  return comparison;
}

class SoftAvoiderTest : public testing::TestWithParam<Width> {
 protected:
  std::vector<float> solve(const Walkers& walkers, int threads = 1) const {
    const std::unique_ptr<Avoider> avoider = cpu_avoid::softAvoider(walkers, GetParam(), threads);
    avoider->forget();
    avoider->tick();
    return avoider->records();
  }
  void expectAsTheReference(const Walkers& walkers, int threads = 1) const {
    const Comparison comparison = compare(walkers, solve(walkers, threads));
    EXPECT_EQ(comparison.fault, "");
    EXPECT_LE(comparison.undecided, comparison.compared / 50);
  }
};

TEST_P(SoftAvoiderTest, FewAndManyAsTheReference) {
  for (const size_t agents : {1u, 2u, 7u, 15u, 16u, 17u, 33u, 300u})
    expectAsTheReference(draw({.agents = agents, .side = 1.5 * std::sqrt(agents)}));
  EXPECT_TRUE(solve(Walkers{}).empty());
}

// Of up to 8 neighbours, of up to 16 in reach, of up to 64 and of more.
TEST_P(SoftAvoiderTest, SparseAndDenseAsTheReference) {
  for (const double side : {60.0, 12.0, 7.0, 3.0}) expectAsTheReference(draw({.agents = 120, .side = side}));
}

TEST_P(SoftAvoiderTest, SizesAndWhoDoesNotYieldAsTheReference) {
  for (const uint32_t seed : {1u, 2u, 3u})
    expectAsTheReference(draw({.agents = 150, .side = 20, .areAlike = false, .seed = seed}));
}

// Where the table of buckets ends and where numbers of tiles change their sign, and far away.
TEST_P(SoftAvoiderTest, EverywhereAsTheReference) {
  for (const double at : {-3990.0, -800.0, 0.0, 16.0, 3990.0})
    expectAsTheReference(draw({.agents = 400, .side = 40, .middleX = at, .middleZ = -0.3 * at}), 2);
}

TEST_P(SoftAvoiderTest, WhoAreInOnePlacePartAsTheReference) {
  Walkers walkers = draw({.agents = 24});
  for (size_t i = 1; i < walkers.size(); ++i) {
    walkers.tileX[i] = walkers.tileX[0], walkers.localX[i] = walkers.localX[0];
    walkers.tileZ[i] = walkers.tileZ[0], walkers.localZ[i] = walkers.localZ[0];
  }
  expectAsTheReference(walkers);
}

TEST_P(SoftAvoiderTest, WhoIsAloneGoesAsItWants) {
  const Walkers walkers = draw({.agents = 9, .side = 3000});
  const std::vector<float> records = solve(walkers);
  for (size_t i = 0; i < walkers.size(); ++i) {
    EXPECT_EQ(records[4 * i], walkers.wantedX[i]) << i;
    EXPECT_EQ(records[4 * i + 1], walkers.wantedZ[i]) << i;
    EXPECT_EQ(records[4 * i + 2], 0) << i << ": it sees nobody";
    EXPECT_EQ(records[4 * i + 3], 100) << i << ": leg lengths a second, which nobody bounds";
  }
}

TEST_P(SoftAvoiderTest, ThreadsDoNotChangeABit) {
  const Walkers walkers = draw({.agents = 1000, .side = 45});
  const std::vector<float> one = solve(walkers);
  for (const int threads : {2, 3}) EXPECT_EQ(solve(walkers, threads), one) << threads;
}

TEST_P(SoftAvoiderTest, TicksAreAlikeAndTimed) {
  const Walkers walkers = draw({.agents = 500, .side = 30});
  const std::unique_ptr<Avoider> avoider = cpu_avoid::softAvoider(walkers, GetParam(), 2);
  avoider->tick();
  const std::vector<float> first = avoider->records();
  for (const cpu_crowd::StageSeconds& stage : avoider->stageSeconds()) EXPECT_EQ(stage.seconds, 0);
  avoider->forget();
  EXPECT_TRUE(std::isnan(avoider->records().front()));
  avoider->timeStages(true);
  avoider->tick();
  EXPECT_EQ(avoider->records(), first);
  ASSERT_EQ(avoider->stageSeconds().size(), 2u);
  for (const cpu_crowd::StageSeconds& stage : avoider->stageSeconds())
    EXPECT_GT(stage.seconds, 0) << stage.stage;
}

// The comparison sees each of these.
TEST_P(SoftAvoiderTest, WhoIsToldSomethingElseIsFoundOut) {
  const Walkers right = draw({.agents = 120, .side = 12});
  const auto faultOf = [&](const auto& change) {
    Walkers wrong = right;
    change(wrong);
    return compare(right, solve(wrong)).fault;
  };
  EXPECT_NE(faultOf([](Walkers& w) { w.look -= 40; }), "");
  EXPECT_NE(faultOf([](Walkers& w) { w.radius[60] += 30; }), "");
  EXPECT_NE(faultOf([](Walkers& w) { w.share[60] = 1; }), "");
  EXPECT_NE(faultOf([](Walkers& w) { w.speed[60] += 0.2f; }), "");
  EXPECT_NE(faultOf([](Walkers& w) { w.wantedX[60] += 0.1f; }), "");
  EXPECT_NE(faultOf([](Walkers& w) { w.legLength = 0.5f; }), "");
  EXPECT_EQ(faultOf([](Walkers&) {}), "");
}

INSTANTIATE_TEST_SUITE_P(, SoftAvoiderTest, testing::Values(Width::scalar, Width::simd),
                         [](const auto& param) { return param.param == Width::simd ? "simd" : "scalar"; });

// Half-planes of which about half of the programs can be had, some parallel or opposite.
struct Program {
  std::vector<Allowed> planes;
  double speed;
  Velocity wanted;
};
Program drawProgram(std::mt19937& random) {
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  Program program{{}, between(0.2, 2), {between(-2, 2), between(-2, 2)}};
  const auto count = static_cast<size_t>(between(1, 11));
  double angle = 0;
  for (size_t i = 0; i < count; ++i) {
    const double kind = between(0, 1);
    if (i == 0 || kind > 0.2)
      angle = between(-std::numbers::pi, std::numbers::pi);
    else
      angle += (kind < 0.1 ? std::numbers::pi : 0) + (kind < 0.05 || kind > 0.15 ? 1e-6 : 0);
    program.planes.push_back({{std::cos(angle), std::sin(angle)}, program.speed * between(-1.2, 0.7)});
  }
  return program;
}

TEST(LinearProgram, IsSolvedBestOrViolatedLeast) {
  std::mt19937 random(5);
  size_t had = 0, violated = 0;
  for (int i = 0; i < 4000; ++i) {
    const Program program = drawProgram(random);
    const std::span<const Allowed> planes(program.planes);
    Velocity v;
    const size_t first =
        cpu_avoid::solveProgram(planes, program.speed, {Aim::Kind::nearest, program.wanted}, v);
    if (first < planes.size())
      cpu_avoid::solveLeastViolation<cpu_avoid::orcaNeighbours>(planes, first, program.speed, v);
    const double least = cpu_avoid::leastViolation(planes, program.speed);
    EXPECT_LE(cpu_avoid::violationOf(planes, v), least + 1e-9) << i;
    EXPECT_LE(std::hypot(v.x, v.z), program.speed + 1e-9) << i;
    if (first < planes.size()) {
      EXPECT_GT(least, 1e-13) << i;
      ++violated;
      continue;
    }
    ++had;
    const double distance = std::hypot(v.x - program.wanted.x, v.z - program.wanted.z);
    // Half-planes that are parallel but for 1e-6 move their vertex by that many roundings.
    EXPECT_NEAR(distance, cpu_avoid::leastDistance(planes, program.speed, program.wanted), 1e-8) << i;
  }
  EXPECT_GT(had, 1000u);
  EXPECT_GT(violated, 500u);
}

TEST(LinearProgram, OppositeHalfPlanesAreViolatedAlike) {
  const std::vector<Allowed> planes = {{{0, 1}, 0.5}, {{0, -1}, 0.3}};
  Velocity v;
  const size_t first = cpu_avoid::solveProgram(planes, 1, {Aim::Kind::nearest, {0.2, 0}}, v);
  ASSERT_EQ(first, 1u);
  cpu_avoid::solveLeastViolation<cpu_avoid::orcaNeighbours>(planes, first, 1, v);
  EXPECT_NEAR(planes[0].violation(v), 0.4, 1e-12);
  EXPECT_NEAR(planes[1].violation(v), 0.4, 1e-12);
  EXPECT_NEAR(cpu_avoid::leastViolation(planes, 1), 0.4, 1e-12);
  EXPECT_NEAR(v.z, 0.1, 1e-12);
}

// By hand: what is nearest lies on an edge, at a vertex, on the disc and where it wants to be.
TEST(LinearProgram, IsSolvedAsByHand) {
  const auto solve = [](const std::vector<Allowed>& planes, const Velocity& wanted) {
    Velocity v;
    EXPECT_EQ(cpu_avoid::solveProgram(planes, 1, {Aim::Kind::nearest, wanted}, v), planes.size());
    return v;
  };
  const auto expect = [](const Velocity& v, double x, double z) {
    EXPECT_NEAR(v.x, x, 1e-12);
    EXPECT_NEAR(v.z, z, 1e-12);
  };
  expect(solve({}, {0.3, 0.4}), 0.3, 0.4);
  expect(solve({}, {3, 4}), 0.6, 0.8);
  expect(solve({{{1, 0}, 0.5}}, {0.1, 0.2}), 0.5, 0.2);
  expect(solve({{{1, 0}, 0.5}, {{0, 1}, 0.4}}, {0.1, 0.2}), 0.5, 0.4);
  expect(solve({{{1, 0}, 0.6}}, {0, 2}), 0.6, 0.8);
}

// The velocity that a half-plane's edge is reached by just touches, within the horizon; one that is nearer
// meets.
TEST(Orca, TheNearestEdgeOfTheObstacleJustTouches) {
  std::mt19937 random(8);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const auto nearestWithin = [](const Velocity& p, const Velocity& v, double horizon) {
    const double time = std::clamp(dot(p, v) / std::max(dot(v, v), 1e-12), 0.0, horizon);
    return std::hypot(p.x - time * v.x, p.z - time * v.z);
  };
  int rounds = 0, sides = 0, overlaps = 0;
  for (int i = 0; i < 3000; ++i) {
    const Velocity p{between(-2, 2), between(-2, 2)}, v{between(-2, 2), between(-2, 2)};
    const double radii = between(0.2, 1), distance = std::hypot(p.x, p.z);
    // At rest, and with all of the change: the bound is the change.
    const Allowed plane = cpu_avoid::orcaOf(p, v, {0, 0}, radii, 1);
    EXPECT_NEAR(std::hypot(plane.n.x, plane.n.z), 1, 1e-9);
    const Velocity edge{v.x + plane.bound * plane.n.x, v.z + plane.bound * plane.n.z};
    if (distance <= radii) {
      ++overlaps;
      const double after =
          std::hypot(p.x - cpu_avoid::orcaPushTime * edge.x, p.z - cpu_avoid::orcaPushTime * edge.z);
      EXPECT_NEAR(after, radii, 1e-9) << i;
      continue;
    }
    const bool isRound =
        std::abs(std::hypot(p.x - cpu_avoid::orcaHorizon * edge.x, p.z - cpu_avoid::orcaHorizon * edge.z) -
                 radii) < 1e-9;
    ++(isRound ? rounds : sides);
    EXPECT_NEAR(nearestWithin(p, edge, cpu_avoid::orcaHorizon), radii, 1e-6) << i;
    const bool meets = nearestWithin(p, v, cpu_avoid::orcaHorizon) < radii - 1e-6;
    if (meets) {
      EXPECT_GT(plane.bound, 0) << i;
    }
    // The share and the own velocity move the bound as the paper has it.
    const Allowed half = cpu_avoid::orcaOf(p, v, {0.3, -0.2}, radii, 0.5);
    EXPECT_NEAR(half.bound, 0.3 * plane.n.x - 0.2 * plane.n.z + 0.5 * plane.bound, 1e-12) << i;
  }
  EXPECT_GT(rounds, 100);
  EXPECT_GT(sides, 100);
  EXPECT_GT(overlaps, 50);
}

class KdTreeTest : public testing::Test {
 protected:
  static void build(KdTree& tree) {
    tree.begin();
    for (size_t piece = tree.pieces(); piece-- > 0;) tree.finish(piece);
  }
  static void expectNearest(const KdTree& tree, float distance) {
    const std::vector<KdTree::Point>& points = tree.points();
    for (uint32_t self = 0; self < points.size(); ++self) {
      std::vector<std::pair<float, uint32_t>> expected, got;
      for (const KdTree::Point& other : points) {
        const float x = other.x - points[self].x, z = other.z - points[self].z;
        if (other.number != points[self].number && x * x + z * z <= distance * distance)
          expected.emplace_back(x * x + z * z, other.number);
      }
      std::ranges::sort(expected);
      expected.resize(std::min(expected.size(), KdTree::mostFound));
      const KdTree::Found found = tree.nearest(self, distance);
      for (size_t k = 0; k < found.count; ++k)
        got.emplace_back(found.distance2[k], points[found.at[k]].number);
      ASSERT_EQ(got, expected) << self << " of " << points.size();
    }
  }
};

TEST_F(KdTreeTest, FindsTheNearest) {
  std::mt19937 random(3);
  // Sixteenths, so that sums are exact and distances are often equal.
  const auto draw = [&](int most) {
    return static_cast<float>(std::uniform_int_distribution<int>(0, most)(random)) / 16;
  };
  for (const size_t count : {0u, 1u, 2u, 10u, 11u, 12u, 200u, 900u})
    for (const size_t pieces : {1u, 3u, 16u}) {
      KdTree tree(count, pieces);
      for (KdTree::Point& point : tree.points()) point.x = draw(300), point.z = draw(100);
      build(tree);
      expectNearest(tree, 2.5f);
      for (KdTree::Point& point : tree.points()) point.x += draw(16), point.z -= draw(16);
      build(tree);
      expectNearest(tree, 2.5f);
    }
}

TEST_F(KdTreeTest, PointsMayShareAPlaceOrALine) {
  for (const bool line : {false, true}) {
    KdTree tree(100, 4);
    for (KdTree::Point& point : tree.points()) {
      point.x = 3;
      point.z = line ? static_cast<float>(point.number % 40) : -7;
    }
    build(tree);
    expectNearest(tree, 2);
  }
}

class OrcaAvoiderTest : public testing::Test {
 protected:
  static std::vector<float> solve(const Walkers& walkers, int threads) {
    const std::unique_ptr<Avoider> avoider = cpu_avoid::orcaAvoider(walkers, threads);
    avoider->forget();
    avoider->tick();
    return avoider->records();
  }
};

TEST_F(OrcaAvoiderTest, ViolatesHalfPlanesLeast) {
  size_t violated = 0;
  for (const double side : {60.0, 15.0, 9.0, 4.0}) {
    const Walkers walkers = draw({.agents = 150, .side = side});
    const std::vector<float> records = solve(walkers, 2);
    for (size_t i = 0; i < walkers.size(); ++i) {
      const std::vector<Allowed> planes = cpu_avoid::orcaPlanesOf(walkers, i);
      const Velocity v{records[4 * i], records[4 * i + 1]};
      EXPECT_EQ(records[4 * i + 3], static_cast<float>(planes.size())) << i;
      EXPECT_LE(cpu_avoid::orcaFault(walkers, i, v), cpu_avoid::orcaTolerance) << i;
      violated += cpu_avoid::violationOf(planes, v) > 1e-3 ? 1 : 0;
    }
  }
  EXPECT_GT(violated, 20u) << "the case of no allowed velocity is among them";
}

// A velocity that is off by a hundredth of a metre a second, against the half-plane that is met best.
TEST_F(OrcaAvoiderTest, AWrongVelocityIsFoundOut) {
  const Walkers walkers = draw({.agents = 150, .side = 12});
  const std::vector<float> records = solve(walkers, 1);
  size_t tried = 0;
  for (size_t i = 0; i < walkers.size(); ++i) {
    const Velocity v{records[4 * i], records[4 * i + 1]};
    const std::vector<Allowed> planes = cpu_avoid::orcaPlanesOf(walkers, i);
    for (const Allowed& plane : planes) {
      if (plane.violation(v) < cpu_avoid::violationOf(planes, v) - 1e-6) continue;
      ++tried;
      const Velocity wrong{v.x - 0.01 * plane.n.x, v.z - 0.01 * plane.n.z};
      EXPECT_GT(cpu_avoid::orcaFault(walkers, i, wrong), cpu_avoid::orcaTolerance) << i;
    }
    const double speed = cpu_avoid::orcaSpeedOf(walkers, i) + 0.01;
    EXPECT_GT(cpu_avoid::orcaFault(walkers, i, {speed, 0}), cpu_avoid::orcaTolerance) << i;
  }
  EXPECT_GT(tried, 50u);
}

TEST_F(OrcaAvoiderTest, ThreadsDoNotChangeABit) {
  const Walkers walkers = draw({.agents = 1000, .side = 45});
  const std::vector<float> one = solve(walkers, 1);
  for (const int threads : {2, 3}) EXPECT_EQ(solve(walkers, threads), one) << threads;
}

TEST_F(OrcaAvoiderTest, WhoIsAloneGoesAsItWants) {
  const Walkers walkers = draw({.agents = 9, .side = 3000});
  const std::vector<float> records = solve(walkers, 1);
  for (size_t i = 0; i < walkers.size(); ++i) {
    EXPECT_NEAR(records[4 * i], walkers.wantedX[i], 1e-6) << i;
    EXPECT_NEAR(records[4 * i + 1], walkers.wantedZ[i], 1e-6) << i;
  }
}

}  // namespace
}  // namespace skitter::test
