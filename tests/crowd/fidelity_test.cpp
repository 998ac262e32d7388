// The figures that a crowd reports, held against what docs/stages/measure.md calls each: sums in double
// precision over every tick, in leg lengths of the herd's own rig.
#include <algorithm>
#include <cmath>

#include "cpu_reference/stages/measure.h"
#include "crowd/herd.h"
#include "crowd/simulation.h"
#include "gpu/transfer.h"
#include "validation/convert.h"

namespace skitter::test {
namespace {

using reference::Metric;

// The sums of any number of agents, lengths in leg lengths.
struct Sums {
  Metric metric;
  double legTicks = 0;
  std::vector<double> errors;  // reach errors, one a leg-tick
  uint64_t lastResorts = 0;

  void add(const Metric& m, double legLength, double legs) {
    for (double Metric::*length :
         {&Metric::slip, &Metric::penetration, &Metric::penetrationBeyond, &Metric::floating,
          &Metric::floatingBeyond, &Metric::depth, &Metric::margin})
      metric.*length += m.*length / legLength;
    for (double Metric::*count :
         {&Metric::ticks, &Metric::planted, &Metric::stays, &Metric::skates, &Metric::stances,
          &Metric::violations, &Metric::pairs, &Metric::crossings, &Metric::unstable, &Metric::footJerk,
          &Metric::footPath, &Metric::bodyJerk, &Metric::bodyPath})
      metric.*count += m.*count;
    for (double Metric::*length : {&Metric::largestError, &Metric::deepest})
      metric.*length = std::max(metric.*length, m.*length / legLength);
    metric.largestViolation = std::max(metric.largestViolation, m.largestViolation);
    if (m.supported > 0) {
      const double least = m.leastMargin / legLength;
      metric.leastMargin = metric.supported > 0 ? std::min(metric.leastMargin, least) : least;
    }
    metric.supported += m.supported;
    legTicks += m.ticks * legs;
  }
  void add(const Sums& other) {
    add(other.metric, 1, 0);
    legTicks += other.legTicks;
    errors.insert(errors.end(), other.errors.begin(), other.errors.end());
    lastResorts += other.lastResorts;
  }
  double error(double share) const {
    std::vector<double> sorted = errors;
    std::sort(sorted.begin(), sorted.end());
    return sorted.at(static_cast<size_t>(std::ceil(share * static_cast<double>(sorted.size()))) - 1);
  }
};

// The device's positions round by 1e-6 m, in all directions; what a tick counts may be a tie.
constexpr double kRounding = 1e-3, kTies = 1e-2;

void expectNear(const char* figure, double expected, double got, double relative) {
  EXPECT_NEAR(got, expected, relative * std::abs(expected) + 1e-6) << figure;
}

void expectFigures(const Sums& sums, const Fidelity& f) {
  const Metric& m = sums.metric;
  const auto over = [](double sum, double count) { return count > 0 ? sum / count : 0; };
  EXPECT_EQ(f.agentTicks, static_cast<uint64_t>(m.ticks));
  EXPECT_EQ(f.stances, static_cast<uint64_t>(m.stances));
  expectNear("slip", over(m.slip, m.stances), f.slip, kRounding);
  expectNear("skating", over(m.skates, m.stays), f.skating, kTies);
  expectNear("penetration", m.penetration / sums.legTicks, f.penetration, kRounding);
  expectNear("penetrationBeyond", m.penetrationBeyond / sums.legTicks, f.penetrationBeyond, kRounding);
  expectNear("floating", over(m.floating, m.planted), f.floating, kRounding);
  expectNear("floatingBeyond", over(m.floatingBeyond, m.planted), f.floatingBeyond, kRounding);
  expectNear("segmentPenetration", m.depth / sums.legTicks, f.segmentPenetration, kRounding);
  expectNear("segmentPenetrationMost", m.deepest, f.segmentPenetrationMost, kRounding);
  expectNear("crossing", over(m.crossings, m.pairs), f.crossing, kTies);
  expectNear("reachErrorMost", m.largestError, f.reachErrorMost, kRounding);
  expectNear("footJerk", over(m.footJerk, m.footPath), f.footJerk, kRounding);
  expectNear("bodyJerk", over(m.bodyJerk, m.bodyPath), f.bodyJerk, kRounding);
  expectNear("margin", over(m.margin, m.supported), f.margin, kRounding);
  expectNear("marginLeast", m.leastMargin, f.marginLeast, kRounding);
  expectNear("unstable", m.unstable / m.ticks, f.unstable, kTies);
}

// Herds count their reach errors too. A bucket is a quarter of an octave wide, the first one 2^-20.
void expectHerdFigures(const Sums& sums, const Fidelity& f) {
  expectFigures(sums, f);
  EXPECT_EQ(f.lastResorts, sums.lastResorts);
  const double exact = sums.error(0.99);
  EXPECT_GE(f.reachErrorP99, exact * (1 - 1e-5));
  EXPECT_LE(f.reachErrorP99, std::max(exact, std::exp2(-20)) * std::exp2(0.25) * (1 + 1e-5));
}

// The clip's limits are narrower than its motion, so that it breaks them.
Rig stiffSpider() {
  Rig rig = spiderRig();
  for (Leg& leg : rig.legs)
    for (Bone& bone : leg.bones) bone.coneHalfAngle = 0.2f;
  return rig;
}

// All its legs swing at once, and no foot is planted then.
Rig hopper() {
  Rig rig = scaledSpider(0.5f);
  rig.groups = {"A"};
  for (Leg& leg : rig.legs) leg.group = 0;
  return rig;
}

// The record of a herd, tick after tick.
class WalkRecord {
 public:
  WalkRecord(const crowd::Kind& kind, const Heightfield& ground, uint32_t agents)
      : kind_(kind),
        tuning_(validation::tuningOf(kind.parameters)),
        heights_(validation::heightsOf(ground, kind.parameters)),
        creature_(validation::creatureOf(kind.rigRecords, kind.legs, kind.bones, kind.groups)),
        metrics_(agents),
        watched_(agents) {}

  void add(const HerdState& state) {
    const auto legs = static_cast<size_t>(kind_.legs);
    for (size_t agent = 0; agent < state.agents; ++agent) {
      std::vector<reference::Foot> feet;
      std::vector<reference::Chain> chains;
      for (size_t leg = agent * legs; leg < (agent + 1) * legs; ++leg) {
        feet.push_back(validation::footOf(state, leg));
        chains.push_back(validation::chainOf(state, leg, kind_.bones));
        errors_.push_back(chains.back().reachError / kind_.rig.legLength);
        if (state.arc.empty()) continue;  // lands where it lands
        const reference::Step step = validation::stepOf(state, leg);
        if (step.duration < 0 && step.firstTick == static_cast<double>(state.tick - 1)) ++lastResorts_;
      }
      const reference::Measured measured =
          reference::measure(tuning_, heights_, creature_, validation::bodyOf(state, agent), feet, chains,
                             state.tick - 1, watched_[agent], metrics_[agent]);
      metrics_[agent] = measured.metric;
      watched_[agent] = measured.watched;
    }
  }
  Sums agent(size_t agent) const {
    Sums sums;
    sums.add(metrics_[agent], kind_.rig.legLength, kind_.legs);
    return sums;
  }
  Sums all() const {
    Sums sums;
    for (size_t i = 0; i < metrics_.size(); ++i) sums.add(agent(i));
    sums.errors = errors_;
    sums.lastResorts = lastResorts_;
    return sums;
  }

 private:
  const crowd::Kind& kind_;
  reference::Tuning tuning_;
  reference::Heights heights_;
  reference::Creature creature_;
  std::vector<Metric> metrics_;
  std::vector<reference::Watched> watched_;
  std::vector<double> errors_;
  uint64_t lastResorts_ = 0;
};

using FidelityTest = GpuTest;

// Three leg lengths; fast on steep ground, so that no figure is 0 in all herds.
TEST_F(FidelityTest, FiguresAreWhatTheRunGave) {
  constexpr uint32_t agents = 4;
  Scene scene = sceneOf(agents, 1, 1, Controller::clip);
  scene.herds.resize(3, scene.herds[0]);
  scene.herds[1].controller = Controller::loop;
  scene.herds[2].controller = Controller::adaptive;
  scene.herds[2].goal.speed = 5;
  const Heightfield ground =
      generateHeightfield({.columns = 129, .rows = 129, .amplitude = 16, .wavelength = 12});
  Crowd crowd(device(), ground, scene, {.rigs = {stiffSpider(), hopper(), scaledSpider(1.7f)}});

  std::vector<WalkRecord> records;
  for (int i = 0; i < 90; ++i) {
    simulate(device(), crowd, 1);
    for (uint32_t h = 0; h < 3; ++h) {
      // Tuning is complete once the first tick has told dt.
      if (i == 0) records.emplace_back(implOf(crowd).kindOf(h), ground, agents);
      records[h].add(crowd.download(h));
    }
  }

  Sums all;
  for (uint32_t h = 0; h < 3; ++h) {
    SCOPED_TRACE(testing::Message() << "herd " << h);
    const Sums sums = records[h].all();
    expectHerdFigures(sums, crowd.fidelity(h));
    // A clip is not judged by the rig's limits.
    EXPECT_EQ(crowd.fidelity(h).limitViolation.has_value(), h > 0);
    const std::vector<Fidelity> each = crowd.agentFidelity(h);
    ASSERT_EQ(each.size(), agents);
    for (size_t agent = 0; agent < agents; ++agent) expectFigures(records[h].agent(agent), each[agent]);
    all.add(sums);
  }
  const Fidelity total = crowd.fidelity();
  expectHerdFigures(all, total);
  for (const double figure : {total.slip, total.skating, total.penetrationBeyond, total.floatingBeyond,
                              total.segmentPenetration, total.crossing, total.reachErrorMost, total.footJerk,
                              total.bodyJerk, total.unstable, static_cast<double>(total.lastResorts)})
    EXPECT_GT(figure, 0);
  // Another percentile would lie in another bucket.
  const Sums walkers = records[2].all();
  EXPECT_GT(walkers.error(0.99), walkers.error(0.95) * std::exp2(0.25));
  EXPECT_GT(walkers.error(0.999), walkers.error(0.99) * std::exp2(0.25));
}

// How far each leg's bones are beyond their cones, radians: a direction's (X, Y) is the tangent of half its
// angle to the rest direction.
std::vector<double> violationsOf(const HerdState& state, const Rig& rig) {
  std::vector<double> violations;
  for (size_t leg = 0; leg < state.agents * rig.legs.size(); ++leg) {
    double most = 0;
    const auto directions = validation::chainOf(state, leg, rig.maxBones()).directions;
    for (size_t i = 0; i < directions.size(); ++i) {
      const double angle = 2 * std::atan(std::hypot(directions[i].x, directions[i].y));
      most = std::max(most, angle - double{rig.legs[leg % rig.legs.size()].bones[i].coneHalfAngle});
    }
    violations.push_back(most);
  }
  return violations;
}

// Turns the first bones of some legs out of their cones, each leg further than the one before, up to straight
// back. A sleeper's legs stay so, and are measured.
void turnOut(const gpu::Context& context, const crowd::Kind& kind) {
  const crowd::Page& page = kind.pages.at(0);
  std::vector<float> chain = gpu::download<float>(context, page.chain);
  const auto each = static_cast<size_t>(shared::chainStride(kind.bones)) * 4;
  for (int agent = 0; agent < static_cast<int>(page.agents); ++agent)
    for (int leg = 0; leg < kind.legs; leg += 2) {
      const auto at = static_cast<size_t>(shared::legRecord(agent, leg, kind.legs)) * each;
      const float over = 0.2f * static_cast<float>(1 + agent) * static_cast<float>(1 + leg);
      const float half = kind.rig.legs[static_cast<size_t>(leg)].bones[0].coneHalfAngle / 2;
      chain[at] = 0;
      chain[at + 1] = std::tan(std::min(half + over / 2, 1.5f));
    }
  gpu::upload(context, page.chain, chain);
}

// Both controllers that keep limits are judged by them, and the clip, which breaks its own, is not.
TEST_F(FidelityTest, LimitsAreThoseOfJudgedHerds) {
  constexpr uint32_t agents = 4;
  Scene scene = sceneOf(agents, 1, 1, Controller::clip);
  scene.herds[0].goal.kind = Goal::Kind::none;
  scene.herds.resize(3, scene.herds[0]);
  scene.herds[1].controller = Controller::loop;
  scene.herds[2].controller = Controller::adaptive;
  Crowd crowd(device(), rollingGround(), scene,
              {.sleep = true, .rigs = {stiffSpider(), spiderRig(), scaledSpider(1.7f)}});
  const auto asleep = [&] { return crowd.sleeping() == 3 * agents; };
  while (crowd.tick() < 300 && !asleep()) simulate(device(), crowd, 10);
  ASSERT_TRUE(asleep());
  for (const uint32_t h : {1u, 2u}) turnOut(device().context(), implOf(crowd).kindOf(h));

  constexpr uint64_t broken = 7;
  const uint64_t kept = crowd.tick();
  simulate(device(), crowd, broken);
  ASSERT_TRUE(asleep());
  EXPECT_FALSE(crowd.fidelity(0).limitViolation.has_value());
  EXPECT_FALSE(crowd.fidelity(0).limitViolations.has_value());
  double most = 0, beyond = 0;
  for (const uint32_t h : {1u, 2u}) {
    SCOPED_TRACE(h);
    const Rig& rig = crowd.rig(h);
    const std::vector<double> violations = violationsOf(crowd.download(h), rig);
    const std::vector<Fidelity> each = crowd.agentFidelity(h);
    double herdMost = 0, herdBeyond = 0;
    for (size_t agent = 0; agent < agents; ++agent) {
      const auto first = violations.begin() + static_cast<std::ptrdiff_t>(agent * rig.legs.size());
      const auto last = first + static_cast<std::ptrdiff_t>(rig.legs.size());
      const double agentMost = *std::max_element(first, last);
      const auto agentBeyond =
          static_cast<double>(std::count_if(first, last, [](double v) { return v > 1e-4; }));
      expectNear("limitViolation", agentMost, each[agent].limitViolation.value(), kRounding);
      herdMost = std::max(herdMost, agentMost), herdBeyond += agentBeyond;
    }
    expectNear("limitViolation", herdMost, crowd.fidelity(h).limitViolation.value(), kRounding);
    most = std::max(most, herdMost), beyond += herdBeyond;
  }
  const Fidelity total = crowd.fidelity();
  EXPECT_GT(most, 1.5);
  expectNear("limitViolation", most, total.limitViolation.value(), kRounding);
  const double legTicks = 2.0 * agents * 8 * static_cast<double>(kept + broken);
  EXPECT_EQ(beyond, 2.0 * agents * 4);
  expectNear("limitViolations", beyond * broken / legTicks, total.limitViolations.value(), 1e-6);
}

}  // namespace
}  // namespace skitter::test
