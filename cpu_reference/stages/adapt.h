#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "cpu_reference/stages/hurt.h"
#include "cpu_reference/types.h"

// Trial and error of an agent that is hurt (docs/stages/adapt.md). Fitnesses are shares.
namespace skitter::reference {

// A gait of the map.
struct GaitCandidate {
  int groups = 1;
  glm::dvec3 shift{0};                // of the homes, model space
  double speed = 1;                   // sigma
  double expected = 0;                // f
  std::vector<Hurt::Turn> legs = {};  // without what they have lost
  std::vector<double> shares = {};    // s_l
};

struct GaitMap {
  std::vector<GaitCandidate> candidates;

  double mostExpected() const;
};

struct Tried {
  size_t candidate = 0;
  double fitness = 0;
};

enum class Searching { atEase, searches, settled };

// The record of an agent.
struct Search {
  SKITTER_SEARCH_FIELDS(REFERENCE_MEMBER)
  Searching does = Searching::atEase;
  std::vector<Tried> trials;
};

// k(x, y)
double gaitKernel(const GaitCandidate& x, const GaitCandidate& y);

// A candidate as the trials let it be expected, with K = k(X, X) + 0.001 I.
struct Expectation {
  size_t candidate = 0;
  double mean = 0, variance = 0;
  double weights = 0;    // sum of |K^-1 k(X, x)|
  double explained = 0;  // k(x, X) K^-1 k(X, x)

  double bound() const;
};

// All candidates that were not tried, in the map's order. The sums are for tolerances.
struct Outlook {
  size_t trials = 0;
  std::vector<Expectation> untried;
  double corrections = 0;   // sum of |K^-1 (y - f(X))|
  double surprise = 0;      // (y - f(X)) K^-1 (y - f(X))
  double mostSurprise = 0;  // the greatest |y - f(X)|
};
Outlook outlookOf(const GaitMap& map, std::span<const Tried> trials);

// How a search goes on.
struct Choice {
  bool settles = false;
  size_t candidate = 0;

  bool operator==(const Choice&) const = default;
};
Choice chooseGait(const GaitMap& map, std::span<const Tried> trials, const Outlook& outlook);

// The trial with the highest fitness, of equal ones the first. There is at least one.
const Tried& bestOf(std::span<const Tried> trials);

// The record after a choice: its best trial, what it does and its candidate.
Search chosen(const GaitMap& map, const Search& search);

// y of a trial that ends.
double fitnessOf(const Search& search);

// 1 - j / (2 m): the share of the speed that is left with such lame legs.
double lameShare(const Hurt& hurt);

// Such damage with that gait, which is slower for lame legs.
Hurt hurtWith(const GaitCandidate& gait, const Hurt& hurt);

// Adapt decides each of these by a number that is above a threshold or not; its unit stands beside it.
enum class AdaptDecision {
  wants,       // metres a second
  counts,      // seconds
  isUnstable,  // metres
  ends,        // seconds
};
inline constexpr size_t adaptDecisions = static_cast<size_t>(AdaptDecision::ends) + 1;
// Bit d: decision d falls the other way than the rule has it, to recompute the other side of a tie.
using AdaptFlips = uint32_t;

struct AdaptResult {
  Search search;
  Search ticked;  // the same before its trial ended
  Hurt hurt;      // with its gait, where it searches or is settled
  bool tries = false, ended = false, chose = false;
  // How far each was from falling the other way; infinite where it was not asked for.
  std::array<double, adaptDecisions> margins;
};

// `body`, `feet` and `chains` are of the last tick, `velocity` is this tick's, `hurt` as the host has it.
AdaptResult adapt(const Tuning& tuning, const GaitMap& map, const Search& before, const Hurt& hurt,
                  const AgentBody& body, std::span<const Foot> feet, std::span<const Chain> chains,
                  const glm::dvec2& velocity, AdaptFlips flips = 0);

// The tips that are planted and not of idle legs, x and z.
std::vector<glm::dvec2> plantedTips(uint32_t idle, std::span<const Foot> feet, std::span<const Chain> chains);

}  // namespace skitter::reference
