#include "cpu_reference/stages/adapt.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

#include "cpu_reference/stages/measure.h"

namespace skitter::reference {
namespace {

constexpr double settling = 1;       // s
constexpr double trialTime = 4.2;    // s, with the settling
constexpr double leastWish = 0.1;    // leg lengths a second
constexpr double safeMargin = 0.03;  // leg lengths

constexpr double deviation = 0.3;  // of a fitness from what is expected
constexpr double noise = 0.001;
constexpr double farApart = 1.2;  // the kernel's length, in shares
constexpr double exploration = 2;
constexpr double goodEnough = 0.9;
constexpr size_t mostTrials = 20;
constexpr int fewestLegs = 3;
constexpr double lameSlowness = 1.5;

bool has(uint32_t mask, size_t leg) { return (mask >> leg & 1u) != 0; }

uint32_t idleOf(const Hurt& hurt) { return hurt.lost | hurt.stuck; }

using Rows = std::vector<std::vector<double>>;

// By Gauss-Jordan elimination. `matrix` is positive definite.
Rows inverted(Rows matrix) {
  const size_t n = matrix.size();
  Rows inverse(n, std::vector<double>(n));
  for (size_t i = 0; i < n; ++i) inverse[i][i] = 1;
  for (size_t pivot = 0; pivot < n; ++pivot) {
    const double scale = 1 / matrix[pivot][pivot];
    for (size_t j = 0; j < n; ++j) {
      matrix[pivot][j] *= scale;
      inverse[pivot][j] *= scale;
    }
    for (size_t i = 0; i < n; ++i) {
      if (i == pivot) continue;
      const double factor = matrix[i][pivot];
      for (size_t j = 0; j < n; ++j) {
        matrix[i][j] -= factor * matrix[pivot][j];
        inverse[i][j] -= factor * inverse[pivot][j];
      }
    }
  }
  return inverse;
}

double dotOf(const std::vector<double>& a, const std::vector<double>& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

std::vector<double> times(const Rows& matrix, const std::vector<double>& vector) {
  std::vector<double> result;
  for (const std::vector<double>& row : matrix) result.push_back(dotOf(row, vector));
  return result;
}

double sumOfSizes(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += std::abs(value);
  return sum;
}

// One tick of one agent.
class Adapting {
 public:
  Adapting(const Tuning& tuning, const GaitMap& map, const Search& before, AdaptFlips flips)
      : tuning_(tuning), map_(map), flips_(flips) {
    result_.search = before;
    result_.margins.fill(std::numeric_limits<double>::infinity());
  }

  void notice(uint32_t idle, uint32_t lame, size_t legs) {
    result_.search = Search{};
    result_.search.idle = idle;
    result_.search.lame = lame;
    const int left = static_cast<int>(legs) - std::popcount(idle);
    if ((idle | lame) != 0 && left >= fewestLegs) choose();
  }

  void tryOn(const Hurt& hurt, const AgentBody& body, std::span<const Foot> feet,
             std::span<const Chain> chains, const glm::dvec2& velocity) {
    Search& search = result_.search;
    const double wish = glm::length(velocity), dt = tuning_.dt;
    if (search.does != Searching::searches ||
        !decide(AdaptDecision::wants, wish - leastWish * tuning_.legLength))
      return;
    result_.tries = true;
    search.clock += dt;
    if (decide(AdaptDecision::counts, search.clock - settling - dt / 2)) {
      search.wanted += lameShare(hurt) * wish * dt;
      search.progress += body.speed * glm::dot(body.heading, velocity / wish) * dt;
      if (isUnstable(body, feet, chains)) search.unstable += dt;
    }
    result_.ticked = search;
    if (decide(AdaptDecision::ends, search.clock - trialTime + dt / 2)) end();
  }

  AdaptResult result(const Hurt& hurt) {
    const Search& search = result_.search;
    result_.hurt =
        search.does == Searching::atEase ? hurt : hurtWith(map_.candidates[search.candidate], hurt);
    return result_;
  }

 private:
  bool decide(AdaptDecision decision, double above) {
    const auto d = static_cast<size_t>(decision);
    result_.margins[d] = std::abs(above);
    // At the threshold itself an agent wants to move and a trial ends, but no tick counts or is unstable.
    const bool isOpen = decision == AdaptDecision::counts || decision == AdaptDecision::isUnstable;
    return (isOpen ? above > 0 : above >= 0) != ((flips_ >> d & 1u) != 0);
  }

  bool isUnstable(const AgentBody& body, std::span<const Foot> feet, std::span<const Chain> chains) {
    const std::vector<glm::dvec2> support = plantedTips(result_.search.idle, feet, chains);
    if (support.empty()) return true;
    const glm::dvec3 centre = body.orientation * glm::dvec3(0, tuning_.bodyHeight, 0);
    return decide(AdaptDecision::isUnstable,
                  safeMargin * tuning_.legLength - stabilityMargin(support, {centre.x, centre.z}));
  }

  void end() {
    Search& search = result_.search;
    search.trials.push_back({search.candidate, fitnessOf(search)});
    search.clock = search.wanted = search.progress = search.unstable = 0;
    result_.ended = true;
    choose();
  }

  void choose() {
    result_.search = chosen(map_, result_.search);
    result_.chose = true;
  }

  const Tuning& tuning_;
  const GaitMap& map_;
  AdaptFlips flips_;
  AdaptResult result_;
};

}  // namespace

double GaitMap::mostExpected() const {
  double most = 0;
  for (const GaitCandidate& candidate : candidates) most = std::max(most, candidate.expected);
  return most;
}

double gaitKernel(const GaitCandidate& x, const GaitCandidate& y) {
  double square = 0;
  for (size_t l = 0; l < x.shares.size(); ++l) square += std::pow(x.shares[l] - y.shares[l], 2);
  const double r = std::sqrt(5 * square) / farApart;
  return deviation * deviation * (1 + r + r * r / 3) * std::exp(-r);
}

double Expectation::bound() const { return mean + exploration * std::sqrt(variance); }

Outlook outlookOf(const GaitMap& map, std::span<const Tried> trials) {
  const auto triedOf = [&](size_t i) -> const GaitCandidate& { return map.candidates[trials[i].candidate]; };
  const size_t n = trials.size();
  Outlook outlook;
  outlook.trials = n;
  Rows covariance(n, std::vector<double>(n));
  std::vector<double> surprises;
  std::vector<bool> isTried(map.candidates.size());
  for (size_t i = 0; i < n; ++i) {
    for (size_t j = 0; j < n; ++j) covariance[i][j] = gaitKernel(triedOf(i), triedOf(j));
    covariance[i][i] += noise;
    surprises.push_back(trials[i].fitness - triedOf(i).expected);
    outlook.mostSurprise = std::max(outlook.mostSurprise, std::abs(surprises.back()));
    isTried[trials[i].candidate] = true;
  }
  const Rows inverse = inverted(covariance);
  const std::vector<double> corrections = times(inverse, surprises);
  outlook.corrections = sumOfSizes(corrections);
  outlook.surprise = std::max(0.0, dotOf(surprises, corrections));
  for (size_t c = 0; c < map.candidates.size(); ++c) {
    if (isTried[c]) continue;
    const GaitCandidate& x = map.candidates[c];
    std::vector<double> shared;
    for (size_t i = 0; i < n; ++i) shared.push_back(gaitKernel(triedOf(i), x));
    const std::vector<double> weights = times(inverse, shared);
    const double explained = dotOf(shared, weights);
    outlook.untried.push_back({.candidate = c,
                               .mean = x.expected + dotOf(shared, corrections),
                               .variance = std::max(0.0, gaitKernel(x, x) - explained),
                               .weights = sumOfSizes(weights),
                               .explained = std::max(0.0, explained)});
  }
  return outlook;
}

const Tried& bestOf(std::span<const Tried> trials) {
  const Tried* best = &trials.front();
  for (const Tried& tried : trials)
    if (tried.fitness > best->fitness) best = &tried;
  return *best;
}

Choice chooseGait(const GaitMap& map, std::span<const Tried> trials, const Outlook& outlook) {
  const Expectation* most = nullptr;
  for (const Expectation& each : outlook.untried)
    if (most == nullptr || each.bound() > most->bound()) most = &each;
  if (trials.empty()) return {false, most->candidate};
  const Tried& best = bestOf(trials);
  const bool ends = trials.size() >= mostTrials || best.fitness >= goodEnough * map.mostExpected() ||
                    most == nullptr || best.fitness >= most->bound();
  return ends ? Choice{true, best.candidate} : Choice{false, most->candidate};
}

Search chosen(const GaitMap& map, const Search& search) {
  Search next = search;
  const Choice choice = chooseGait(map, next.trials, outlookOf(map, next.trials));
  if (!next.trials.empty()) {
    const Tried& best = bestOf(next.trials);
    next.bestCandidate = static_cast<uint32_t>(best.candidate);
    next.bestFitness = best.fitness;
  }
  next.does = choice.settles ? Searching::settled : Searching::searches;
  next.candidate = static_cast<uint32_t>(choice.candidate);
  return next;
}

double fitnessOf(const Search& search) {
  const double steady = 1 - std::clamp(search.unstable / (search.clock - settling), 0.0, 1.0);
  return std::clamp(search.progress / search.wanted, 0.0, 1.0) * steady;
}

double lameShare(const Hurt& hurt) {
  const uint32_t idle = idleOf(hurt);
  const auto legs = static_cast<double>(hurt.legs.size()) - std::popcount(idle);
  return 1 - std::popcount(hurt.lame & ~idle) / (2 * legs);
}

Hurt hurtWith(const GaitCandidate& gait, const Hurt& hurt) {
  Hurt next = hurt;
  next.groups = gait.groups;
  next.shift = gait.shift;
  next.speed = lameShare(hurt) * gait.speed;
  for (size_t l = 0; l < next.legs.size(); ++l) {
    const size_t lostFrom = next.legs[l].lostFrom;
    next.legs[l] = gait.legs[l];
    next.legs[l].lostFrom = lostFrom;
    if (has(hurt.lame & ~idleOf(hurt), l)) next.legs[l].slowness *= lameSlowness;
  }
  return next;
}

AdaptResult adapt(const Tuning& tuning, const GaitMap& map, const Search& before, const Hurt& hurt,
                  const AgentBody& body, std::span<const Foot> feet, std::span<const Chain> chains,
                  const glm::dvec2& velocity, AdaptFlips flips) {
  Adapting adapting(tuning, map, before, flips);
  const uint32_t idle = idleOf(hurt);
  if (idle != before.idle || hurt.lame != before.lame)
    adapting.notice(idle, hurt.lame, hurt.legs.size());
  else
    adapting.tryOn(hurt, body, feet, chains, velocity);
  return adapting.result(hurt);
}

std::vector<glm::dvec2> plantedTips(uint32_t idle, std::span<const Foot> feet,
                                    std::span<const Chain> chains) {
  std::vector<glm::dvec2> tips;
  for (size_t l = 0; l < feet.size(); ++l)
    if (!has(idle, l) && feet[l].progress >= 1) tips.emplace_back(chains[l].tip.x, chains[l].tip.z);
  return tips;
}

}  // namespace skitter::reference
