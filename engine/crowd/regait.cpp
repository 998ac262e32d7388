#include "crowd/regait.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <utility>

#include "crowd/leg_order.h"
#include "crowd/support.h"
#include "crowd/symmetry.h"
#include "skitter/records.h"

// Lengths are in leg lengths and speeds in leg lengths per second, where nothing else is said.
namespace skitter::crowd {
namespace {

// Places where the body's centre may be: a grid about where it is in the rig.
constexpr double centreStep = 0.05;
constexpr int centreSteps = 6;  // to each side
// How far the centre must be inside the support polygon to count as supported, and how far is enough: from
// there on a centre nearer to the rig's own is worth more.
constexpr double wantedMargin = 0.03, enoughMargin = 0.08;
// Of a length, or of a share of time: candidates that are nearer to each other than this are equally good, so
// that rounding does not choose between the patterns of a symmetric rig.
constexpr double sameWithin = 1e-6;
// With three groups or more, steps are so much shorter: with the rig's own the next group would have a tenth
// of a step to wait for a leg that is late, and then every later one would wait for the one before it.
constexpr double quickness = 0.75;
constexpr int fewGroups = 2, mostGroups = 8;
// Shares of the desired velocity that are tried, the largest first.
constexpr double triedShares[] = {1, 0.9, 0.8, 0.7, 0.6, 0.5};
// So many legs stand while others step, or all but one.
constexpr size_t fewestThatWalk = shared::FEWEST_THAT_WALK;
// Most of the body's height by which it is lowered.
constexpr float lowestShare = 0.3f;

double paceOf(int groups) { return groups > fewGroups ? quickness : 1; }

// Of a walk: its speed, seconds of the slowest leg's step, and of a cycle.
struct Walk {
  double speed, step, cycle;

  double halfWay() const {
    return speed * (cycle - step) / 2;
  }  // of the way that a foot goes while it stands
};
// `slow`: how many times as long as the rig's own that step lasts.
Walk walkOf(const Tuning& tuning, int groups, double slow, double speed) {
  const double fresh = double{tuning.swingStill} / (1 + speed / double{tuning.swingSpeed});
  const double duty =
      std::max(double{tuning.dutyLeast}, double{tuning.dutyStill} - double{tuning.dutyGain} * speed);
  const double cycle = std::min(double{tuning.cycleMax}, fresh / (1 - duty));
  return {speed, slow * fresh,
          std::max(cycle, groups * std::max(1.0, slow) * fresh * double{tuning.windowSlack})};
}

// The group of each leg, by its place around the body.
using Grouping = std::vector<int>;

// Each leg takes the next group, from any leg on and either way round. Groups are counted from that of the
// first leg: the others are the same gait at another time.
std::set<Grouping> groupingsOf(size_t legs, int groups) {
  const auto g = static_cast<size_t>(groups);
  std::set<Grouping> all;
  for (size_t first = 0; first < legs; ++first)
    for (const size_t way : {size_t{1}, legs - 1}) {
      Grouping made(legs);
      for (size_t k = 0; k < legs; ++k) made[(first + k * way) % legs] = static_cast<int>(k % g);
      // The last leg would be of the first one's group, and is beside it.
      if (legs % g == 1 && groups > fewGroups) made[(first + (legs - 1) * way) % legs] = 1;
      const int start = made.front();
      for (int& group : made) group = (group - start + groups) % groups;
      size_t most = 0;
      for (int group = 0; group < groups; ++group)
        most = std::max(most, static_cast<size_t>(std::ranges::count(made, group)));
      if (legs - most >= std::min(fewestThatWalk, legs - 1)) all.insert(std::move(made));
    }
  return all;
}

// While a group is in the air each of the others goes back from half of its way in front of its homes, since
// when it landed. Its support is looked at when the step begins, in its middle and when it ends.
std::vector<std::array<SupportPolygon, 3>> supportsOf(const std::vector<glm::dvec2>& homes,
                                                      const Grouping& grouping, int groups,
                                                      const Walk& walk) {
  const auto feetWithout = [&](int air, double part) {
    std::vector<glm::dvec2> feet;
    for (size_t leg = 0; leg < homes.size(); ++leg) {
      const int before = (air - grouping[leg] + groups) % groups;
      if (before == 0) continue;
      const double stood = before * walk.cycle / groups + (part - 1) * walk.step;
      feet.push_back(homes[leg] + glm::dvec2(0, walk.halfWay() - walk.speed * stood));
    }
    return feet;
  };
  std::vector<std::array<SupportPolygon, 3>> supports;
  for (int air = 0; air < groups; ++air)
    supports.push_back({SupportPolygon(feetWithout(air, 0)), SupportPolygon(feetWithout(air, 0.5)),
                        SupportPolygon(feetWithout(air, 1))});
  return supports;
}

struct Choice {
  Grouping grouping;
  int groups = 0;
  glm::dvec2 centre{0};
  double speed = 0;
  double unstable = std::numeric_limits<double>::infinity();  // share of the time
  double margin = -std::numeric_limits<double>::infinity();   // the least

  bool isStable() const { return unstable <= sameWithin; }
  // The least unstable time, then the fewest groups, a margin that is enough, the smallest shift, the largest
  // margin.
  std::array<double, 5> cost() const {
    return {unstable, static_cast<double>(groups), -std::min(margin, enoughMargin), glm::length(centre),
            -margin};
  }
  bool isBetterThan(const Choice& other) const {
    const std::array<double, 5> ours = cost(), theirs = other.cost();
    for (size_t i = 0; i < ours.size(); ++i)
      if (!(std::abs(ours[i] - theirs[i]) <= sameWithin)) return ours[i] < theirs[i];
    return false;
  }
};

bool isIn(uint32_t mask, size_t leg) { return (mask >> leg & 1u) != 0; }

// The legs that carry, as they lie around the body.
std::vector<size_t> carriersOf(const Rig& rig, uint32_t idle) {
  std::vector<size_t> carriers;
  for (const size_t leg : legsAround(rig))
    if (!isIn(idle, leg)) carriers.push_back(leg);
  return carriers;
}

glm::dvec2 homeOf(const Leg& leg) { return {leg.home.x, leg.home.z}; }

// How much lower the body must be for every leg to reach its home as well as before, or comfortably. Metres.
float loweringFor(const Rig& rig, const Tuning& tuning, const std::vector<size_t>& carriers,
                  const glm::vec2& centre) {
  float lowering = 0;
  for (const size_t l : carriers) {
    const Leg& leg = rig.legs[l];
    const float reach = std::max(tuning.reachComfort * leg.reach, glm::distance(leg.home, leg.root()));
    const glm::vec2 aside = glm::vec2(homeOf(leg)) - centre - glm::vec2(leg.root().x, leg.root().z);
    const float above = leg.root().y - leg.home.y;
    const float most = std::sqrt(std::max(0.0f, reach * reach - glm::dot(aside, aside)));
    lowering = std::max(lowering, above - most);
  }
  return std::min(lowering, lowestShare * rig.bodyHeight);
}

// What share of its reach a leg needs at the ends of its stance. Metres.
double stretchOf(const Leg& leg, const glm::dvec2& centre, double halfWay, double lowering) {
  const glm::dvec2 aside = homeOf(leg) - centre - glm::dvec2(leg.root().x, leg.root().z);
  const double above = double{leg.root().y} - lowering - double{leg.home.y};
  const double ahead = std::abs(aside.y) + halfWay;
  return std::sqrt(aside.x * aside.x + above * above + ahead * ahead) / double{leg.reach};
}

// Looks for the gait of the legs that carry.
class Regrouping {
 public:
  // `carriers` lie around the body in this order; `slowest` is the largest slowness among them.
  Regrouping(const Rig& rig, const Tuning& tuning, const std::vector<size_t>& carriers, double slowest)
      : rig_(rig), tuning_(tuning), carriers_(carriers), slowest_(slowest) {
    for (const size_t l : carriers) homes_.push_back(homeOf(rig.legs[l]) / double{rig.legLength});
    for (int i = -centreSteps; i <= centreSteps; ++i)
      for (int j = -centreSteps; j <= centreSteps; ++j) {
        const glm::dvec2 centre(centreStep * i, centreStep * j);
        centres_.push_back({centre, loweringAt(centre)});
      }
  }

  // The fastest that is stable; if none is, the fastest of which all legs reach the ends of their stances.
  Choice best() const {
    std::optional<Choice> fastest;
    for (const double speed : triedShares) {
      const std::optional<Choice> choice = bestAt(speed, true);
      if (!choice) continue;
      if (choice->isStable()) return *choice;
      if (!fastest) fastest = choice;
    }
    return fastest ? *fastest : *bestAt(*std::rbegin(triedShares), false);
  }
  float loweringAt(const glm::dvec2& centre) const {
    return loweringFor(rig_, tuning_, carriers_, glm::vec2(centre) * rig_.legLength);
  }

 private:
  struct Centre {
    glm::dvec2 place;
    float lowering;  // metres
  };

  std::optional<Choice> bestAt(double speed, bool reaches) const {
    std::optional<Choice> best;
    const std::vector<double> limits = limitsAt(speed);
    for (int groups = fewGroups; groups <= std::min(static_cast<int>(homes_.size()), mostGroups); ++groups) {
      const Walk walk = walkOf(tuning_, groups, slowest_ * paceOf(groups), speed);
      std::vector<glm::dvec2> centres;
      for (const Centre& centre : centres_)
        if (!reaches || canReach(centre, walk, limits)) centres.push_back(centre.place);
      if (centres.empty()) continue;
      for (const Grouping& grouping : groupingsOf(homes_.size(), groups)) {
        const auto supports = supportsOf(homes_, grouping, groups, walk);
        for (const glm::dvec2& centre : centres) {
          Choice choice{.grouping = grouping, .groups = groups, .centre = centre, .speed = speed};
          judge(supports, walk, choice);
          if (!best || choice.isBetterThan(*best)) best = std::move(choice);
        }
      }
    }
    return best;
  }

  static void judge(const std::vector<std::array<SupportPolygon, 3>>& supports, const Walk& walk,
                    Choice& choice) {
    choice.unstable = 0;
    choice.margin = std::numeric_limits<double>::infinity();
    for (const auto& moments : supports) {
      double margin = std::numeric_limits<double>::infinity();
      for (const SupportPolygon& support : moments)
        margin = std::min(margin, support.marginOf(choice.centre));
      if (margin < wantedMargin) choice.unstable += walk.step / walk.cycle;
      choice.margin = std::min(choice.margin, margin);
    }
  }

  // How far each leg may stretch: as far as in the rig's own gait, or as does not slow the body.
  std::vector<double> limitsAt(double speed) const {
    const Walk own = walkOf(tuning_, rig_.groupCount(), 1, speed);
    std::vector<double> limits;
    for (const size_t l : carriers_)
      limits.push_back(std::max(double{tuning_.stretchSlow},
                                stretchOf(rig_.legs[l], {0, 0}, own.halfWay() * double{rig_.legLength}, 0)));
    return limits;
  }
  bool canReach(const Centre& centre, const Walk& walk, const std::vector<double>& limits) const {
    const double length = rig_.legLength;
    for (size_t k = 0; k < carriers_.size(); ++k)
      if (stretchOf(rig_.legs[carriers_[k]], length * centre.place, length * walk.halfWay(),
                    double{centre.lowering}) > limits[k] + sameWithin)
        return false;
    return true;
  }

  const Rig& rig_;
  const Tuning& tuning_;
  const std::vector<size_t>& carriers_;
  double slowest_;
  std::vector<glm::dvec2> homes_;
  std::vector<Centre> centres_;
};

// Every leg that carries must stand while one of another group is in the air: all feet but those of a group
// are on the ground, which is what its stability was found for.
void setNeighbours(const std::vector<size_t>& carriers, Regait& gait) {
  for (const size_t a : carriers)
    for (const size_t b : carriers)
      if (gait.legs[a].group != gait.legs[b].group) gait.legs[a].neighbours |= 1u << b;
}

void regroup(const Rig& rig, const Tuning& tuning, const std::vector<size_t>& carriers, double slowest,
             Regait& gait) {
  const Regrouping regrouping(rig, tuning, carriers, slowest);
  const Choice choice = regrouping.best();
  gait.groups = choice.groups;
  gait.speed = std::min(gait.speed, static_cast<float>(choice.speed));
  gait.worth = gait.speed * static_cast<float>(1 - std::min(choice.unstable, 1.0));
  for (size_t k = 0; k < carriers.size(); ++k) {
    LegTurn& leg = gait.legs[carriers[k]];
    leg.group = choice.grouping[k];
    leg.slowness *= static_cast<float>(paceOf(choice.groups));
  }
  const glm::vec2 centre = glm::vec2(choice.centre) * rig.legLength;
  gait.shift = {-centre.x, regrouping.loweringAt(choice.centre), -centre.y};
}

// On its belly, without a step that it need not make.
void lieDown(const Rig& rig, const std::vector<size_t>& carriers, Regait& gait) {
  gait.groups = std::max(1, static_cast<int>(carriers.size()));
  for (size_t k = 0; k < carriers.size(); ++k) gait.legs[carriers[k]].group = static_cast<int>(k);
  gait.shift = {0, rig.bodyHeight, 0};
  gait.speed = gait.worth = 0;
}

void takeOwnGait(const Rig& rig, Regait& gait) {
  const std::vector<LegOrder> order = legOrder(rig);
  gait.groups = rig.groupCount();
  for (size_t l = 0; l < rig.legs.size(); ++l)
    gait.legs[l] = {.group = rig.legs[l].group,
                    .lag = order[l].lag,
                    .neighbours = order[l].neighbours,
                    .slowness = gait.legs[l].slowness};
}

}  // namespace

std::vector<float> standingShares(const Tuning& tuning, const Regait& gait, uint32_t idle, double wanted) {
  double slowest = 0;
  for (size_t l = 0; l < gait.legs.size(); ++l)
    if (!isIn(idle, l)) slowest = std::max(slowest, double{gait.legs[l].slowness});
  const Walk walk = walkOf(tuning, gait.groups, slowest, double{gait.speed} * wanted);
  std::vector<float> shares;
  for (size_t l = 0; l < gait.legs.size(); ++l) {
    const double step = walk.step * double{gait.legs[l].slowness} / slowest;
    shares.push_back(isIn(idle, l) ? 0.0f : static_cast<float>(1 - step / walk.cycle));
  }
  return shares;
}

float loweringFor(const Rig& rig, const Tuning& tuning, const LegPattern& pattern, const glm::vec2& shift) {
  return loweringFor(rig, tuning, carriersOf(rig, pattern.idle), -shift);
}

Regait regaitByRule(const Rig& rig, const Tuning& tuning, const LegPattern& pattern) {
  const std::vector<size_t> carriers = carriersOf(rig, pattern.idle);
  Regait gait;
  gait.legs.resize(rig.legs.size());
  size_t lame = 0;
  for (const size_t l : carriers)
    if (isIn(pattern.lame, l)) gait.legs[l].slowness = shared::LAME_SLOWNESS, ++lame;
  if (lame > 0) gait.speed = 1 - static_cast<float>(lame) / (2 * static_cast<float>(carriers.size()));
  if (carriers.size() == rig.legs.size()) {
    takeOwnGait(rig, gait);
    return gait;
  }
  if (carriers.size() < fewestThatWalk)
    lieDown(rig, carriers, gait);
  else
    regroup(rig, tuning, carriers, lame > 0 ? double{shared::LAME_SLOWNESS} : 1.0, gait);
  setNeighbours(carriers, gait);
  return gait;
}

namespace {

// Turns between the phases of two legs, the shorter way around the cycle.
float turnsApart(const RigGait& gait, size_t a, size_t b) {
  const float apart = std::abs(gait.turns[a].phase - gait.turns[b].phase);
  return static_cast<float>(gait.groups) * std::min(apart, 1 - apart);
}

const RigGait* gaitWithout(const Rig& rig, uint32_t idle) {
  const auto found = std::ranges::find(rig.gaits, idle, &RigGait::idle);
  return found == rig.gaits.end() ? nullptr : &*found;
}

}  // namespace

Regait regaitOf(const Rig& rig, const RigGait& found, const LegPattern& pattern) {
  Regait gait;
  gait.groups = static_cast<int>(found.groups);
  gait.shift = found.shift * rig.legLength;
  gait.speed = found.speed;
  gait.worth = found.fitness;
  gait.legs.resize(rig.legs.size());
  const std::vector<size_t> carriers = carriersOf(rig, found.idle);
  size_t lame = 0;
  for (size_t k = 0; k < carriers.size(); ++k) {
    const size_t leg = carriers[k];
    LegTurn& turn = gait.legs[leg];
    const float turns = found.turns[leg].phase * static_cast<float>(found.groups);
    turn.group = std::min(static_cast<int>(turns), gait.groups - 1);
    turn.within = turns - static_cast<float>(turn.group);
    turn.slowness = found.turns[leg].slowness;
    if (isIn(pattern.lame, leg)) turn.slowness *= shared::LAME_SLOWNESS, ++lame;
    for (size_t m = 0; m < carriers.size(); ++m) {
      const size_t between = m > k ? m - k : k - m;
      const bool isNext = between == 1 || between + 1 == carriers.size();
      // Legs that begin within half a turn of each other step together.
      const bool waits = turnsApart(found, leg, carriers[m]) >= 0.5f && (isNext || !found.adjacent);
      if (m != k && waits) turn.neighbours |= 1u << carriers[m];
    }
  }
  if (lame > 0) gait.speed *= 1 - static_cast<float>(lame) / (2 * static_cast<float>(carriers.size()));
  return gait;
}

Regait regaitFor(const Rig& rig, const Tuning& tuning, const LegPattern& pattern) {
  if (const RigGait* found = gaitWithout(rig, pattern.idle)) return regaitOf(rig, *found, pattern);
  if (!rig.gaits.empty()) {
    const std::vector<size_t> mirror = mirroredLegs(rig);
    const RigGait* image = mirror.empty() ? nullptr : gaitWithout(rig, mirrored(pattern.idle, mirror));
    if (image != nullptr) return regaitOf(rig, mirrorImage(*image, mirror), pattern);
  }
  return regaitByRule(rig, tuning, pattern);
}

}  // namespace skitter::crowd
