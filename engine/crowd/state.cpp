// A crowd's records and what the host knows of it, to a state and back.
#include "crowd/state.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "assets/files/partial_file.h"
#include "crowd/events.h"
#include "crowd/frame.h"
#include "crowd/page.h"
#include "crowd/record.h"
#include "crowd/setup.h"
#include "crowd/state_file.h"
#include "crowd/state_head.h"
#include "crowd/state_host.h"
#include "crowd/state_records.h"
#include "gpu/barrier.h"
#include "gpu/context.h"
#include "gpu/submit.h"
#include "gpu/transfer.h"
#include "skitter/error.h"

namespace skitter {
namespace crowd {
namespace {

using Impl = Crowd::Impl;

StateHead headNow(const Impl& crowd, const std::vector<std::vector<RawFootfall>>& footfalls,
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
  if (crowd.rates) head.rates = ratesOf(crowd);
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
    made.chunks.push_back({StateChunk::footfalls, footfalls[k].size() * sizeof(RawFootfall)});
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
  std::vector<std::vector<RawFootfall>> footfalls;
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
      {{Record::rate}, {}},     // without levels everybody has full rate
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

// Lists who is awake, as the tick has. The counters are clear.
void listAwake(const Impl& crowd, uint64_t tick) {
  gpu::submitAndWait(*crowd.context, [&](vk::CommandBuffer cmd) {
    Frame(crowd, crowd.kinds, tick, cmd).record(StageId::wake);
    gpu::allToAll(cmd);
  });
}

// Time stands still meanwhile, so that clips do not go on. What else the stages change is written over later.
void derive(Impl& crowd, const std::vector<StageSet>& stages) {
  for (Kind& kind : crowd.kinds) {
    if (kind.stages.empty()) continue;
    setParameters(crowd, 0, kind);
    for (const Page& page : kind.pages) {  // nobody sleeps, and everybody has full rate
      gpu::clear(*crowd.context, kind.avoids ? page.avoid : page.steer);
      if (crowd.rates) gpu::clear(*crowd.context, page.rate);
    }
  }
  clearCounters(crowd);
  // With levels, tick 0 is everybody's turn and is not counted.
  listAwake(crowd, crowd.rates ? 0 : crowd.tick);
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
      std::vector<RawFootfall> footfalls;
      std::vector<uint32_t> generations, trail;
      const std::optional<Record> record = chunk.record();
      if (record && keeps(kind, crowd.options, *record)) {
        readRecords(crowd, kind, *record, reader);
      } else if (record) {
        reader.skip(chunk.bytes);
      } else if (chunk.name == StateChunk::footfalls) {
        footfalls.resize(chunk.bytes / sizeof(RawFootfall));
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
  return chunk.bytes / sizeof(RawFootfall) * sizeof(RawFootfall);  // any number of footfalls
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
  // With levels a tick begins with them.
  if (!crowd.rates) listAwake(crowd, crowd.tick);
  if (crowd.rates && source.head.rates) giveRates(*source.head.rates, crowd);
}

}  // namespace crowd

void Crowd::save(const std::filesystem::path& file, const std::string& note) const {
  PartialFile out(file);
  crowd::save(*impl_, note, [&](std::span<const std::byte> bytes) { out.write(bytes); });
  out.sync();
  out.keep();
}

std::vector<std::byte> Crowd::saveToMemory(const std::string& note) const {
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
