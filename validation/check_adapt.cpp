#include <algorithm>
#include <cmath>
#include <vector>

#include "cpu_reference/stages/adapt.h"
#include "cpu_reference/stages/tolerances.h"
#include "skitter/error.h"
#include "skitter/records.h"
#include "validation/checks.h"
#include "validation/convert.h"
#include "validation/fields.h"

namespace skitter::validation {
namespace {

namespace tolerance = reference::tolerance;
using reference::AdaptDecision, reference::Choice, reference::Expectation, reference::GaitMap,
    reference::Outlook, reference::Search, reference::Searching, reference::Tried;

// The least and the most that a device may have computed as a candidate's bound.
struct Range {
  double least, most;
};
Range rangeOf(const Outlook& outlook, const Expectation& x) {
  const double error = tolerance::gaitBound(outlook, x);
  return {x.bound() - error, x.bound() + error};
}

// Whether an earlier candidate has the same numbers. A device computes the same bound for both, and must take
// the earlier one.
bool hasEarlierTwin(const GaitMap& map, const Outlook& outlook, size_t candidate) {
  const reference::GaitCandidate& own = map.candidates[candidate];
  return std::ranges::any_of(outlook.untried, [&](const Expectation& x) {
    const reference::GaitCandidate& other = map.candidates[x.candidate];
    return x.candidate < candidate && other.expected == own.expected &&
           (outlook.trials == 0 || other.shares == own.shares);
  });
}

// Whether roundings may have led the device to that choice. Its trials are exact.
bool isWithinRounding(const GaitMap& map, const std::vector<Tried>& trials, const Outlook& outlook,
                      const Choice& choice) {
  const bool hasTried = !trials.empty();
  const double best = hasTried ? reference::bestOf(trials).fitness : 0;
  const double good = 0.9 * map.mostExpected(), close = tolerance::goodGait(map.mostExpected());
  double highest = -INFINITY;  // the least that the highest bound may be
  for (const Expectation& x : outlook.untried) highest = std::max(highest, rangeOf(outlook, x).least);
  if (choice.settles)
    return hasTried && choice.candidate == reference::bestOf(trials).candidate &&
           (best >= good - close || best >= highest);
  const auto of = std::ranges::find(outlook.untried, choice.candidate, &Expectation::candidate);
  if (of == outlook.untried.end() || trials.size() >= size_t{shared::SEARCH_MOST_TRIALS}) return false;
  const double most = rangeOf(outlook, *of).most;
  return most >= highest && !hasEarlierTwin(map, outlook, choice.candidate) &&
         (!hasTried || (best < good + close && best < most));
}

// An agent at the tick, as both have it.
class AdaptComparison {
 public:
  AdaptComparison(const Setting& setting, const Moment& moment)
      : setting_(setting),
        moment_(moment),
        before_(searchOf(moment.before, moment.agent)),
        got_(searchOf(moment.after, moment.agent)),
        hurt_(hurtOf(moment.after, moment.agent, setting.legs)),
        body_(bodyOf(moment.before, moment.agent)),
        velocity_(velocityOf(moment.after, moment.agent)) {
    const auto legs = static_cast<size_t>(setting.legs);
    for (size_t l = moment.agent * legs; l < (moment.agent + 1) * legs; ++l) {
      feet_.push_back(footOf(moment.before, l));
      chains_.push_back(chainOf(moment.before, l, setting.bones));
    }
  }

  void judge(Judge& judge) {
    if (!isOfMap(before_)) {
      Sample sample;
      sample.same("candidates that the map has not", 0, 1);
      return judge.add(moment_.n, moment_.number(), -1, sample);
    }
    if (follow(0, 0, judge)) return;
    judge.add(moment_.n, moment_.number(), -1, first_);
  }

 private:
  bool isOfMap(const Search& search) const {
    const size_t all = setting_.gaitMap.candidates.size();
    return search.candidate < all && search.bestCandidate < all &&
           std::ranges::all_of(search.trials, [&](const Tried& trial) { return trial.candidate < all; });
  }

  // Compares with the decisions in `flips` turned, then with close ones from `next` on turned as well.
  // Whether some combination passes.
  bool follow(reference::AdaptFlips flips, size_t next, Judge& judge) {
    const reference::AdaptResult result = reference::adapt(setting_.tuning, setting_.gaitMap, before_, hurt_,
                                                           body_, feet_, chains_, velocity_, flips);
    const tolerance::AdaptBounds bounds =
        result.tries
            ? tolerance::adapt(setting_.tuning, body_, velocity_,
                               reference::plantedTips(before_.idle, feet_, chains_), before_, result.ticked)
            : tolerance::AdaptBounds{};
    bool isTie = flips != 0;
    const Sample sample = compare(result, bounds, isTie);
    if (flips == 0) first_ = sample;
    if (sample.passes()) {
      judge.add(moment_.n, moment_.number(), -1, sample, isTie);
      return true;
    }
    for (size_t d = next; d < reference::adaptDecisions; ++d)
      if (result.margins[d] <= boundOf(static_cast<AdaptDecision>(d), bounds) &&
          follow(flips | 1u << d, d + 1, judge))
        return true;
    return false;
  }

  // How far the number behind a decision may be off. `bounds` are zeros without a tick of a trial, where only
  // the first decision is asked for.
  double boundOf(AdaptDecision decision, const tolerance::AdaptBounds& bounds) const {
    switch (decision) {
      case AdaptDecision::wants:
        return tolerance::adaptWish(glm::length(velocity_));
      case AdaptDecision::isUnstable:
        return bounds.margin;
      case AdaptDecision::counts:
      case AdaptDecision::ends:
        return bounds.clock;
    }
    return 0;
  }

  Sample compare(const reference::AdaptResult& result, const tolerance::AdaptBounds& bounds, bool& isTie) {
    Sample sample;
    sample.finite("search", records(moment_.after.search, moment_.agent, shared::SEARCH_STRIDE));
    sample.finite("hurt", records(moment_.after.hurt, moment_.agent, shared::hurtStride(setting_.legs)));
    compareTrials(result, bounds, sample);
    Search expected = result.search;
    if (result.chose && sample.passes()) isTie = followChoice(expected) || isTie;
    sample.same("what it does", static_cast<double>(expected.does), static_cast<double>(got_.does));
    compareFields(expected, got_, sample);
    const auto scalar = [&](const char* quantity, double Search::*member, double bound) {
      const double want = expected.*member, found = got_.*member;
      sample.compare(quantity, std::abs(want - found), result.ended ? 0 : bound, {want, 0, 0, 0},
                     {found, 0, 0, 0});
    };
    scalar("seconds of the trial", &Search::clock, bounds.clock);
    scalar("wanted way, m", &Search::wanted, bounds.wanted);
    scalar("progress, m", &Search::progress, bounds.progress);
    scalar("seconds without a safe support", &Search::unstable, bounds.unstable);
    if (expected.does != Searching::atEase)
      compareGait(reference::hurtWith(setting_.gaitMap.candidates[expected.candidate], hurt_), sample);
    return sample;
  }

  void compareTrials(const reference::AdaptResult& result, const tolerance::AdaptBounds& bounds,
                     Sample& sample) const {
    const std::vector<Tried>& expected = result.search.trials;
    const auto record = records(moment_.after.search, moment_.agent, shared::SEARCH_STRIDE);
    sample.same("an unused number", 0, double{record[11]});
    const auto trials = record.subspan(4 * size_t{shared::SEARCH_TRIALS});
    sample.same("trials", static_cast<double>(expected.size()), double{record[3]});
    for (size_t i = 0; i < size_t{shared::SEARCH_MOST_TRIALS}; ++i) {
      const Tried want = i < expected.size() ? expected[i] : Tried{};
      const double found = trials[2 * i + 1];
      const bool isNew = result.ended && i + 1 == expected.size();
      sample.same("candidate of a trial", static_cast<double>(want.candidate), double{trials[2 * i]});
      sample.compare("fitness of a trial", std::abs(want.fitness - found), isNew ? bounds.fitness : 0,
                     {want.fitness, 0, 0, 0}, {found, 0, 0, 0});
    }
  }

  // Chooses by the device's own trials. Where roundings may have led the device to another choice, follows
  // that one and returns true.
  bool followChoice(Search& expected) const {
    const GaitMap& map = setting_.gaitMap;
    expected.trials = got_.trials;
    expected = reference::chosen(map, expected);
    const Choice own{expected.does == Searching::settled, expected.candidate};
    const Choice theirs{got_.does == Searching::settled, got_.candidate};
    if (got_.does == Searching::atEase || own == theirs) return false;
    const Outlook outlook = reference::outlookOf(map, expected.trials);
    if (!isWithinRounding(map, expected.trials, outlook, theirs)) return false;
    expected.does = got_.does;
    expected.candidate = got_.candidate;
    return true;
  }

  void compareGait(const reference::Hurt& expected, Sample& sample) const {
    const reference::Hurt& got = hurt_;
    sample.same("groups", expected.groups, got.groups);
    sample.compare("shift of the homes", glm::length(expected.shift - got.shift), 0, {expected.shift, 0},
                   {got.shift, 0});
    sample.compare("share of the velocity", std::abs(expected.speed - got.speed),
                   hurt_.lame != 0 ? tolerance::lameSpeed : 0, {expected.speed, 0, 0, 0},
                   {got.speed, 0, 0, 0});
    for (size_t l = 0; l < expected.legs.size(); ++l) {
      const reference::Hurt::Turn &want = expected.legs[l], &found = got.legs[l];
      sample.same("group of a leg", want.group, found.group);
      sample.same("lag of a leg", want.lag, found.lag);
      sample.same("neighbours of a leg", want.neighbours, found.neighbours);
      const bool isLame = (hurt_.lame >> l & 1u) != 0;
      sample.compare("slowness of a leg", std::abs(want.slowness - found.slowness),
                     isLame ? tolerance::lameSlowness(want.slowness) : 0, {want.slowness, 0, 0, 0},
                     {found.slowness, 0, 0, 0});
    }
  }

  const Setting& setting_;
  const Moment& moment_;
  Search before_, got_;
  reference::Hurt hurt_;  // as the device leaves it
  reference::AgentBody body_;
  glm::dvec2 velocity_;
  std::vector<reference::Foot> feet_;
  std::vector<reference::Chain> chains_;
  Sample first_;
};

}  // namespace

void checkAdapt(const Setting& setting, const Moment& moment, Judge& judge) {
  if (moment.before.foot.empty() || moment.before.tip.empty() || moment.after.hurt.empty())
    throw inputError("replay: found no foot, tip or hurt records, which adapt reads");
  AdaptComparison(setting, moment).judge(judge);
}

}  // namespace skitter::validation
