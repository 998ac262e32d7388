// A crowd's records and what the host knows of it, to a state and back.
#include "crowd/state.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "assets/files/partial_file.h"
#include "crowd/events.h"
#include "crowd/frame.h"
#include "crowd/page.h"
#include "crowd/record.h"
#include "crowd/setup.h"
#include "crowd/state_file.h"
#include "crowd/state_head.h"
#include "crowd/watch.h"
#include "gpu/barrier.h"
#include "gpu/context.h"
#include "gpu/submit.h"
#include "gpu/transfer.h"
#include "skitter/error.h"

namespace skitter {
namespace crowd {
namespace {

using Impl = Crowd::Impl;

uint64_t bytesOfRecord(const Kind& kind, Record record) {
  return 16 * static_cast<uint64_t>(strideOf(record, kind.legs, kind.bones, kind.clips.joints));
}

// How many of them a run of agents has.
uint64_t recordsOf(const Impl& crowd, const Kind& kind, Record record, uint64_t agents) {
  switch (infoOf(record).per) {
    case Per::agent:
      break;
    case Per::leg:
      return agents * static_cast<uint64_t>(kind.legs);
    case Per::watched:
      return (agents + crowd.watchEvery - 1) / crowd.watchEvery;
  }
  return agents;
}

uint64_t bytesOfRecords(const Impl& crowd, const Kind& kind, Record record) {
  return recordsOf(crowd, kind, record, kind.agents) * bytesOfRecord(kind, record);
}

std::vector<StateChunk> recordChunks(const Impl& crowd, const Kind& kind) {
  std::vector<StateChunk> chunks;
  for (const Record record : allRecords)
    if (keeps(kind, crowd.options, record))
      chunks.push_back({infoOf(record).name, bytesOfRecords(crowd, kind, record)});
  return chunks;
}

// Copies each leg's record between a page, where agents are in blocks, and a chunk.
template <class Copy>
void eachLeg(const Page& page, int legs, uint64_t bytes, const Copy& copy) {
  uint64_t place = 0;
  for (int agent = 0; agent < static_cast<int>(page.agents); ++agent)
    for (int leg = 0; leg < legs; ++leg, place += bytes)
      copy(place, bytes * static_cast<uint64_t>(shared::legRecord(agent, leg, legs)));
}

// Calls each(bytes in the page, bytes in the chunk) for whom measure looks at in this tick. There is one of
// every `watchEvery` agents of the kind, and so they have their place in the chunk.
template <class Each>
void eachWatched(const Impl& crowd, const Page& page, uint64_t bytes, const Each& each) {
  const Watch watch = watchAt(crowd.tick, crowd.watchEvery, page);
  for (uint64_t slot = 0; slot < watch.count; ++slot)
    each(slot * bytes, (page.firstAgent + watch.first + slot * crowd.watchEvery) / crowd.watchEvery * bytes);
}

uint64_t bytesInPage(const Page& page, const Kind& kind, Record record, uint64_t bytes) {
  return infoOf(record).per == Per::leg ? wholeBlocks(page.agents) * static_cast<uint64_t>(kind.legs) * bytes
                                        : page.agents * bytes;
}

void writeRecords(const Impl& crowd, const Kind& kind, Record record, StateWriter& writer) {
  const uint64_t bytes = bytesOfRecord(kind, record);
  std::vector<std::byte> there, here;
  if (infoOf(record).per == Per::watched) {
    here.resize(bytesOfRecords(crowd, kind, record));
    for (const Page& page : kind.pages) {
      there.resize(page.of(record).size());
      gpu::downloadBytes(*crowd.context, page.of(record), there);
      eachWatched(crowd, page, bytes,
                  [&](uint64_t in, uint64_t to) { std::memcpy(here.data() + to, there.data() + in, bytes); });
    }
    return writer.write(here);
  }
  for (const Page& page : kind.pages) {
    there.resize(bytesInPage(page, kind, record, bytes));
    gpu::downloadBytes(*crowd.context, page.of(record), there);
    if (infoOf(record).per == Per::agent) {
      writer.write(there);
      continue;
    }
    here.resize(page.agents * static_cast<uint64_t>(kind.legs) * bytes);
    eachLeg(page, kind.legs, bytes,
            [&](uint64_t to, uint64_t from) { std::memcpy(here.data() + to, there.data() + from, bytes); });
    writer.write(here);
  }
}

void readRecords(const Impl& crowd, const Kind& kind, Record record, StateReader& reader) {
  const uint64_t bytes = bytesOfRecord(kind, record);
  std::vector<std::byte> there, here;
  if (infoOf(record).per == Per::watched) {
    here.resize(bytesOfRecords(crowd, kind, record));
    reader.read(here);
    for (const Page& page : kind.pages) {
      there.assign(page.of(record).size(), std::byte{0});
      eachWatched(crowd, page, bytes, [&](uint64_t in, uint64_t from) {
        std::memcpy(there.data() + in, here.data() + from, bytes);
      });
      gpu::uploadBytes(*crowd.context, page.of(record), there);
    }
    return;
  }
  for (const Page& page : kind.pages) {
    here.resize(recordsOf(crowd, kind, record, page.agents) * bytes);
    reader.read(here);
    if (infoOf(record).per == Per::agent) {
      gpu::uploadBytes(*crowd.context, page.of(record), here);
      continue;
    }
    there.assign(bytesInPage(page, kind, record, bytes), std::byte{0});
    eachLeg(page, kind.legs, bytes,
            [&](uint64_t from, uint64_t to) { std::memcpy(there.data() + to, here.data() + from, bytes); });
    gpu::uploadBytes(*crowd.context, page.of(record), there);
  }
}

// A footfall as the device has it; agents are numbered through the kind.
struct Event {
  std::array<float, size_t{4} * shared::FOOTFALL_STRIDE> values;
  float agent() const { return values[4]; }
  float leg() const { return values[5]; }
};

std::vector<Event> footfallsOf(const Impl& crowd, const Kind& kind) {
  std::vector<Event> all;
  if (crowd.options.footfalls == 0) return all;
  for (const Page& page : kind.pages) {
    const auto counters = gpu::download<uint32_t>(*crowd.context, page.counters);
    std::vector<Event> events(std::min(counters[shared::COUNTER_FOOTFALLS], page.footfallRoom));
    gpu::downloadBytes(*crowd.context, page.footfall, std::as_writable_bytes(std::span(events)));
    all.insert(all.end(), events.begin(), events.end());
  }
  // The device appends them in any order.
  std::ranges::sort(all, {}, [](const Event& event) { return std::pair(event.agent(), event.leg()); });
  return all;
}

void giveFootfalls(const Impl& crowd, const Kind& kind, const std::vector<Event>& all) {
  if (crowd.options.footfalls == 0) return;
  for (const Page& page : kind.pages) {
    std::vector<Event> events;
    for (const Event& event : all)
      if (event.agent() >= static_cast<float>(page.firstAgent) &&
          event.agent() < static_cast<float>(page.firstAgent + page.agents))
        events.push_back(event);
    const std::array count = {static_cast<uint32_t>(std::min<uint64_t>(events.size(), page.footfallRoom))};
    events.resize(count[0]);
    gpu::uploadBytes(*crowd.context, page.footfall, std::as_bytes(std::span(events)));
    gpu::uploadBytes(*crowd.context, page.counters, std::as_bytes(std::span(count)),
                     bytesOfCounters(shared::COUNTER_FOOTFALLS));
  }
}

// Adds what the device has counted for a herd since the start, on all of its pages.
void addCounts(const Impl& crowd, uint32_t herd, StateHerd& sums) {
  for (const Part& part : partsOf(crowd, herd)) {
    const CounterRow row = rowOf(*crowd.context, part);
    for (size_t i = 0; i < row.size(); ++i) sums.counts[i] += row[i];
    if (!part.page->histogram) continue;
    decltype(sums.reachErrors) here;
    gpu::downloadBytes(*crowd.context, part.page->histogram, std::as_writable_bytes(std::span(here)),
                       part.row * sizeof here);
    for (size_t i = 0; i < here.size(); ++i) sums.reachErrors[i] += here[i];
  }
}

// To one of its pages: only the sum over all of them is asked for.
void giveCounts(const Impl& crowd, uint32_t herd, const StateHerd& counts) {
  const std::vector<Part> parts = partsOf(crowd, herd);
  if (parts.empty()) return;
  const Part& part = parts.front();
  gpu::uploadBytes(*crowd.context, part.page->counters, std::as_bytes(std::span(counts.counts)),
                   bytesOfCounters(shared::counterRow(static_cast<int>(part.row))));
  if (part.page->histogram)
    gpu::uploadBytes(*crowd.context, part.page->histogram, std::as_bytes(std::span(counts.reachErrors)),
                     part.row * sizeof counts.reachErrors);
}

// Of all that the simulation knows of the kind's rig and its clips: what the records are of no use without.
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

// Of each of the kind's places.
std::vector<uint32_t> generationsOf(const Impl& crowd, uint32_t kind) {
  std::vector<uint32_t> all(crowd.kinds[kind].agents);
  for (const HerdRun& of : runsOf(crowd, kind))
    std::ranges::copy(std::span(of.herd->presence.generations).subspan(of.run->firstOfHerd, of.run->agents),
                      all.begin() + of.run->firstAgent);
  return all;
}

// Whether everybody is there who was there at first, and nobody else.
bool isFirstGeneration(const Impl& crowd, uint32_t kind) {
  return std::ranges::all_of(generationsOf(crowd, kind), [](uint32_t generation) { return generation == 0; });
}

void giveGenerations(Impl& crowd, uint32_t kind, std::span<const uint32_t> all) {
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

std::vector<StateThreat> threatsOf(const Impl& crowd) {
  std::vector<StateThreat> all;
  const auto add = [&](int64_t kind, const Threat& threat) {
    all.push_back({kind, {threat.centre.x, threat.centre.y, threat.radius}});
  };
  for (const Threat& threat : crowd.threats) add(-1, threat);
  for (const SeenThreat& seen : crowd.seen) add(seen.kind, seen.threat);
  return all;
}

void giveThreats(const std::vector<StateThreat>& all, Impl& crowd) {
  crowd.threats.clear();
  for (const auto& [kind, disc] : all) {
    const Threat threat{{disc[0], disc[1]}, disc[2]};
    if (kind < 0)
      crowd.threats.push_back(threat);
    else
      crowd.seen.push_back({static_cast<uint32_t>(kind), threat});
  }
}

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

std::vector<StateSeries> seriesOf(const Impl& crowd) {
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

void giveSeries(const std::vector<StateSeries>& all, Impl& crowd) {
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

void setDamage(Kind& kind, uint32_t agent, const Damage& damage) {
  if (damage.isNone())
    kind.damages.erase(agent);
  else
    kind.damages[agent] = damage;
}

// Damage and loads, as the records have them or as wait to be written.
void giveDamages(const Impl& crowd, const std::vector<StateChange>& waiting, Kind& kind) {
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

StateHead headNow(const Impl& crowd, const std::vector<std::vector<Event>>& footfalls,
                  const std::string& note) {
  StateHead head;
  head.tick = crowd.tick;
  head.dt = crowd.dt;
  head.scene = crowd.scene;
  head.agentsInTick = crowd.agentsInTick;
  head.begun = crowd.happened > crowd.tick ? eventsAt(crowd.events, crowd.tick + 1, double{crowd.dt}).size()
                                           : crowd.begun;
  head.terrain = crowd.terrain;
  head.options = crowd.options;
  head.options.watchEvery = crowd.watchEvery;
  head.note = note;
  head.watchUntil = crowd.watchUntil;
  head.threats = threatsOf(crowd);
  head.series = seriesOf(crowd);
  head.rigsAreCallers = crowd.rigsAreCallers;
  for (size_t k = 0; k < crowd.kinds.size(); ++k) {
    const Kind& kind = crowd.kinds[k];
    StateKind& made = head.kinds.emplace_back(StateKind{.rig = kind.rig.name,
                                                        .agents = kind.agents,
                                                        .firstAgents = kind.firstAgents,
                                                        .changes = changesOf(kind),
                                                        .legs = kind.legs,
                                                        .bones = kind.bones,
                                                        .joints = kind.clips.joints,
                                                        .hash = fingerprintOf(kind),
                                                        .chunks = recordChunks(crowd, kind)});
    made.chunks.push_back({StateChunk::footfalls, footfalls[k].size() * sizeof(Event)});
    if (!isFirstGeneration(crowd, static_cast<uint32_t>(k)))
      made.chunks.push_back({StateChunk::generations, kind.agents * sizeof(uint32_t)});
    if (kind.trails) made.chunks.push_back({StateChunk::trail, kind.trails->bytes()});
  }
  for (uint32_t h = 0; h < crowd.herds.size(); ++h) {
    const Herd& herd = crowd.herds[h];
    head.scene.herds.push_back(herd.from);
    const std::vector<uint32_t>& generations = herd.presence.generations;
    head.herds.push_back({.runs = herd.runs,
                          .generation = herd.generation,
                          .lastGeneration = generations.empty() ? 0 : std::ranges::max(generations),
                          .since = herd.since});
    if (!herd.isGone()) addCounts(crowd, h, head.herds.back());
  }
  for (const auto& [event, kinds] : crowd.coming)
    head.coming.push_back({.event = event, .hashes = fingerprintsOf(kinds)});
  return head;
}

void save(const Impl& crowd, const std::string& note, StateSink sink) {
  crowd.context->waitIdle();
  std::vector<std::vector<Event>> footfalls;
  for (const Kind& kind : crowd.kinds) footfalls.push_back(footfallsOf(crowd, kind));
  const StateHead head = headNow(crowd, footfalls, note);
  StateWriter writer(head, std::move(sink));
  for (size_t k = 0; k < crowd.kinds.size(); ++k)
    for (const StateChunk& chunk : head.kinds[k].chunks) {
      if (const std::optional<Record> record = chunk.record()) {
        writeRecords(crowd, crowd.kinds[k], *record, writer);
      } else if (chunk.name == StateChunk::footfalls) {
        writer.write(std::as_bytes(std::span(footfalls[k])));
      } else if (chunk.name == StateChunk::trail) {
        const std::vector<uint32_t> trail = crowd.kinds[k].trails->trailWords();
        writer.write(std::as_bytes(std::span(trail)));
      } else {
        const std::vector<uint32_t> generations = generationsOf(crowd, static_cast<uint32_t>(k));
        writer.write(std::as_bytes(std::span(generations)));
      }
      writer.endChunk();
    }
}

// Records that a state may lack, because nobody had asked for them, and the stages that make them of others.
struct Derived {
  std::set<Record> records;
  std::vector<StageSet> stages;
};
const std::vector<Derived>& allDerived() {
  using enum StageId;
  static const std::vector<Derived> all = {
      {{Record::foot, Record::tip}, {swing, StageSet{swing, ik}, ik}},
      {{Record::pose}, {clip, pose}},  // clip lists who fades from one clip to another
      {{Record::flight}, {footfall}},
      {{Record::carried}, {}},  // in states from before there were loads nobody has one
  };
  return all;
}

// Those that the crowd keeps and the state lacks.
std::set<Record> lackingIn(const Impl& crowd, const StateHead& head) {
  std::set<Record> lacking;
  for (size_t k = 0; k < crowd.kinds.size(); ++k)
    for (const StateChunk& needed : recordChunks(crowd, crowd.kinds[k]))
      if (std::ranges::find(head.kinds[k].chunks, needed.name, &StateChunk::name) ==
          head.kinds[k].chunks.end())
        lacking.insert(needed.record().value());
  return lacking;
}

// The counters as between two ticks, with nobody listed.
void clearCounters(const Impl& crowd) {
  gpu::submitAndWait(*crowd.context, [&](vk::CommandBuffer cmd) {
    gpu::allToAll(cmd);
    clearLists(crowd.kinds, cmd);
    clearAwake(crowd, crowd.kinds, cmd);
    gpu::allToAll(cmd);
  });
}

// Lists who is awake, as the last tick has. The counters are clear.
void listAwake(const Impl& crowd) {
  gpu::submitAndWait(*crowd.context, [&](vk::CommandBuffer cmd) {
    Frame(crowd, crowd.kinds, crowd.tick, cmd).record(StageId::wake);
    gpu::allToAll(cmd);
  });
}

// Time stands still meanwhile, so that clips do not go on. What else the stages change is written over later.
void derive(Impl& crowd, const std::vector<StageSet>& stages) {
  for (Kind& kind : crowd.kinds) {
    if (kind.stages.empty()) continue;
    setParameters(crowd, 0, kind);
    for (const Page& page : kind.pages)  // nobody sleeps
      gpu::clear(*crowd.context, kind.avoids ? page.avoid : page.steer);
  }
  clearCounters(crowd);
  listAwake(crowd);
  gpu::submitAndWait(*crowd.context, [&](vk::CommandBuffer cmd) {
    const Frame frame(crowd, crowd.kinds, crowd.tick, cmd);
    for (const StageSet stage : stages) {
      frame.record(stage);
      gpu::allToAll(cmd);
    }
  });
}

// All that the state has and the crowd keeps.
void readChunks(Impl& crowd, State::Source& source) {
  StateReader reader(source);
  for (uint32_t k = 0; k < crowd.kinds.size(); ++k) {
    const Kind& kind = crowd.kinds[k];
    for (const StateChunk& chunk : source.head.kinds[k].chunks) {
      std::vector<Event> footfalls;
      std::vector<uint32_t> generations, trail;
      const std::optional<Record> record = chunk.record();
      if (record && keeps(kind, crowd.options, *record)) {
        readRecords(crowd, kind, *record, reader);
      } else if (record) {
        reader.skip(chunk.bytes);
      } else if (chunk.name == StateChunk::footfalls) {
        footfalls.resize(chunk.bytes / sizeof(Event));
        reader.read(std::as_writable_bytes(std::span(footfalls)));
      } else if (chunk.name == StateChunk::trail) {
        trail.resize(chunk.bytes / sizeof(uint32_t));
        reader.read(std::as_writable_bytes(std::span(trail)));
      } else {
        generations.resize(kind.agents);
        reader.read(std::as_writable_bytes(std::span(generations)));
      }
      reader.endChunk(fmt::format("record {} of herds of rig {}", chunk.name, kind.rig.name));
      if (!footfalls.empty()) giveFootfalls(crowd, kind, footfalls);
      if (!generations.empty()) giveGenerations(crowd, k, generations);
      if (!trail.empty()) gpu::upload(*crowd.context, kind.trails->trail(), trail);
    }
  }
  for (uint32_t herd = 0; herd < crowd.herds.size(); ++herd)
    if (!crowd.herds[herd].isGone()) giveCounts(crowd, herd, source.head.herds[herd]);
}

uint64_t expectedBytes(const Impl& crowd, const Kind& kind, const StateChunk& chunk) {
  if (const std::optional<Record> record = chunk.record()) return bytesOfRecords(crowd, kind, *record);
  if (chunk.name == StateChunk::generations) return kind.agents * sizeof(uint32_t);
  if (chunk.name == StateChunk::trail) return bytesOfTrail(crowd, kind);
  return chunk.bytes / sizeof(Event) * sizeof(Event);  // any number of footfalls
}

void checkChunk(const Impl& crowd, const Kind& kind, const StateChunk& chunk, const std::string& state) {
  const uint64_t expected = expectedBytes(crowd, kind, chunk);
  if (chunk.bytes != expected)
    throw inputError(fmt::format("{}: record {} of herds of rig {} has {} bytes, expected {}", state,
                                 chunk.name, kind.rig.name, chunk.bytes, expected));
}

bool isNumberedSo(const std::vector<SizeRun>& runs, const Numbering& numbering) {
  if (runs.size() != numbering.counts.size()) return false;
  uint32_t first = 0;
  for (size_t i = 0; i < runs.size(); ++i) {
    if (runs[i].firstOfHerd != first || runs[i].agents != numbering.counts[i]) return false;
    first += runs[i].agents;
  }
  return true;
}

}  // namespace

void restoreHerds(Impl& crowd, const State& state) {
  const auto& [name, head] = std::tie(state.source->name, state.source->head);
  if (head.rigsAreCallers && state.options.rigs.empty())
    throw inputError(
        fmt::format("{}: the crowd was made of rigs of a program's own, which must give them again", name));
  if (state.options.rigs.size() > head.herds.size())
    throw inputError(fmt::format("{}: {} rigs for {} herds, expected one for each that the crowd began with",
                                 name, state.options.rigs.size(), head.herds.size()));
  // The caller may have changed the scene's events.
  if (state.dt > 0)
    crowd.begun =
        std::min<uint64_t>(head.begun, eventsAt(crowd.events, state.tick + 1, double{state.dt}).size());
  giveThreats(head.threats, crowd);
  for (size_t h = 0; h < head.herds.size(); ++h) {
    const StateHerd& saved = head.herds[h];
    Herd& herd = crowd.herds.emplace_back();
    herd.from = state.scene.herds.at(h);
    herd.seed = seedOf(crowd.seed, h);
    herd.generation = saved.generation;
    herd.since = saved.since;
    if (herd.isGone()) {
      herd.presence.generations = {saved.lastGeneration};
      continue;
    }
    Numbering numbering = numberingOf(herd.from, herd.seed);
    if (!isNumberedSo(saved.runs, numbering))
      throw inputError(fmt::format("{}: herd {} has other sizes than in its scene", name, h));
    herd.runs = saved.runs;
    herd.agents = herd.from.agents + herd.from.reserve;
    herd.starts = std::move(numbering.starts);
    herd.presence = Presence(std::vector<uint32_t>(herd.agents));
  }
  crowd.kinds.resize(head.kinds.size());
  for (size_t k = 0; k < head.kinds.size(); ++k) {
    crowd.kinds[k].agents = head.kinds[k].agents;
    crowd.kinds[k].firstAgents = head.kinds[k].firstAgents;
  }
  giveSeries(head.series, crowd);
}

void checkState(const Impl& crowd, const State& state) {
  const auto& [name, head] = std::tie(state.source->name, state.source->head);
  for (size_t k = 0; k < crowd.kinds.size(); ++k)
    if (head.kinds[k].hash != fingerprintOf(crowd.kinds[k]))
      throw inputError(fmt::format("{}: rig {} has other legs or clips than when the state was saved", name,
                                   crowd.kinds[k].rig.name));
  for (const StateComing& each : head.coming) {
    const auto found = crowd.coming.find(each.event);
    if (found == crowd.coming.end() || fingerprintsOf(found->second) != each.hashes)
      throw inputError(fmt::format(
          "{}: the rig of events[{}].addHerd has other legs or clips than when the state was saved", name,
          each.event));
  }
  const uint32_t watchEvery = head.options.watchEvery;
  if (crowd.watchEvery != watchEvery)
    throw inputError(
        fmt::format("{}: measure is to watch one agent of {}, expected {} as in the crowd that was saved",
                    name, crowd.watchEvery, watchEvery));
  for (size_t k = 0; k < crowd.kinds.size(); ++k)
    for (const StateChunk& chunk : head.kinds[k].chunks) checkChunk(crowd, crowd.kinds[k], chunk, name);
  for (size_t k = 0; k < crowd.kinds.size(); ++k)
    if (crowd.kinds[k].forages() && std::ranges::find(head.kinds[k].chunks, StateChunk::trail,
                                                      &StateChunk::name) == head.kinds[k].chunks.end())
      throw inputError(
          fmt::format("{}: has no trail of herds of rig {}, which forage", name, crowd.kinds[k].rig.name));
  for (const Record record : lackingIn(crowd, head))
    if (std::ranges::none_of(allDerived(),
                             [&](const Derived& each) { return each.records.contains(record); }))
      throw inputError(
          fmt::format("{}: has no {} records, which the crowd's options ask for", name, infoOf(record).name));
}

void restore(Impl& crowd, const State& state) {
  State::Source& source = *state.source;
  crowd.tick = state.tick;
  if (state.dt > 0) setTick(crowd, state.dt);
  crowd.watchUntil = source.head.watchUntil;
  crowd.agentsInTick = source.head.agentsInTick;
  for (size_t k = 0; k < crowd.kinds.size(); ++k) giveChanges(source.head.kinds[k].changes, crowd.kinds[k]);
  clearCounters(crowd);
  readChunks(crowd, source);
  const std::set<Record> lacking = lackingIn(crowd, source.head);
  for (const Derived& each : allDerived()) {
    if (std::ranges::none_of(each.records, [&](Record record) { return lacking.contains(record); })) continue;
    derive(crowd, each.stages);
    clearCounters(crowd);
    readChunks(crowd, source);
  }
  for (size_t k = 0; k < crowd.kinds.size(); ++k)
    giveDamages(crowd, source.head.kinds[k].changes, crowd.kinds[k]);
  for (Kind& kind : crowd.kinds)
    if (!kind.stages.empty()) setParameters(crowd, crowd.dt > 0 ? crowd.dt : usualDt, kind);
  listAwake(crowd);
}

}  // namespace crowd

namespace {

void expectUnlevelled(const Crowd::Impl& crowd) {
  if (crowd.rates) throw inputError("a crowd with levels of rate cannot be saved");
}

}  // namespace

void Crowd::save(const std::filesystem::path& file, const std::string& note) const {
  expectUnlevelled(*impl_);
  PartialFile out(file);
  crowd::save(*impl_, note, [&](std::span<const std::byte> bytes) { out.write(bytes); });
  out.sync();
  out.keep();
}

std::vector<std::byte> Crowd::saveToMemory(const std::string& note) const {
  expectUnlevelled(*impl_);
  std::vector<std::byte> state;
  state.reserve(stateBytes());
  crowd::save(*impl_, note, [&](std::span<const std::byte> bytes) {
    state.insert(state.end(), bytes.begin(), bytes.end());
  });
  return state;
}

uint64_t Crowd::stateBytes() const {
  constexpr uint64_t aHead = 64 << 10, aHerd = 4 << 10;
  uint64_t bytes = aHead + aHerd * impl_->herds.size() + impl_->terrain.heights.size() * sizeof(float);
  for (const crowd::Kind& kind : impl_->kinds) {
    for (const crowd::StateChunk& chunk : crowd::recordChunks(*impl_, kind))
      bytes += crowd::bytesOfChunk(chunk.bytes);
    if (kind.trails) bytes += crowd::bytesOfChunk(kind.trails->bytes());
  }
  return bytes;
}

}  // namespace skitter
