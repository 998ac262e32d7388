#include <gtest/gtest.h>

#include <limits>
#include <numbers>
#include <ostream>

#include "bench/cpu_baseline/verify.h"
#include "bench/cpu_baseline/workload.h"

namespace skitter::baseline {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

enum class Limits { none, cones, ellipses, hinges, twists, mixture };

Limit coneOf(float degrees) {
  Limit limit;
  limit.kind = LimitKind::cone;
  limit.cone = degrees * std::numbers::pi_v<float> / 180;
  return limit;
}

Limit ellipse() {
  Limit limit;
  limit.kind = LimitKind::ellipse;
  limit.positiveX = 0.5f, limit.negativeX = 0.9f, limit.positiveY = 1.2f, limit.negativeY = 0.7f;
  return limit;
}

Limit hinge() {
  Limit limit;
  limit.kind = LimitKind::hinge;
  limit.axis = {0, 0, 1};
  limit.low = -1.2f, limit.high = 0.9f;
  return limit;
}

Limit twisting() {
  Limit limit = coneOf(50);
  limit.twistLow = -0.6f, limit.twistHigh = 0.4f;
  return limit;
}

// In a mixture hinges lean on their axes, too, and one bone in five is free.
Limit limitOf(Limits limits, int bone) {
  Limit leaning = hinge();
  leaning.axis = {0.6f, 0, 0.8f};
  switch (limits) {
    case Limits::none:
      return {};
    case Limits::cones:
      return coneOf(60);
    case Limits::ellipses:
      return ellipse();
    case Limits::hinges:
      return hinge();
    case Limits::twists:
      return twisting();
    case Limits::mixture:
      break;
  }
  const Limit kinds[] = {coneOf(40), leaning, ellipse(), twisting(), Limit{}};
  return kinds[bone % 5];
}

Chain chainOf(int joints, Limits limits) {
  Chain chain = bentChain(joints - 1);
  for (size_t i = 0; i < chain.bones.size(); ++i) chain.bones[i].limit = limitOf(limits, int(i));
  return chain;
}

void solve(bool simd, const Model& model, const Options& options, Batch& batch, int threads = 1) {
  simd ? solveSimd(model, options, batch, threads) : solveScalar(model, options, batch);
}

struct Case {
  Solver solver;
  int joints;
  Limits limits;
  friend void PrintTo(const Case& of, std::ostream* out) {
    const char* solvers[] = {"fabrik", "stretchAlign", "activeSet"};
    const char* limits[] = {"none", "cones", "ellipses", "hinges", "twists", "mixture"};
    *out << solvers[int(of.solver)] << '_' << of.joints << '_' << limits[int(of.limits)];
  }
};

std::vector<Case> allCases() {
  std::vector<Case> cases;
  for (int joints : {2, 3, 5, 10, 16}) {
    for (Solver solver : {Solver::fabrik, Solver::stretchAlign})
      cases.push_back({solver, joints, Limits::none});
    for (Limits limits : {Limits::cones, Limits::ellipses, Limits::hinges, Limits::twists, Limits::mixture}) {
      for (Solver solver : {Solver::fabrik, Solver::activeSet}) cases.push_back({solver, joints, limits});
    }
  }
  cases.push_back({Solver::fabrik, 7, Limits::none});  // a count of bones that is not compiled in
  cases.push_back({Solver::activeSet, 7, Limits::mixture});
  return cases;
}

class EverySolver : public testing::TestWithParam<Case> {
 protected:
  Chain chain = chainOf(GetParam().joints, GetParam().limits);
  Model model{chain};
  Options options{GetParam().solver};

  void expectHolds(const Batch& batch) const {
    const Findings found = verify(chain, options, batch);
    EXPECT_TRUE(found.hold()) << describe(found);
  }
};

INSTANTIATE_TEST_SUITE_P(Baseline, EverySolver, testing::ValuesIn(allCases()),
                         [](const auto& of) { return testing::PrintToString(of.param); });

TEST_P(EverySolver, HoldsForAnyCountColdAndTracking) {
  for (size_t count : {0, 1, 7, 9, 1000}) {
    const std::vector<Rows> ticks = trackedTargets(chain, count, 3, 5);
    for (bool simd : {false, true}) {
      SCOPED_TRACE(testing::Message() << count << (simd ? " simd" : " scalar"));
      Batch batch(model, count);
      for (const Rows& tick : ticks) {
        batch.target = tick;
        solve(simd, model, options, batch);
        expectHolds(batch);
        options.start = Start::previous;
      }
      options.start = Start::rest;
    }
  }
}

// Both do the same iterations; they part where rounding decides.
TEST_P(EverySolver, LanesAgreeWithScalar) {
  constexpr size_t kChains = 1000;
  Batch scalar(model, kChains), simd(model, kChains);
  scalar.target = simd.target = coldTargets(chain, kChains, 3);
  solve(false, model, options, scalar);
  solve(true, model, options, simd);
  const Findings a = verify(chain, options, scalar), b = verify(chain, options, simd);
  EXPECT_NEAR(double(a.reached), double(b.reached), 0.01 * kChains);
  EXPECT_NEAR(a.iterations, b.iterations, 0.03 * a.iterations);
  size_t same = 0;
  for (size_t i = 0; i < kChains; ++i) same += scalar.iterations(i) == simd.iterations(i);
  EXPECT_GT(same, kChains * 9 / 10);
}

TEST_P(EverySolver, ThreadsChangeNothing) {
  Batch one(model, 1000), three(model, 1000);
  one.target = three.target = coldTargets(chain, 1000, 4);
  solve(true, model, options, one);
  solve(true, model, options, three, 3);
  for (size_t i = 0; i < 1000; ++i) {
    EXPECT_EQ(one.error(i), three.error(i));
    EXPECT_EQ(one.iterations(i), three.iterations(i));
  }
}

TEST_P(EverySolver, SkipsTargetsThatAreNotFinite) {
  for (bool simd : {false, true}) {
    Batch batch(model, 9);
    batch.target = coldTargets(chain, 9, 6);
    batch.target.at(1, 2) = kNaN;
    batch.target.at(0, 8) = std::numeric_limits<float>::infinity();
    solve(simd, model, options, batch);
    for (size_t i = 0; i < 9; ++i) EXPECT_EQ(batch.stop(i) == Stop::skipped, i == 2 || i == 8) << i;
    EXPECT_NEAR(batch.joints.at(0, 2), model.restJoints[0].x, 1e-6);
    expectHolds(batch);
  }
}

TEST_P(EverySolver, ReportsWhatIsOutOfReach) {
  for (bool simd : {false, true}) {
    Batch batch(model, 7);
    for (size_t i = 0; i < 7; ++i) batch.target.at(i % 3, i) = 1.3f;
    solve(simd, model, options, batch);
    for (size_t i = 0; i < 7; ++i) {
      EXPECT_EQ(batch.stop(i), Stop::unreachable);
      EXPECT_GT(batch.error(i), 0.29f);
    }
    expectHolds(batch);
  }
}

TEST_P(EverySolver, HoldsForTargetsAtTheBase) {
  for (bool simd : {false, true}) {
    Batch batch(model, 3);
    solve(simd, model, options, batch);
    expectHolds(batch);
  }
}

TEST_P(EverySolver, HoldsWithABoneOfNoLength) {
  for (size_t none : {size_t(0), chain.bones.size() - 1}) {
    if (chain.bones.size() < 2) return;
    Chain shorter = chain;
    shorter.bones[none].length = 0;
    const Model shorterModel(shorter);
    for (bool simd : {false, true}) {
      Batch batch(shorterModel, 40);
      batch.target = coldTargets(shorter, 40, 8);
      solve(simd, shorterModel, options, batch);
      const Findings found = verify(shorter, options, batch);
      EXPECT_TRUE(found.hold()) << describe(found);
    }
  }
}

Chain straightChain(int bones, const Limit& limit) {
  Chain chain = bentChain(bones, limit);
  for (Bone& bone : chain.bones) bone.rest = {1, 0, 0};
  return chain;
}

// Without the bend every pass would leave such a chain on its line.
TEST(Deadlock, StraightChainsReachTargetsOnTheirLine) {
  struct {
    Solver solver;
    Limit limit;
  } cases[] = {{Solver::fabrik, {}},
               {Solver::stretchAlign, {}},
               {Solver::activeSet, coneOf(90)},
               {Solver::activeSet, hinge()}};
  for (const auto& of : cases) {
    const Chain chain = straightChain(4, of.limit);
    const Model model(chain);
    for (bool simd : {false, true}) {
      Batch batch(model, 9);
      for (size_t i = 0; i < 9; ++i) batch.target.at(0, i) = 0.7f + 0.03f * float(i);
      const Options options{of.solver};
      solve(simd, model, options, batch);
      EXPECT_EQ(verify(chain, options, batch).reached, 9u) << int(of.solver);
    }
  }
}

TEST(Restarts, ReachWhatOneStartDoesNot) {
  const Chain chain = chainOf(4, Limits::hinges);
  const Model model(chain);
  Batch batch(model, 4000);
  batch.target = coldTargets(chain, 4000, 9);
  const Options options{Solver::activeSet};
  for (bool simd : {false, true}) {
    solve(simd, model, options, batch);
    EXPECT_GE(verify(chain, options, batch).reached, 3980u);
  }
}

// A target out of reach is tried again ever more rarely: 4, 8, 16, 32 ticks.
TEST(Restarts, BackOffWhereTheyAreInVain) {
  const Chain chain = chainOf(5, Limits::hinges);
  const Model model(chain);
  Options options{Solver::activeSet};
  for (bool simd : {false, true}) {
    Batch batch(model, 1);
    batch.target.at(2, 0) = 0.5f;  // off the hinges' plane
    std::vector<int> tries;
    options.start = Start::rest;
    solve(simd, model, options, batch);
    options.start = Start::previous;
    for (int tick = 0; tick < 40; ++tick) {
      solve(simd, model, options, batch);
      if (batch.iterations(0) > 16) tries.push_back(tick);
    }
    EXPECT_EQ(tries, (std::vector<int>{0, 5, 14, 31})) << simd;
  }
}

TEST(RestPull, BringsChainsOnTargetBackToRest) {
  for (const Limits limits : {Limits::hinges, Limits::ellipses, Limits::mixture}) {
    const Chain chain = chainOf(7, limits);
    const Model model(chain);
    for (bool simd : {false, true}) {
      Batch batch(model, 100);
      std::mt19937 random(4);
      const auto bent = [&] {
        double sum = 0;
        for (size_t c = 0; c < batch.chains; ++c)
          for (int row = 0; row < 18; ++row)
            if (row % 3 < 2) sum += batch.pose.at(row, c) * batch.pose.at(row, c);
        return sum;
      };
      for (size_t c = 0; c < batch.chains; ++c) {
        const Pose pose = randomPose(chain, random);
        const auto tip = jointsOf(chain, pose).back();
        const double place[] = {tip.x, tip.y, tip.z};
        for (int b = 0; b < 6; ++b) {
          const float record[] = {pose.x[b], pose.y[b], pose.twist[b]};
          for (int k = 0; k < 3; ++k) batch.pose.at(3 * b + k, c) = record[k];
        }
        for (int k = 0; k < 3; ++k) batch.target.at(k, c) = float(place[k]);
      }
      const double before = bent();
      const Options options{Solver::activeSet, Start::previous, 9e-4f, 4, 0.1f};
      for (int tick = 0; tick < 50; ++tick) solve(simd, model, options, batch);
      EXPECT_LT(bent(), 0.8 * before) << simd << int(limits);
      const Findings found = verify(chain, options, batch);
      EXPECT_TRUE(found.hold()) << describe(found);
      EXPECT_EQ(found.reached, 100u);
    }
  }
}

TEST(Chains, RefuseWhatTheyCannotBe) {
  EXPECT_THROW(Model(bentChain(16)), std::invalid_argument);
  Chain chain = bentChain(3, hinge());
  chain.bones[1].limit.axis = chain.bones[1].rest;
  EXPECT_THROW((Model(chain)), std::invalid_argument);
  chain = bentChain(3, coneOf(0));
  EXPECT_THROW((Model(chain)), std::invalid_argument);
  const Model free(bentChain(3));
  Batch batch(free, 1);
  EXPECT_THROW(solveSimd(free, Options{Solver::activeSet}, batch), std::invalid_argument);
}

TEST(Chains, OfOneJointAreSkipped) {
  const Model model{Chain{}};
  Batch batch(model, 3);
  solveSimd(model, {}, batch);
  EXPECT_EQ(batch.stop(2), Stop::skipped);
}

}  // namespace
}  // namespace skitter::baseline
