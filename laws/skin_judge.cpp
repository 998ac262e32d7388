#include "laws/skin_judge.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace skitter::laws {
namespace {

constexpr double jerkSeconds = 0.4;
constexpr double leastPath = 0.2;   // leg lengths in a window or a swing: less is shuffling
constexpr double leastSpeed = 0.1;  // leg lengths a second: less is standing
constexpr double startSeconds = 0.75;
constexpr double leastStanding = 0.75;  // seconds
constexpr double turnedBy = 10;         // degrees beyond straight
constexpr uint64_t everyFew = 4;        // ticks from one look at the whole skin to the next

}  // namespace

SkinJudge::SkinJudge(const Creature& creature, const Anatomy& anatomy, Tally& tally, uint32_t agent,
                     double dt)
    : creature_(creature),
      anatomy_(anatomy),
      tally_(tally),
      agent_(agent),
      dt_(dt),
      window_(static_cast<uint32_t>(std::max(4.0, std::round(jerkSeconds / dt)))),
      stances_(anatomy.limbs.size()),
      soles_(anatomy.limbs.size()),
      crossed_(anatomy.pairs.size(), 0) {
  for (const Leg& leg : creature.legs) joints_.emplace_back(leg.size());
  for (const Anatomy::Limb& limb : anatomy.limbs) turned_.emplace_back(limb.knees.size(), false);
}

glm::dvec3 SkinJudge::place(uint32_t vertex) const {
  const SkinVertex& skin = creature_.vertices[vertex];
  glm::dvec3 sum(0);
  for (size_t k = 0; k < skin.bones.size(); ++k)
    if (skin.weights[k] > 0)
      sum += skin.weights[k] * (moment_->bones[skin.bones[k]] * glm::dvec4(skin.rest, 1));
  return sum;
}

glm::dvec3 SkinJudge::place(const LegJoint& joint) const {
  return moment_->bones[joint.bone] * glm::dvec4(joint.rest, 1);
}

void SkinJudge::look(const Moment& moment, const Ground& ground) {
  moment_ = &moment;
  if (moments_ == 0) first_ = moment.tick;
  last_ = moment.tick;
  for (size_t leg = 0; leg < joints_.size(); ++leg)
    for (size_t j = 0; j < joints_[leg].size(); ++j) joints_[leg][j] = place(creature_.legs[leg][j]);
  follow(body_, moment.position);
  if (body_.ticks == window_) endStretch(body_);
  const bool goes = glm::length(body_.differences[0]) > leastSpeed * creature_.legLength * dt_;
  going_ = goes ? going_ + 1 : 0;
  for (size_t leg = 0; leg < anatomy_.limbs.size(); ++leg) {
    if (!carries(leg)) continue;
    look(leg, ground);
    judgeKnees(leg);
  }
  judgeCrossing();
  if (moments_ % everyFew == 0) {
    judgeStretch();
    judgeBody(ground);
  }
  ++moments_;
}

double SkinJudge::heightOf(std::span<const uint32_t> vertices, const Ground& ground) const {
  double least = std::numeric_limits<double>::infinity();
  glm::dvec3 lowest(0);
  for (const uint32_t v : vertices) {
    const glm::dvec3 at = place(v);
    if (const double over = at.y - ground.at(at.x, at.z); over < least) {
      least = over;
      lowest = at;
    }
  }
  return ground.over(lowest);
}

void SkinJudge::look(size_t leg, const Ground& ground) {
  const Anatomy::Limb& limb = anatomy_.limbs[leg];
  if (limb.foot.empty()) return;
  std::vector<glm::dvec3>& sole = sole_;
  sole.clear();
  glm::dvec3 centre(0);
  for (const uint32_t v : limb.sole) {
    sole.push_back(place(v));
    centre += sole.back() / static_cast<double>(limb.sole.size());
  }
  follow(soles_[leg], centre);
  if (moment_->stands.empty()) return;
  Stance& stance = stances_[leg];
  if (!moment_->stands[leg]) {
    if (stance.stands) {
      endStance(stance, moment_->tick, true);
      // A swing is a stretch from the tick of its lift-off on.
      soles_[leg].ticks = 1;
      soles_[leg].path = glm::length(soles_[leg].differences[0]);
      soles_[leg].square = 0;
      stance.swings = true;
    }
    stance.stands = false;
    return;
  }
  // The first steps from rest are steps of another kind.
  if (stance.swings && static_cast<double>(going_) * dt_ > startSeconds) endStretch(soles_[leg]);
  if (!stance.stands) stance = {.wasSeen = moments_ > 0, .stands = true, .begin = sole};
  double slid = 0;
  for (size_t i = 0; i < sole.size(); ++i)
    slid += std::hypot(sole[i].x - stance.begin[i].x, sole[i].z - stance.begin[i].z) /
            static_cast<double>(sole.size());
  stance.slid = std::max(stance.slid, slid);
  stance.heights.push_back(heightOf(limb.foot, ground));
}

void SkinJudge::endStance(Stance& stance, uint64_t tick, bool hasEnded) {
  if (stance.wasSeen) tally_.add(Law::soleSlide, agent_, tick, stance.slid / creature_.legLength);
  // A part of a stance has another middle, unless it is long: then the creature stands still.
  const bool isWhole = stance.wasSeen && hasEnded;
  if (!isWhole && static_cast<double>(stance.heights.size()) * dt_ < leastStanding) return;
  const auto middle = stance.heights.begin() + static_cast<std::ptrdiff_t>(stance.heights.size() / 2);
  std::nth_element(stance.heights.begin(), middle, stance.heights.end());
  tally_.add(Law::soleDepth, agent_, tick, -*middle / creature_.legLength);
  tally_.add(Law::soleAir, agent_, tick, *middle / creature_.legLength);
}

void SkinJudge::follow(Trail& trail, const glm::dvec3& place) {
  std::array<glm::dvec3, 3> now{};
  if (trail.count > 0) now[0] = place - trail.last;
  for (size_t k = 1; k < now.size(); ++k)
    if (trail.count > k) now[k] = now[k - 1] - trail.differences[k - 1];
  trail.differences = now;
  trail.last = place;
  if (++trail.count <= now.size()) return;
  trail.path += glm::length(now[0]);
  trail.square += glm::dot(now[2], now[2]);
  ++trail.ticks;
}

void SkinJudge::endStretch(Trail& trail) const {
  if (trail.path > leastPath * creature_.legLength) {
    trail.sum += std::pow(static_cast<double>(trail.ticks), 5) * trail.square;
    trail.weight += trail.path * trail.path;
  }
  trail.ticks = 0;
  trail.path = trail.square = 0;
}

void SkinJudge::judgeKnees(size_t leg) {
  const std::vector<Anatomy::Knee>& knees = anatomy_.limbs[leg].knees;
  for (size_t k = 0; k < knees.size(); ++k) {
    const size_t j = knees[k].joint;
    const glm::dvec3 &a = joints_[leg][j - 1], &b = joints_[leg][j], &c = joints_[leg][j + 1];
    const glm::dvec3 rest = glm::dmat3(moment_->bones[creature_.legs[leg][j - 1].bone]) * knees[k].axis;
    const double along = glm::dot(b - a, c - b);
    const double bend = glm::degrees(std::atan2(glm::dot(glm::cross(b - a, c - b), rest), along));
    const bool isTurned = bend < -turnedBy;
    if (isTurned && !turned_[leg][k]) {
      if (flips_ == 0) firstFlip_ = moment_->tick;
      ++flips_;
    }
    // On the way back it must come as far, so that a joint that trembles about straight counts once.
    if (isTurned || bend > 0) turned_[leg][k] = isTurned;
  }
}

void SkinJudge::judgeStretch() {
  double most = 0;
  for (const Anatomy::Edge& edge : anatomy_.edges)
    most = std::max(most, glm::length(place(edge.b) - place(edge.a)) - edge.rest);
  tally_.add(Law::stretch, agent_, moment_->tick, most / creature_.legLength);
}

void SkinJudge::judgeBody(const Ground& ground) {
  if (anatomy_.body.empty()) return;
  tally_.add(Law::bodyDepth, agent_, moment_->tick, -heightOf(anatomy_.body, ground) / creature_.legLength);
}

void SkinJudge::judgeCrossing() {
  if (anatomy_.pairs.empty()) return;
  for (size_t p = 0; p < anatomy_.pairs.size(); ++p) {
    const Anatomy::Pair& pair = anatomy_.pairs[p];
    const std::vector<glm::dvec3>&one = joints_[pair.legA], &other = joints_[pair.legB];
    const glm::dvec3 &a = one[pair.boneA], &b = one[pair.boneA + 1], &c = other[pair.boneB],
                     &d = other[pair.boneB + 1];
    const double thick =
        0.5 * (anatomy_.limbs[pair.legA].radii[pair.boneA] + anatomy_.limbs[pair.legB].radii[pair.boneB]);
    // Spheres about both are mostly enough, and cheaper.
    const glm::dvec3 middles = 0.5 * (a + b - c - d);
    const double far = pair.reach + thick;
    const bool crosses = glm::dot(middles, middles) < far * far && carries(pair.legA) && carries(pair.legB) &&
                         distanceOf(a, b, c, d) < thick;
    crossed_[p] = crosses ? crossed_[p] + 1 : 0;
    if (crossed_[p] > crossedMost_) {
      crossedMost_ = crossed_[p];
      crossedAt_ = moment_->tick;
    }
  }
}

void SkinJudge::finish() {
  if (moments_ < 2) return;
  const double seconds = static_cast<double>(moments_) * dt_;
  for (Stance& stance : stances_)
    if (stance.stands) endStance(stance, last_, false);
  bool hasKnees = false;
  for (const Anatomy::Limb& limb : anatomy_.limbs) hasKnees |= !limb.knees.empty();
  if (hasKnees)
    tally_.add(Law::knees, agent_, flips_ > 0 ? firstFlip_ : last_,
               60 * static_cast<double>(flips_) / seconds);
  const auto jerk = [&](double sum, double weight) {
    if (weight > 0) tally_.add(Law::jerk, agent_, first_, sum / weight);
  };
  jerk(body_.sum, body_.weight);
  double sum = 0, weight = 0;
  for (const Trail& sole : soles_) {
    sum += sole.sum;
    weight += sole.weight;
  }
  jerk(sum, weight);
  if (!anatomy_.pairs.empty())
    tally_.add(Law::crossing, agent_, crossedMost_ > 0 ? crossedAt_ : last_,
               static_cast<double>(crossedMost_) * dt_);
}

}  // namespace skitter::laws
