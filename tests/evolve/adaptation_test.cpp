// Trial and error over a map of gaits, on maps that are made up.
#include "evolve/adaptation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <numeric>

#include "base/split_mix.h"

namespace skitter::test {
namespace {

using evolve::Adaptation, evolve::AdaptationOptions, evolve::BehaviourMap;

// The posterior by the textbook: mean and variance from the kernel matrix, solved by Gaussian elimination.
struct Textbook {
  AdaptationOptions options;
  std::vector<std::vector<float>> shares;
  std::vector<double> expected;
  std::vector<size_t> tried;
  std::vector<double> found;

  double kernel(size_t a, size_t b) const {
    double squares = 0;
    for (size_t i = 0; i < shares[a].size(); ++i)
      squares += std::pow(double{shares[a][i]} - double{shares[b][i]}, 2);
    const double d = std::sqrt(squares) / options.lengthScale;
    return std::pow(options.deviation, 2) * (1 + std::sqrt(5.0) * d + 5 * d * d / 3) *
           std::exp(-std::sqrt(5.0) * d);
  }
  std::vector<double> solved(std::vector<double> right) const {
    const size_t n = tried.size();
    std::vector<std::vector<double>> matrix(n, std::vector<double>(n));
    for (size_t i = 0; i < n; ++i)
      for (size_t j = 0; j < n; ++j) matrix[i][j] = kernel(tried[i], tried[j]) + (i == j ? options.noise : 0);
    for (size_t i = 0; i < n; ++i)
      for (size_t j = 0; j < n; ++j) {
        if (j == i) continue;
        const double share = matrix[j][i] / matrix[i][i];
        for (size_t k = 0; k < n; ++k) matrix[j][k] -= share * matrix[i][k];
        right[j] -= share * right[i];
      }
    for (size_t i = 0; i < n; ++i) right[i] /= matrix[i][i];
    return right;
  }
  std::vector<double> rowOf(size_t x) const {
    std::vector<double> row;
    for (const size_t each : tried) row.push_back(kernel(each, x));
    return row;
  }
  double mean(size_t x) const {
    std::vector<double> rest;
    for (size_t i = 0; i < tried.size(); ++i) rest.push_back(found[i] - expected[tried[i]]);
    rest = solved(rest);
    const std::vector<double> row = rowOf(x);
    return expected[x] + std::inner_product(row.begin(), row.end(), rest.begin(), 0.0);
  }
  double variance(size_t x) const {
    const std::vector<double> row = rowOf(x), weights = solved(row);
    return kernel(x, x) - std::inner_product(row.begin(), row.end(), weights.begin(), 0.0);
  }
};

TEST(Adaptation, ThePosteriorIsTheTextbooks) {
  Textbook book;
  BehaviourMap map(3);
  base::SplitMix64 random(1);
  for (int i = 0; i < 40; ++i) {
    book.shares.push_back({});
    for (int leg = 0; leg < 3; ++leg) book.shares.back().push_back(static_cast<float>(random.uniform()));
    const auto expected = static_cast<float>(random.uniform());
    book.expected.push_back(double{expected});
    map.add(book.shares.back(), expected);
  }
  Adaptation search(map, book.options);
  for (const size_t trial : {3u, 17u, 18u, 5u, 30u, 31u}) {
    const double found = random.uniform();
    book.tried.push_back(trial);
    book.found.push_back(found);
    search.tell(static_cast<uint32_t>(trial), found);
    for (uint32_t x = 0; x < 40; ++x) {
      EXPECT_NEAR(search.expected(x), book.mean(x), 1e-9) << x << " after " << book.tried.size();
      EXPECT_NEAR(search.variance(x), book.variance(x), 1e-9) << x << " after " << book.tried.size();
    }
  }
}

TEST(Adaptation, AnIntactCreatureTriesOnce) {
  BehaviourMap map(2);
  for (const float at : {0.0f, 0.5f, 1.0f}) map.add(std::vector{at, at}, at == 0.5f ? 0.9f : 0.4f);
  Adaptation search(map, {});
  EXPECT_FALSE(search.best());
  ASSERT_EQ(search.next(), 1u);
  search.tell(1, 0.88);
  EXPECT_EQ(search.next(), std::nullopt);
  EXPECT_EQ(search.best(), 1u);
  EXPECT_EQ(search.bestFitness(), 0.88);
}

// Half of what the map promised is not good enough, but better than what nothing that is left can be.
TEST(Adaptation, ItEndsWhereNothingThatIsLeftCanBeBetter) {
  BehaviourMap map(1);
  for (const float at : {0.0f, 5.0f}) map.add(std::vector{at}, at == 0 ? 1.0f : 0.1f);
  Adaptation search(map, {.deviation = 0.1, .exploration = 2});
  search.tell(0, 0.5);
  EXPECT_EQ(search.next(), std::nullopt);
  Adaptation hopeful(map, {.deviation = 0.3, .exploration = 2});
  hopeful.tell(0, 0.5);
  EXPECT_EQ(hopeful.next(), 1u);
}

TEST(Adaptation, ItTriesNothingTwiceAndNotForEver) {
  BehaviourMap map(1);
  for (int i = 0; i < 30; ++i) map.add(std::vector{static_cast<float>(i) / 30}, 0.9f);
  Adaptation search(map, {.mostTrials = 12});
  std::vector<uint32_t> tried;
  while (const auto next = search.next()) {
    EXPECT_EQ(std::ranges::count(tried, *next), 0);
    tried.push_back(*next);
    search.tell(*next, 0.0);
  }
  EXPECT_FALSE(tried.empty());
  EXPECT_LE(tried.size(), 12u);
  EXPECT_EQ(search.best(), tried.front());
}

TEST(Adaptation, WithoutAMapThereIsNothingToTry) {
  const BehaviourMap map(4);
  EXPECT_EQ(Adaptation(map, {}).next(), std::nullopt);
}

// A creature of eight legs with a gait for each set of legs that it holds up, and of each several that stand
// for longer or shorter. What it does not know: some legs are gone, and each that a gait counts on takes
// almost half of what is expected. As the paper asks: a gait that has 90 % of what the best one has.
struct MadeUp {
  std::vector<uint32_t> heldUp;
  BehaviourMap map{8};

  MadeUp() {
    base::SplitMix64 random(7);
    for (uint32_t held = 0; held < 256; ++held) {
      const int count = std::popcount(held);
      for (int kind = 0; kind < 6 && count <= 4; ++kind) {
        const double stands = 0.5 + 0.06 * kind;
        std::vector<float> shares;
        for (int leg = 0; leg < 8; ++leg)
          shares.push_back((held >> leg & 1u) != 0 ? 0.0f
                                                   : static_cast<float>(stands + 0.03 * random.uniform()));
        map.add(shares, static_cast<float>(0.95 - 0.08 * count - std::abs(stands - 0.65)));
        heldUp.push_back(held);
      }
    }
  }
  double fitness(uint32_t behaviour, uint32_t lost) const {
    const int missed = std::popcount(lost & ~heldUp[behaviour]);
    return double{map.expected(behaviour)} * std::pow(0.55, missed);
  }
  double best(uint32_t lost) const {
    double most = 0;
    for (uint32_t behaviour = 0; behaviour < map.count(); ++behaviour)
      most = std::max(most, fitness(behaviour, lost));
    return most;
  }
  // Trials up to 90 % of the best; 0 where none of 20 had it.
  uint32_t trialsFor(uint32_t lost,
                     const std::function<std::optional<uint32_t>(const Adaptation&)>& choose) const {
    Adaptation search(map, {.goodEnough = 2});  // it never ends by itself
    for (uint32_t trial = 1; trial <= 20; ++trial) {
      const std::optional<uint32_t> next = choose(search);
      if (!next) break;
      search.tell(*next, fitness(*next, lost));
      if (search.bestFitness() >= 0.9 * best(lost)) return trial;
    }
    return 0;
  }
};

TEST(Adaptation, AHundredCreaturesFindTheirGaitAgain) {
  const MadeUp creature;
  base::SplitMix64 random(11);
  std::vector<uint32_t> trials, blind;
  for (int i = 0; i < 100; ++i) {
    uint32_t lost = 0;
    const int legs = 1 + i % 2;
    while (std::popcount(lost) < legs) lost |= 1u << random() % 8;
    trials.push_back(creature.trialsFor(lost, [](const Adaptation& search) { return search.next(); }));
    blind.push_back(creature.trialsFor(lost, [&](const Adaptation&) {
      return std::optional(static_cast<uint32_t>(random() % creature.map.count()));
    }));
  }
  const auto missed = [](const std::vector<uint32_t>& all) { return std::ranges::count(all, 0u); };
  EXPECT_EQ(missed(trials), 0);
  std::ranges::sort(trials);
  EXPECT_LE(trials[49], 8u);
  // So the check can fail: who tries at random does not find it.
  EXPECT_GT(missed(blind), 20);
}

}  // namespace
}  // namespace skitter::test
