#include "crowd/state_host.h"

#include <algorithm>
#include <span>
#include <tuple>
#include <utility>

#include "crowd/events.h"
#include "crowd/page.h"
#include "crowd/state_file.h"
#include "gpu/context.h"
#include "gpu/transfer.h"

namespace skitter::crowd {

uint32_t fingerprintOf(const Kind& kind) {
  uint32_t sum = 0;
  const auto add = [&](const std::vector<float>& values) {
    sum = checksum(std::as_bytes(std::span(values)), sum);
  };
  add(kind.rigRecords);
  add({kind.rig.legLength, kind.rig.bodyHeight, kind.rig.bodyRadius});
  for (const auto* each :
       {&kind.clips.heads, &kind.clips.times, &kind.clips.rows, &kind.clips.legs, &kind.clips.bones})
    add(*each);
  add(kind.keyPoses.records);
  if (!kind.hurts) return sum;
  for (const RigGait& gait : kind.rig.gaits) {
    add({static_cast<float>(gait.idle), static_cast<float>(gait.groups), gait.adjacent ? 1.0f : 0.0f,
         gait.shift.x, gait.shift.y, gait.shift.z, gait.speed});
    for (const RigGait::Turn& turn : gait.turns) add({turn.phase, turn.slowness});
  }
  return sum;
}

std::vector<uint32_t> fingerprintsOf(const std::vector<Kind>& kinds) {
  std::vector<uint32_t> all;
  for (const Kind& kind : kinds) all.push_back(fingerprintOf(kind));
  return all;
}

std::vector<uint32_t> generationsOf(const Crowd::Impl& crowd, uint32_t kind) {
  std::vector<uint32_t> all(crowd.kinds[kind].agents);
  for (const HerdRun& of : runsOf(crowd, kind))
    std::ranges::copy(std::span(of.herd->presence.generations).subspan(of.run->firstOfHerd, of.run->agents),
                      all.begin() + of.run->firstAgent);
  return all;
}

bool isFirstGeneration(const Crowd::Impl& crowd, uint32_t kind) {
  return std::ranges::all_of(generationsOf(crowd, kind), [](uint32_t generation) { return generation == 0; });
}

void giveGenerations(Crowd::Impl& crowd, uint32_t kind, std::span<const uint32_t> all) {
  for (const HerdRun& of : runsOf(crowd, kind)) {
    std::vector<uint32_t> generations = of.herd->presence.generations;
    const auto own = all.subspan(of.run->firstAgent, of.run->agents);
    std::ranges::copy(own, generations.begin() + of.run->firstOfHerd);
    crowd.herds[of.number].presence = Presence(std::move(generations));
  }
}

std::vector<StateChange> changesOf(const Kind& kind) {
  std::vector<StateChange> all;
  for (const auto& [agent, goal, speed, leaves, hurt, record, stands, push] : kind.changes.all()) {
    all.push_back({agent, goal, speed, leaves, record, {}, {}, {}, {}});
    if (push) all.back().push = {push->x, push->y};
    if (stands) all.back().stands = {stands->position.x, stands->position.y, stands->heading};
    if (!hurt) continue;
    const auto damage = kind.damages.find(agent);
    const auto values = (damage == kind.damages.end() ? Damage{} : damage->second).values();
    all.back().hurt.assign(values.begin(), values.end());
    const Load load = kind.carriedBy(agent);
    if (load.mass == 0) continue;
    const CarriedRecord carried = carriedRecord(load);
    all.back().load.assign(carried.begin(), carried.end());
  }
  return all;
}

void giveChanges(const std::vector<StateChange>& all, Kind& kind) {
  for (const auto& [agent, goal, speed, leaves, record, stands, hurt, load, push] : all) {
    if (agent >= kind.agents) continue;
    AgentChange& change = kind.changes.of(agent, kind.agents);
    change = {agent, goal, speed, leaves, kind.hurts && hurt.size() == Damage::floats, record, {}, {}};
    if (kind.reacts && push.size() == 2) change.push = glm::vec2(push[0], push[1]);
    if (stands.size() == 3) change.stands = Place{{stands[0], stands[1]}, stands[2]};
  }
}

std::vector<StateThreat> threatsOf(const Crowd::Impl& crowd) {
  std::vector<StateThreat> all;
  const auto add = [&](int64_t kind, const Threat& threat) {
    all.push_back({kind, {threat.centre.x, threat.centre.y, threat.radius}});
  };
  for (const Threat& threat : crowd.threats) add(-1, threat);
  for (const SeenThreat& seen : crowd.seen) add(seen.kind, seen.threat);
  return all;
}

void giveThreats(const std::vector<StateThreat>& all, Crowd::Impl& crowd) {
  crowd.threats.clear();
  for (const auto& [kind, disc] : all) {
    const Threat threat{{disc[0], disc[1]}, disc[2]};
    if (kind < 0)
      crowd.threats.push_back(threat);
    else
      crowd.seen.push_back({static_cast<uint32_t>(kind), threat});
  }
}

namespace {

std::vector<float> numbersOf(const std::vector<glm::vec2>& places) {
  std::vector<float> numbers;
  for (const glm::vec2& place : places) numbers.insert(numbers.end(), {place.x, place.y});
  return numbers;
}

std::vector<glm::vec2> placesFrom(const std::vector<float>& numbers) {
  std::vector<glm::vec2> places;
  for (size_t i = 0; i + 1 < numbers.size(); i += 2) places.emplace_back(numbers[i], numbers[i + 1]);
  return places;
}

}  // namespace

std::vector<StateSeries> seriesOf(const Crowd::Impl& crowd) {
  std::vector<StateSeries> all;
  for (uint32_t k = 0; k < crowd.kinds.size(); ++k)
    for (const auto& [goal, first, places] : crowd.kinds[k].series)
      all.push_back({.kind = k,
                     .first = first,
                     .places = numbersOf(places),
                     .goal = static_cast<uint32_t>(goal.kind),
                     .disc = {goal.target.x, goal.target.y, goal.radius},
                     .named = numbersOf(goal.places),
                     .loop = goal.loop,
                     .leader = goal.leader,
                     .agent = goal.agent ? int64_t{*goal.agent} : -1});
  return all;
}

void giveSeries(const std::vector<StateSeries>& all, Crowd::Impl& crowd) {
  for (const StateSeries& saved : all) {
    if (saved.kind >= crowd.kinds.size()) continue;
    Goal goal{.kind = static_cast<Goal::Kind>(saved.goal),
              .target = {saved.disc[0], saved.disc[1]},
              .speed = 0,
              .places = placesFrom(saved.named),
              .loop = saved.loop,
              .radius = saved.disc[2],
              .leader = saved.leader};
    if (saved.agent >= 0) goal.agent = static_cast<uint32_t>(saved.agent);
    crowd.kinds[saved.kind].series.push_back({goal, saved.first, placesFrom(saved.places)});
  }
}

namespace {

void setDamage(Kind& kind, uint32_t agent, const Damage& damage) {
  if (damage.isNone())
    kind.damages.erase(agent);
  else
    kind.damages[agent] = damage;
}

}  // namespace

void giveDamages(const Crowd::Impl& crowd, const std::vector<StateChange>& waiting, Kind& kind) {
  if (!kind.hurts) return;
  const auto floats = 4 * static_cast<size_t>(shared::hurtStride(kind.legs));
  for (const Page& page : kind.pages) {
    const std::vector<float> records = gpu::download<float>(*crowd.context, page.hurt);
    const std::vector<float> carried = gpu::download<float>(*crowd.context, page.carried);
    for (uint32_t agent = 0; agent < page.agents; ++agent) {
      setDamage(kind, page.firstAgent + agent,
                Damage::ofValues(std::span(records).subspan(agent * floats, Damage::floats)));
      kind.setLoad(page.firstAgent + agent,
                   loadOf(std::span(carried).subspan(agent * std::tuple_size_v<CarriedRecord>)));
    }
  }
  for (const StateChange& change : waiting) {
    if (change.agent >= kind.agents || change.hurt.size() != Damage::floats) continue;
    setDamage(kind, change.agent, Damage::ofValues(change.hurt));
    kind.setLoad(change.agent,
                 change.load.size() == std::tuple_size_v<CarriedRecord> ? loadOf(change.load) : Load{});
  }
}

}  // namespace skitter::crowd
