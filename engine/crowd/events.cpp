#include "crowd/events.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "base/split_mix.h"
#include "crowd/herd.h"
#include "crowd/roster.h"
#include "crowd/setup.h"
#include "crowd/spawn.h"
#include "crowd/steer.h"
#include "crowd/ways/look.h"
#include "skitter/error.h"

namespace skitter::crowd {
namespace {

// The samples of one side within `radius` of a place.
struct Side {
  uint32_t first, count;
};
Side sideOf(float place, float radius, float origin, float spacing, uint32_t samples) {
  const double first = std::ceil((double{place} - radius - origin) / spacing);
  const double last = std::floor((double{place} + radius - origin) / spacing);
  const double from = std::max(first, 0.0), to = std::min(last, static_cast<double>(samples) - 1);
  return to < from ? Side{0, 0} : Side{static_cast<uint32_t>(from), static_cast<uint32_t>(to - from) + 1};
}

Rectangle rectangleOf(const Mound& mound, const Heightfield& terrain) {
  const Side columns =
      sideOf(mound.centre.x, mound.radius, terrain.originX(), terrain.spacingX, terrain.columns);
  const Side rows = sideOf(mound.centre.y, mound.radius, terrain.originZ(), terrain.spacingZ, terrain.rows);
  if (columns.count == 0 || rows.count == 0) return {};
  return {columns.first, rows.first, columns.count, rows.count};
}
Rectangle rectangleOf(const HeightSamples& samples, const Heightfield&) {
  return {samples.x, samples.z, samples.columns, samples.rows};
}
template <class AboutAgents>
Rectangle rectangleOf(const AboutAgents&, const Heightfield&) {
  return {};
}

std::vector<float> heightsOf(const Mound& mound, const Rectangle& at, const Heightfield& terrain) {
  std::vector<float> heights;
  for (uint32_t row = at.z; row < at.z + at.rows; ++row)
    for (uint32_t column = at.x; column < at.x + at.columns; ++column) {
      const glm::vec2 place(terrain.originX() + static_cast<float>(column) * terrain.spacingX,
                            terrain.originZ() + static_cast<float>(row) * terrain.spacingZ);
      const glm::vec2 away = (place - mound.centre) / mound.radius;
      const float inside = std::max(0.0f, 1 - glm::dot(away, away));
      heights.push_back(terrain.heights[size_t{row} * terrain.columns + column] +
                        mound.height * inside * inside);
    }
  return heights;
}
std::vector<float> heightsOf(const HeightSamples& samples, const Rectangle&, const Heightfield&) {
  return samples.heights;
}

// The number of one of the crowd's events.
size_t numberOf(const Event& event, const Crowd::Impl& crowd) {
  return static_cast<size_t>(&event - crowd.events.data());
}

// Who would be there as a tick's events happen one after the other: none of them happens where one cannot.
class Rehearsal {
 public:
  explicit Rehearsal(const Crowd::Impl& crowd) : crowd_(crowd), herds_(crowd) {}

  void play(const Event& event) {
    number_ = numberOf(event, crowd_);
    const std::string name = fmt::format("{}: events[{}]", crowd_.scene.name, number_);
    std::visit([&](const auto& what) { play(what, name); }, event.what);
  }

 private:
  void play(const Mound&, const std::string&) {}
  void play(const HeightSamples&, const std::string&) {}
  void play(const ThreatChange&, const std::string&) {}
  // Goals and speeds.
  template <class Change>
  void play(const Change& change, const std::string& name) {
    const skitter::Herd& herd = herdAt(change.herd, name);
    if constexpr (requires { change.goal; }) expectItsLeader(change.goal, herd, name);
    for (const uint32_t agent : change.agents) expectSomebody(change.herd, agent, name);
  }
  void play(const LegChange& change, const std::string& name) {
    const skitter::Herd& herd = herdAt(change.herd, name);
    expectHurts([&] { return fmt::format("{}: herd {}", name, change.herd); }, herd.hurt || herd.reactions);
    const auto coming = rigs_.find(change.herd);
    legOf([&] { return name; }, coming != rigs_.end() ? *coming->second : crowd_.kindOf(change.herd).rig,
          change);
    for (const uint32_t agent : change.agents) expectSomebody(change.herd, agent, name);
  }
  void play(const Push& push, const std::string& name) {
    expectReacts([&] { return fmt::format("{}: herd {}", name, push.herd); },
                 herdAt(push.herd, name).reactions);
    for (const uint32_t agent : push.agents) expectSomebody(push.herd, agent, name);
  }
  void play(const LoadChange& change, const std::string& name) {
    const skitter::Herd& herd = herdAt(change.herd, name);
    expectCarries([&] { return fmt::format("{}: herd {}", name, change.herd); }, herd);
    for (const uint32_t agent : change.agents) expectSomebody(change.herd, agent, name);
  }
  void play(const Teleport& teleport, const std::string& name) {
    for (const Teleport::Move& move : teleport.moves) expectSomebody(teleport.herd, move.agent, name);
  }
  void play(const Addition& addition, const std::string& name) {
    Presence& presence = presenceOf(addition.herd, name);
    expectItsReserve(addition.herd, name);
    for (size_t i = 0; i < addition.arrivals.size(); ++i) {
      const std::optional<uint32_t> empty = presence.lowestEmpty();
      if (!empty)
        throw inputError(fmt::format(
            "{}.add[{}]: all of the {} places of herd {} are taken, expected an empty one: a larger "
            "reserve has more",
            name, i, presence.generations.size(), addition.herd));
      presence.come(*empty);
      if (const std::optional<Goal>& goal = addition.arrivals[i].goal)
        expectItsLeader(*goal, herdAt(addition.herd, name), name);
    }
  }
  void play(const Removal& removal, const std::string& name) {
    for (const uint32_t agent : removal.agents) {
      expectSomebody(removal.herd, agent, name);
      presenceOf(removal.herd, name).leave(agent);
    }
    expectItsReserve(removal.herd, name);
  }

  void play(const HerdAddition& addition, const std::string& name) {
    const skitter::Herd& herd = addition.herd;
    const uint32_t number = herds_.add(herd, name + ".addHerd");
    const Numbering numbering = numberingOf(herd, seedOf(crowd_.seed, number));
    presences_[number] = Presence::beginning(herd, numbering.starts, 0);
    rigs_[number] = &crowd_.coming.at(number_).front().rig;
  }
  void play(const HerdRemoval& removal, const std::string& name) {
    herdAt(removal.herd, name);
    herds_.remove(removal.herd, fmt::format("{}.removeHerd: herd {}", name, removal.herd));
    presences_.erase(removal.herd);
    rigs_.erase(removal.herd);
  }

  // The host may have removed the herd, and may have made another one of that number.
  const skitter::Herd& herdAt(uint32_t number, const std::string& name) const {
    if (const skitter::Herd* herd = herds_.find(number)) return *herd;
    if (number < herds_.numbers())
      throw inputError(fmt::format("{}: herd {} was removed, expected one that is there", name, number));
    throw inputError(
        fmt::format("{}: herd {}: expected one of the crowd's {} herds", name, number, herds_.numbers()));
  }
  void expectItsLeader(const Goal& goal, const skitter::Herd& herd, const std::string& name) const {
    expectItsHerds([&] { return name; }, goal, herd,
                   [&](uint32_t leader) -> const skitter::Herd& { return herdAt(leader, name); });
  }
  Presence& presenceOf(uint32_t herd, const std::string& name) {
    herdAt(herd, name);
    const auto known = presences_.find(herd);
    return known != presences_.end() ? known->second
                                     : presences_.emplace(herd, crowd_.herdAt(herd).presence).first->second;
  }
  void expectSomebody(uint32_t herd, uint32_t agent, const std::string& name) {
    const Presence& presence = presenceOf(herd, name);
    if (agent >= presence.generations.size() || !presence.has(agent))
      throw inputError(fmt::format("{}: herd {}, agent {}: nobody, expected one of {} agents", name, herd,
                                   agent, presence.count));
  }
  void expectItsReserve(uint32_t herd, const std::string& name) const {
    expectReserve([&] { return fmt::format("{}: herd {}", name, herd); }, herdAt(herd, name).reserve > 0);
  }

  const Crowd::Impl& crowd_;
  Roster herds_;
  std::map<uint32_t, Presence> presences_;  // of the herds that events name
  std::map<uint32_t, const Rig*> rigs_;     // of the herds that come in the same tick
  size_t number_ = 0;                       // of the event
};

// What the host would call. The rehearsal has found nothing in the way.
class Happening {
 public:
  Happening(Crowd& crowd, size_t number) : crowd_(crowd), number_(number) {}

  void operator()(const Mound& mound) const { edit(mound); }
  void operator()(const HeightSamples& samples) const { edit(samples); }
  void operator()(const GoalChange& change) const {
    if (change.agents.empty()) return crowd_.steer(change.herd, change.goal);
    std::vector<AgentGoal> goals;
    for (const uint32_t agent : change.agents)
      goals.push_back({crowd_.agentId(change.herd, agent), change.goal});
    crowd_.steer(goals);
  }
  void operator()(const SpeedChange& change) const {
    if (change.agents.empty()) return crowd_.setSpeed(change.herd, change.speed);
    std::vector<AgentSpeed> speeds;
    for (const uint32_t agent : change.agents)
      speeds.push_back({crowd_.agentId(change.herd, agent), change.speed});
    crowd_.setSpeed(speeds);
  }
  void operator()(const Teleport& teleport) const {
    std::vector<AgentPlace> places;
    for (const auto& [agent, place] : teleport.moves)
      places.push_back({crowd_.agentId(teleport.herd, agent), place});
    crowd_.teleport(places);
  }
  void operator()(const Addition& addition) const {
    for (const auto& [place, goal] : addition.arrivals) {
      if (goal)
        crowd_.add(addition.herd, place, *goal);
      else
        crowd_.add(addition.herd, place);
    }
  }
  void operator()(const Removal& removal) const {
    for (const uint32_t agent : removal.agents) crowd_.remove(crowd_.agentId(removal.herd, agent));
  }
  void operator()(const LegChange& change) const {
    const Crowd::Impl& crowd = implOf(crowd_);
    const uint32_t leg = legOf([&] { return std::string(); }, crowd.kindOf(change.herd).rig, change);
    std::vector<AgentLeg> legs;
    for (const uint32_t agent : meantBy(change))
      legs.push_back({crowd_.agentId(change.herd, agent), leg, change.state, change.bone});
    crowd_.hurt(legs);
  }
  void operator()(const Push& push) const {
    std::vector<AgentPush> pushes;
    for (const uint32_t agent : meantBy(push))
      pushes.push_back({crowd_.agentId(push.herd, agent), push.velocity});
    crowd_.push(pushes);
  }
  void operator()(const LoadChange& change) const {
    std::vector<AgentLoad> loads;
    for (const uint32_t agent : meantBy(change))
      loads.push_back({crowd_.agentId(change.herd, agent), change.load});
    crowd_.carry(loads);
  }
  void operator()(const HerdAddition&) const { addComing(implOf(crowd_), number_); }
  void operator()(const HerdRemoval& removal) const { crowd_.removeHerd(crowd_.herdId(removal.herd)); }
  void operator()(const ThreatChange& change) const { crowd_.setThreat(change.number, change.threat); }

 private:
  // Those of whom it speaks: named, drawn by the seed, or all who are there.
  template <class Change>
  std::vector<uint32_t> meantBy(const Change& change) const {
    if (!change.agents.empty()) return change.agents;
    const Herd& herd = implOf(crowd_).herds[change.herd];
    std::vector<uint32_t> meant;
    for (uint32_t agent = 0; agent < herd.agents; ++agent)
      if (herd.presence.has(agent) && isDrawn(herd.seed, agent, change.share)) meant.push_back(agent);
    return meant;
  }
  // Each event draws by itself.
  bool isDrawn(uint64_t seed, uint32_t agent, std::optional<float> share) const {
    constexpr uint64_t stream = 0x6c656773;  // apart from what spawner and tints draw by the same seed
    const uint64_t drawn =
        base::SplitMix64::draw(base::SplitMix64::draw(seed + stream, number_ + 1), agent + 1);
    return !share || static_cast<double>(drawn >> 11) * 0x1p-53 < double{*share};
  }

  template <class Ground>
  void edit(const Ground& ground) const {
    const Rectangle at = rectangleOf(ground, crowd_.terrain());
    if (at.columns == 0) return;
    crowd_.editHeights(at.x, at.z, at.columns, at.rows, heightsOf(ground, at, crowd_.terrain()));
  }

  Crowd& crowd_;
  size_t number_;  // of the event
};

}  // namespace

// The first tick that ends at that time or later. A time that is a whole number of ticks may be a little more
// or less in float32.
uint64_t tickOf(const Event& event, double dt) {
  return static_cast<uint64_t>(std::max(1.0, std::ceil(double{event.at} / dt - 1e-3)));
}

std::span<const Event> eventsAt(std::span<const Event> events, uint64_t tick, double dt) {
  const auto byTick = [&](const Event& event) { return tickOf(event, dt); };
  const auto found = std::ranges::equal_range(events, tick, {}, byTick);
  return {found.begin(), found.end()};
}

Rectangle groundOf(const Event& event, const Heightfield& terrain) {
  return std::visit([&](const auto& what) { return rectangleOf(what, terrain); }, event.what);
}

bool namesAgents(const Event& event) {
  if (const auto* change = std::get_if<GoalChange>(&event.what)) return !change->agents.empty();
  if (const auto* change = std::get_if<SpeedChange>(&event.what)) return !change->agents.empty();
  if (const auto* change = std::get_if<LegChange>(&event.what)) return !change->agents.empty();
  if (const auto* push = std::get_if<Push>(&event.what)) return !push->agents.empty();
  if (const auto* change = std::get_if<LoadChange>(&event.what)) return !change->agents.empty();
  return std::holds_alternative<Teleport>(event.what) || std::holds_alternative<Removal>(event.what);
}

void letEventsHappen(Crowd& crowd) {
  Crowd::Impl& impl = implOf(crowd);
  const uint64_t tick = impl.tick + 1;
  if (impl.happened == tick) return;
  loadForagers(impl);
  const std::span<const Event> events = eventsAt(impl.events, tick, double{impl.dt}).subspan(impl.begun);
  if (!events.empty()) {
    Rehearsal rehearsal(impl);
    for (const Event& event : events) rehearsal.play(event);
  }
  for (const Event& event : events) {
    std::visit(Happening(crowd, numberOf(event, impl)), event.what);
    ++impl.begun;
  }
  impl.happened = tick;
  impl.begun = 0;
}

}  // namespace skitter::crowd
