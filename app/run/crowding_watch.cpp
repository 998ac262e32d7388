#include "app/run/crowding_watch.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "app/run/placed_bone.h"
#include "crowd/herd.h"
#include "crowd/radius.h"
#include "crowd/readback.h"
#include "skitter/decode.h"
#include "skitter/records.h"

namespace skitter::app {
namespace {

constexpr double oftenSeconds = 0.1, rarelySeconds = 1;
constexpr size_t secondsOfStanding = 10;

uint64_t ticksOf(double seconds, double dt) {
  return std::max<uint64_t>(1, static_cast<uint64_t>(std::llround(seconds / dt)));
}

template <class Each>
void eachKind(const Crowd& crowd, const Each& each) {
  for (const crowd::Kind& kind : implOf(crowd).kinds)
    if (!kind.pages.empty()) each(kind);
}

double widestOf(const Crowd& crowd) {
  double widest = 0.01;
  eachKind(crowd, [&](const crowd::Kind& kind) {
    widest = std::max(widest, double{crowd::footprintRadius(kind.rig)});
  });
  return widest;
}

LegLines legLinesOf(const HerdState& state, const crowd::Kind& kind, size_t agent, const glm::dvec2& place) {
  LegLines lines;
  const size_t legs = kind.rig.legs.size();
  for (size_t leg = 0; leg < legs; ++leg) {
    std::vector<glm::dvec2>& line = lines.emplace_back();
    for (size_t bone = 0; bone < kind.rig.legs[leg].bones.size(); ++bone) {
      const PlacedBone placed = placedBone(state, kind, agent, leg, bone);
      line.push_back(place + glm::dvec2(placed.start[0], placed.start[2]));
    }
    const float* tip = &state.tip[4 * (agent * legs + leg) * shared::TIP_STRIDE];
    line.push_back(place + glm::dvec2(tip[0], tip[2]));
  }
  return lines;
}

}  // namespace

CrowdingWatch::CrowdingWatch(const Crowd& crowd, double dt)
    : first_(crowd.tick()),
      often_(ticksOf(oftenSeconds, dt)),
      rarely_(ticksOf(rarelySeconds, dt)),
      dt_(dt),
      widest_(widestOf(crowd)),
      flow_(2 * widest_) {
  eachKind(crowd, [&](const crowd::Kind& kind) { reach_ = std::max(reach_, double{crowd::radiusOf(kind)}); });
}

CrowdingWatch::Moment CrowdingWatch::momentOf(const Crowd& crowd) const {
  constexpr std::array records = {Record::body, Record::goal, Record::steer};
  Moment moment;
  for (const HerdState& state : crowd::downloadRecords(implOf(crowd), records)) {
    for (size_t agent = 0; agent < state.agents; ++agent) {
      const std::span<const float> bodies(state.body);
      const BodyState body = bodyOf(bodies.subspan(4 * agent * shared::BODY_STRIDE, 4 * shared::BODY_STRIDE));
      moment.places.push_back(body.present ? glm::dvec2(body.position.x, body.position.z) : glm::dvec2(NAN));
      const float* steer = &state.steer[4 * agent * shared::STEER_STRIDE];
      moment.wanted.emplace_back(steer[0], steer[1]);
      moment.speeds.push_back(body.present ? double{glm::length(body.velocity)} : NAN);
      moment.hasPoint.push_back(state.goal[4 * agent * shared::GOAL_STRIDE + 6] == shared::GOAL_POINT);
    }
  }
  return moment;
}

void CrowdingWatch::look(const Crowd& crowd) {
  const uint64_t tick = crowd.tick() - first_;
  if (tick % often_ == 0 || tick % rarely_ == 0) follow(crowd);
}

void CrowdingWatch::follow(const Crowd& crowd) {
  const uint64_t tick = crowd.tick() - first_;
  Moment now = momentOf(crowd);
  // Herds have come or gone, and agents have other numbers.
  if (last_ && last_->places.size() != now.places.size()) {
    last_.reset();
    seconds_.clear();
  }
  if (last_)
    for (size_t i = 0; i < now.places.size(); ++i)
      if (std::isfinite(now.places[i].x) && std::isfinite(last_->places[i].x))
        flow_.add(last_->places[i], now.places[i], static_cast<double>(tick) * dt_);
  if (tick % rarely_ == 0) lookClosely(crowd, now);
  last_ = std::move(now);
}

void CrowdingWatch::lookClosely(const Crowd& crowd, const Moment& now) {
  countCrossings(crowd, now);
  seconds_.push_back(now);
  if (seconds_.size() <= secondsOfStanding) return;
  std::vector<Advance> agents(now.places.size());
  std::vector<glm::dvec2> places;  // of one of them
  size_t i = 0;
  for (uint32_t h = 0; h < crowd.herdCount(); ++h)
    for (uint32_t agent = 0; agent < crowd.places(h); ++agent, ++i) {
      places.clear();
      for (const Moment& second : seconds_) places.push_back(second.places[i]);
      agents[i] = {
          .now = now.places[i],
          .moved = movedFrom(places, now.places[i]),
          .wanted = now.wanted[i],
          .radius = double{crowd::footprintRadius(crowd.rig(h, agent))},
          .isThere = std::ranges::all_of(places, [](const glm::dvec2& p) { return std::isfinite(p.x); }),
          .hasPoint = now.hasPoint[i]};
    }
  const std::vector<Standing> standings = standingsOf(agents);
  stuck_.resize(std::max(stuck_.size(), standings.size()));
  arrived_.resize(stuck_.size());
  for (size_t k = 0; k < standings.size(); ++k) {
    if (standings[k] == Standing::stuck) stuck_[k] = true;
    if (standings[k] == Standing::arrived) arrived_[k] = true;
  }
  seconds_.pop_front();
}

void CrowdingWatch::countCrossings(const Crowd& crowd, const Moment& now) {
  std::vector<LegLines> legs;
  for (uint32_t h = 0; h < crowd.herdCount(); ++h) {
    const HerdState state = crowd.download(h);
    for (uint32_t agent = 0; agent < state.agents; ++agent) {
      const glm::dvec2& place = now.places[legs.size()];
      const bool isThere = std::isfinite(place.x);
      legs.push_back(isThere ? legLinesOf(state, implOf(crowd).kindOf(h, agent), agent, place) : LegLines());
      looked_ += isThere;
    }
  }
  const std::vector<bool> crosses = crossingAgents(legs, now.places, reach_);
  for (size_t i = 0; i < crosses.size(); ++i) {
    const bool isJammed = isInJam(glm::length(now.wanted[i]), now.speeds[i]);
    crossed_ += crosses[i];
    jammed_ += isJammed;
    jammedCrossed_ += crosses[i] && isJammed;
  }
}

Jams CrowdingWatch::jams() const {
  Jams jams{.flow = flow_.most()};
  const auto share = [](uint64_t of, uint64_t all) -> std::optional<double> {
    if (all == 0) return std::nullopt;
    return static_cast<double>(of) / static_cast<double>(all);
  };
  jams.legCrossings = share(crossed_, looked_);
  jams.legCrossingsOutsideJams = share(crossed_ - jammedCrossed_, looked_ - jammed_);
  jams.jammed = share(jammed_, looked_);
  jams.stuck = static_cast<uint64_t>(std::ranges::count(stuck_, true));
  jams.arrived = static_cast<uint64_t>(std::ranges::count(arrived_, true));
  return jams;
}

}  // namespace skitter::app
