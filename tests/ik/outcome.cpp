#include "ik/outcome.h"

#include <algorithm>
#include <cmath>

#include "cpu_reference/rotation.h"
#include "ik/solved.h"
#include "skitter/device.h"
#include "validation/convert_ik.h"

namespace skitter::test {
namespace {

constexpr double step = 0.02, arrived = 1e-3;

std::vector<glm::vec3> scaled(const std::vector<glm::dvec3>& targets, double by) {
  std::vector<glm::vec3> all;
  for (const glm::dvec3& target : targets) all.emplace_back(by * target);
  return all;
}

// Gathers judged poses.
class Tally {
 public:
  explicit Tally(const ik::Chain& chain) : judge_(validation::judgeOf(chain)) {}

  void add(const Solved& solved, const std::vector<glm::vec3>& targets) {
    for (size_t c = 0; c < targets.size(); ++c) {
      const auto verdict = judge(judge_, solved, c, targets[c]);
      ++poses_;
      solved_ += verdict.tipError <= arrived;
      iterations_ += solved.report[c].iterations;
      outcome_.violation = std::max(outcome_.violation, verdict.limitViolation);
      outcome_.boneError = std::max(outcome_.boneError, verdict.boneLengthError);
    }
  }
  void moved(const Solved& before, const Solved& after, const std::vector<glm::vec3>& from,
             const std::vector<glm::vec3>& to) {
    for (size_t c = 0; c < to.size(); ++c) {
      double farthest = 0;
      for (size_t j = 0; j < after.joints; ++j)
        farthest = std::max<double>(farthest, glm::length(after.chain(c)[j] - before.chain(c)[j]));
      ratios_.push_back(farthest / std::max<double>(glm::length(to[c] - from[c]), 1e-6));
    }
  }
  Outcome outcome() {
    outcome_.solved = static_cast<double>(solved_) / static_cast<double>(poses_);
    outcome_.meanIterations = static_cast<double>(iterations_) / static_cast<double>(poses_);
    std::sort(ratios_.begin(), ratios_.end());
    if (!ratios_.empty()) outcome_.p99Ratio = ratios_[ratios_.size() * 99 / 100];
    return outcome_;
  }

 private:
  validation::IkJudge judge_;
  Outcome outcome_;
  size_t poses_ = 0, solved_ = 0, iterations_ = 0;
  std::vector<double> ratios_;
};

// A legal pose on its way to another one, its tip a step at a time.
class Walk {
 public:
  Walk(const reference::IkChain& chain, Random& random) : chain_(chain), random_(random) {
    pose_ = randomState(chain, random).pose;
    choose();
  }

  reference::IkState state() const { return reference::stateAt(chain_, between(share_)); }
  glm::dvec3 tip() const { return tipAt(share_); }

  void advance() {
    const glm::dvec3 old = tip();
    while (glm::length(tipAt(1) - old) <= step) choose();
    double low = share_, high = share_;
    while (glm::length(tipAt(high) - old) < step) {
      low = high;
      high = std::min(high + 1.0 / 64, 1.0);
    }
    for (int halving = 0; halving < 12; ++halving) {
      const double middle = (low + high) / 2;
      (glm::length(tipAt(middle) - old) < step ? low : high) = middle;
    }
    share_ = high;
  }

 private:
  void choose() {
    pose_ = between(share_);
    goal_ = randomState(chain_, random_).pose;
    share_ = 0;
  }
  reference::Pose between(double share) const {
    reference::Pose pose = pose_;
    for (size_t i = 0; i < pose.swing.size() && !goal_.swing.empty(); ++i) {
      pose.swing[i] = glm::mix(pose_.swing[i], goal_.swing[i], share);
      pose.twist[i] = glm::mix(pose_.twist[i], goal_.twist[i], share);
    }
    return pose;
  }
  glm::dvec3 tipAt(double share) const { return reference::stateAt(chain_, between(share)).joints.back(); }

  const reference::IkChain& chain_;
  Random& random_;
  reference::Pose pose_, goal_;
  double share_ = 0;
};

std::vector<glm::vec3> atTick(const std::vector<Path>& paths, size_t tick, double by) {
  std::vector<glm::vec3> targets;
  for (const Path& path : paths) targets.emplace_back(by * path.targets[tick]);
  return targets;
}

std::vector<glm::vec4> startsOf(const ik::Chain& chain, ik::Solver solver, const std::vector<Path>& paths) {
  const reference::IkChain expected = validation::referenceOf(chain);
  const validation::IkLayout layout(expected, validation::referenceOf(solver));
  std::vector<glm::vec4> states;
  for (const Path& path : paths) validation::append(expected, layout, path.start, states);
  return states;
}

}  // namespace

Outcome solveCold(Device& device, const ik::Chain& chain, const ik::Options& options,
                  const std::vector<glm::dvec3>& targets) {
  const std::vector<glm::vec3> all = scaled(targets, chain.reach());
  Tally tally(chain);
  tally.add(solve(device, chain, options, all), all);
  return tally.outcome();
}

Outcome follow(Device& device, const ik::Chain& chain, ik::Options options, const std::vector<Path>& paths) {
  constexpr int settling = 100;
  options.start = ik::Start::previous;
  ik::Batch batch(device, chain, static_cast<uint32_t>(paths.size()), options);
  std::vector<glm::vec3> targets = atTick(paths, 0, chain.reach());
  batch.setTargets(targets);
  if (!paths[0].start.pose.swing.empty()) batch.setStates(startsOf(chain, batch.solver(), paths));
  for (int solve = 0; solve < settling; ++solve) batch.solve();
  Tally tally(chain);
  Solved before = resultOf(batch);
  for (size_t tick = 1; tick < paths[0].targets.size(); ++tick) {
    const std::vector<glm::vec3> next = atTick(paths, tick, chain.reach());
    batch.setTargets(next);
    batch.solve();
    const Solved after = resultOf(batch);
    tally.add(after, next);
    tally.moved(before, after, targets, next);
    targets = next;
    before = after;
  }
  return tally.outcome();
}

std::vector<glm::dvec3> shellTargets(double least, double most, size_t count, Random& random) {
  std::vector<glm::dvec3> targets;
  while (targets.size() < count) targets.push_back(uniform(random, least, most) * randomDirection(random));
  return targets;
}

std::vector<glm::dvec3> legalTargets(const ik::Chain& chain, size_t count, Random& random) {
  const reference::IkChain expected = validation::referenceOf(chain);
  std::vector<glm::dvec3> targets;
  while (targets.size() < count) targets.push_back(legalTarget(expected, random));
  return targets;
}

std::vector<Path> wanderingPaths(size_t count, size_t ticks, Random& random) {
  std::vector<Path> paths;
  for (const glm::dvec3& first : shellTargets(0.2, 0.95, count, random)) {
    std::vector<glm::dvec3> path = {first};
    while (path.size() < ticks) {
      const glm::dvec3 next = path.back() + step * randomDirection(random);
      if (glm::length(next) >= 0.2 && glm::length(next) <= 0.95) path.push_back(next);
    }
    paths.push_back({path, {}});
  }
  return paths;
}

std::vector<Path> legalPaths(const ik::Chain& chain, size_t count, size_t ticks, Random& random) {
  const reference::IkChain expected = validation::referenceOf(chain);
  std::vector<Path> paths;
  for (size_t c = 0; c < count; ++c) {
    Walk walk(expected, random);
    Path path{{}, walk.state()};
    for (size_t tick = 0; tick < ticks; ++tick, walk.advance()) path.targets.push_back(walk.tip());
    paths.push_back(path);
  }
  return paths;
}

std::vector<Path> circlesBeyondReach(const ik::Chain& chain, size_t count, size_t ticks, Random& random) {
  constexpr double radius = 0.2, away = 1.4;
  std::vector<Path> paths;
  for (const glm::dvec3& tip : legalTargets(chain, count, random)) {
    const glm::dvec3 line = glm::normalize(tip);
    const glm::dvec3 x = reference::perpendicular(randomDirection(random), line), y = glm::cross(line, x);
    Path path;
    for (size_t tick = 0; tick < ticks; ++tick) {
      const double angle = step / radius * static_cast<double>(tick);
      path.targets.push_back(away * line + radius * (std::cos(angle) * x + std::sin(angle) * y));
    }
    paths.push_back(path);
  }
  return paths;
}

}  // namespace skitter::test
