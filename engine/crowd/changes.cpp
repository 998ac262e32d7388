#include "crowd/changes.h"

#include <algorithm>
#include <array>
#include <bit>
#include <map>
#include <span>
#include <utility>

#include "crowd/frame.h"
#include "crowd/herd.h"
#include "crowd/page.h"
#include "crowd/record.h"
#include "crowd/spawn.h"
#include "crowd/watch.h"
#include "gpu/barrier.h"
#include "gpu/submit.h"

namespace skitter::crowd {

AgentChange& AgentChanges::of(uint32_t agent, uint64_t agents) {
  places_.resize(agents);
  uint32_t& place = places_[agent];
  if (place == 0) {
    changes_.push_back({.agent = agent});
    place = static_cast<uint32_t>(changes_.size());
  }
  return changes_[place - 1];
}

std::vector<AgentChange> AgentChanges::take() {
  for (const AgentChange& change : changes_) places_[change.agent] = 0;
  if (!std::ranges::is_sorted(changes_, {}, &AgentChange::agent))
    std::ranges::sort(changes_, {}, &AgentChange::agent);
  return std::exchange(changes_, {});
}

namespace {

// Floats for places in buffers, none of them twice. They travel within the command buffer: by way of a
// staging buffer, for pieces are small and many.
class Writes {
 public:
  Writes(vk::CommandBuffer cmd, const gpu::Buffer& staging) : cmd_(cmd), staging_(staging) {
    values_.reserve(staging.size() / sizeof(float));
  }

  void add(const gpu::Buffer& to, uint64_t offset, std::span<const float> values) {
    while (!values.empty()) {
      const size_t room = values_.capacity() - values_.size();
      if (room == 0) {
        flush();
        continue;
      }
      const auto piece = values.first(std::min(room, values.size()));
      append(to, offset, piece);
      offset += piece.size_bytes();
      values = values.subspan(piece.size());
    }
  }

  void flush() {
    if (values_.empty()) return;
    constexpr uint64_t most = 65536;  // that vkCmdUpdateBuffer takes
    const uint64_t bytes = values_.size() * sizeof(float);
    gpu::transferToTransfer(cmd_);
    for (uint64_t at = 0; at < bytes; at += most)
      cmd_.updateBuffer(staging_.handle(), at, std::min(most, bytes - at),
                        values_.data() + at / sizeof(float));
    gpu::transferToTransfer(cmd_);
    for (const auto& [to, copies] : copies_) cmd_.copyBuffer(staging_.handle(), to, copies);
    copies_.clear();
    values_.clear();
  }

 private:
  void append(const gpu::Buffer& to, uint64_t offset, std::span<const float> values) {
    const uint64_t from = values_.size() * sizeof(float);
    std::vector<vk::BufferCopy>& copies = copies_[to.handle()];
    const bool goesOn = !copies.empty() && copies.back().srcOffset + copies.back().size == from &&
                        copies.back().dstOffset + copies.back().size == offset;
    if (goesOn)
      copies.back().size += values.size_bytes();
    else
      copies.push_back({.srcOffset = from, .dstOffset = offset, .size = values.size_bytes()});
    values_.insert(values_.end(), values.begin(), values.end());
  }

  vk::CommandBuffer cmd_;
  const gpu::Buffer& staging_;
  std::vector<float> values_;
  std::map<vk::Buffer, std::vector<vk::BufferCopy>> copies_;
};

// One agent's records, as a block of which it is the first has them.
class Standing {
 public:
  explicit Standing(const Crowd::Impl& crowd, const Kind& kind) : crowd_(crowd), kind_(kind) {
    for (const PageBuffer& each : pageBuffers(crowd, kind)) {
      if (!each.record || !keeps(kind, crowd.options, *each.record)) continue;
      // The host says these by themselves, and a block has one rate.
      if (*each.record == Record::goal || *each.record == Record::hurt || *each.record == Record::carried ||
          *each.record == Record::push || *each.record == Record::rate || *each.record == Record::search)
        continue;
      const RecordInfo info = infoOf(*each.record);
      // What every tick makes anew can stay, and what measure has summed up shall.
      if (!info.spawned && !isHashed(*each.record, kind.controller) && *each.record != Record::flight)
        continue;
      const auto floats =
          static_cast<size_t>(4 * strideOf(*each.record, kind.legs, kind.bones, kind.clips.joints));
      const size_t count = info.per == Per::leg ? size_t{shared::BLOCK} * static_cast<size_t>(kind.legs) : 1;
      values_.of(*each.record).resize(floats * count);
      spans_.of(*each.record) = info.spawned ? std::span(values_.of(*each.record)) : std::span<float>();
      kept_.push_back(*each.record);
    }
  }

  void write(const Spawner& spawner, uint32_t agentOfRun, const Place& place, const Page& page,
             uint32_t agent, Writes& writes) {
    spawner.stand(agentOfRun, place, 0, spans_);
    for (const Record record : kept_) {
      const bool ofLegs = infoOf(record).per == Per::leg;
      const int legs = ofLegs ? kind_.legs : 1;
      const std::span<const float> all = values_.of(record);
      const size_t floats = all.size() / (ofLegs ? size_t{shared::BLOCK} * static_cast<size_t>(legs) : 1);
      for (int leg = 0; leg < legs; ++leg) {
        const auto from = static_cast<size_t>(ofLegs ? shared::legRecord(0, leg, legs) : 0);
        const auto to = static_cast<uint64_t>(ofLegs ? shared::legRecord(static_cast<int>(agent), leg, legs)
                                                     : static_cast<int>(agent));
        writes.add(page.of(record), to * floats * sizeof(float), all.subspan(from * floats, floats));
      }
    }
    if (page.watch) forget(crowd_.tick, page, agent, writes);
  }

  // Every watched one's trail alone, of agents that begin before the next tick.
  void beginWatch(const Spawner& spawner, uint32_t agentOfRun, const Page& page, uint32_t agent,
                  Writes& writes) {
    if (!page.watch || !slotOf(crowd_.tick + 1, page, agent)) return;
    const auto start = spawner.place(agentOfRun);
    spawner.stand(agentOfRun, {{start.x, start.z}, start.heading}, 0, spans_);
    forget(crowd_.tick + 1, page, agent, writes);
  }

 private:
  // Where the watched agent's trail is in that tick.
  std::optional<uint32_t> slotOf(uint64_t tick, const Page& page, uint32_t agent) const {
    const Watch watch = watchAt(tick, crowd_.watchEvery, page);
    if (agent < watch.first || (agent - watch.first) % crowd_.watchEvery != 0) return {};
    const uint32_t slot = (agent - watch.first) / crowd_.watchEvery;
    return slot < watch.count ? std::optional(slot) : std::nullopt;
  }

  // measure goes on from where the agent is now, as if it had stood there.
  void forget(uint64_t tick, const Page& page, uint32_t agent, Writes& writes) {
    const std::optional<uint32_t> slot = slotOf(tick, page, agent);
    if (!slot) return;
    std::vector<float> trail(static_cast<size_t>(4 * shared::watchStride(kind_.legs)));
    const float* body = values_.body.data();
    std::copy_n(body, 3, trail.data());
    for (int leg = 0; leg < kind_.legs; ++leg) {
      float* at = trail.data() + 4 * shared::WATCH_TRAIL_STRIDE * (1 + leg);
      const float* tip = values_.tip.data() + 4 * shared::TIP_STRIDE * shared::legRecord(0, leg, kind_.legs);
      for (int i = 0; i < 3; ++i) at[i] = tip[i] + body[i];
      at[3] = shared::WATCH_AIR;
    }
    writes.add(page.watch, uint64_t{*slot} * trail.size() * sizeof(float), trail);
  }

  const Crowd::Impl& crowd_;
  const Kind& kind_;
  ForRecords<std::vector<float>> values_;
  SpawnRecords spans_;
  std::vector<Record> kept_;
};

// Lists the legs of a page's agents for ik's second dispatch.
void list(const Kind& kind, const Page& page, std::span<const uint32_t> agents, Writes& writes) {
  std::vector<float> legs;
  for (const uint32_t agent : agents)
    for (int leg = 0; leg < kind.legs; ++leg)
      legs.push_back(std::bit_cast<float>(
          static_cast<uint32_t>(shared::legRecord(static_cast<int>(agent), leg, kind.legs))));
  const auto count = static_cast<uint32_t>(legs.size());
  const float groups = std::bit_cast<float>(gpu::groupsFor(count, shared::WORK_GROUP));
  const float listed = std::bit_cast<float>(count);
  writes.add(page.list, 0, legs);
  writes.add(page.counters, sizeof(uint32_t) * shared::COUNTER_IK_DISPATCH_X, std::span(&groups, 1));
  writes.add(page.counters, sizeof(uint32_t) * shared::COUNTER_IK_LISTED, std::span(&listed, 1));
}

// The agent's legs, and what it carries.
void writeLegs(const AgentChange& change, const Page& page, uint32_t agent, Kind& kind, Writes& writes) {
  const std::vector<float> record = kind.hurtRecordOf(change.agent);
  writes.add(page.hurt, uint64_t{agent} * record.size() * sizeof(float), record);
  const CarriedRecord carried = carriedRecord(kind.carriedBy(change.agent));
  writes.add(page.carried, uint64_t{agent} * sizeof carried, carried);
}

// An agent that comes has tried nothing, nor has one that is hurt as it stands anew.
void forgetSearch(const Page& page, uint32_t agent, Writes& writes) {
  constexpr std::array<float, 4 * shared::SEARCH_STRIDE> none{};
  writes.add(page.search, uint64_t{agent} * sizeof none, none);
}

// The agent was put there, or taken away: pictures do not lead it there from where it was.
void writePut(const Page& page, uint32_t agent, uint64_t tick, Writes& writes) {
  constexpr uint64_t put = 3;  // the float of a rate record
  const auto before = static_cast<float>(tick);
  writes.add(page.rate, (uint64_t{agent} * 4 * shared::RATE_STRIDE + put) * sizeof(float),
             std::span(&before, 1));
}

// An empty place sleeps, which avoid would say later.
void writeAsleep(const Page& page, uint32_t agent, Writes& writes) {
  constexpr std::array record = {0.0f, 0.0f, 1.0f, 0.0f};
  writes.add(page.avoid, uint64_t{agent} * sizeof record, record);
}

// Who does not begin anew stirs: a sleeper would not see what happens to it.
void stir(const Page& page, uint32_t agent, Writes& writes) {
  constexpr uint64_t still = 13;  // the float of a body record
  constexpr float stirs = 0;
  writes.add(page.body, uint64_t{agent} * sizeof(BodyRecord) + still * sizeof(float), std::span(&stirs, 1));
  constexpr uint64_t asleep = 2;  // the float of an avoid record
  if (page.avoid)
    writes.add(page.avoid, (uint64_t{agent} * 4 * shared::AVOID_STRIDE + asleep) * sizeof(float),
               std::span(&stirs, 1));
}

// For that tick.
void writePush(const glm::vec2& push, const Page& page, uint32_t agent, uint64_t tick, Writes& writes) {
  const std::array record = {push.x, push.y, 0.0f, static_cast<float>(tick)};
  writes.add(page.push, uint64_t{agent} * sizeof record, record);
}

struct Stood {
  const Kind* kind;
  const Page* page;
  std::vector<uint32_t> agents;  // of the page
};

// Brings the chains of those who stand anew to their feet, and only these.
void settle(const Crowd::Impl& crowd, const std::vector<Stood>& stood, vk::CommandBuffer cmd) {
  const Frame before(crowd, crowd.kinds, crowd.tick - 1, cmd);
  gpu::transferToCompute(cmd);
  for (int i = 0; i < settleIterations; ++i) {
    for (const Stood& each : stood) before.solveListed(*each.kind, *each.page);
    gpu::computeToCompute(cmd);
  }
  gpu::computeToTransfer(cmd);
  clearLists(crowd.kinds, cmd);
}

}  // namespace

bool changesWait(const Crowd::Impl& crowd) {
  return std::ranges::any_of(crowd.kinds, [](const Kind& kind) { return !kind.changes.empty(); });
}

void recordChanges(Crowd::Impl& crowd, vk::CommandBuffer cmd) {
  if (!changesWait(crowd)) return;
  Writes writes(cmd, crowd.edits.staging());
  std::vector<Stood> stood;
  for (uint32_t k = 0; k < crowd.kinds.size(); ++k) {
    Kind& kind = crowd.kinds[k];
    if (kind.changes.empty()) continue;
    Standing standing(crowd, kind);
    const bool settles = solverOf(kind).has_value();
    auto page = kind.pages.begin();
    const std::vector<HerdRun> runs = runsOf(crowd, k);
    auto of = runs.begin();
    for (const AgentChange& change : kind.changes.take()) {
      while (change.agent >= page->firstAgent + page->agents) ++page;
      const uint32_t agent = change.agent - page->firstAgent;
      const uint64_t goal = uint64_t{agent} * sizeof change.record;
      if (change.goal)
        writes.add(page->goal, goal, change.record);
      else if (change.speed)
        writes.add(page->goal, goal + 4 * sizeof(float), std::span(change.record).subspan(4, 1));
      if (change.leaves) writes.add(page->body, uint64_t{agent} * sizeof(BodyRecord), absentBody());
      if (change.leaves && page->avoid) writeAsleep(*page, agent, writes);
      if ((change.leaves || change.stands) && page->rate) writePut(*page, agent, crowd.tick, writes);
      if (change.hurt) writeLegs(change, *page, agent, kind, writes);
      if (change.hurt && change.stands && page->search) forgetSearch(*page, agent, writes);
      if (change.push) writePush(*change.push, *page, agent, crowd.tick, writes);
      if ((change.hurt || change.push) && !change.stands) stir(*page, agent, writes);
      if (!change.stands) continue;
      while (change.agent >= of->run->firstAgent + of->run->agents) ++of;
      standing.write(spawnerOf(crowd, *of->herd, *of->run), change.agent - of->run->firstAgent,
                     *change.stands, *page, agent, writes);
      if (!settles) continue;
      if (stood.empty() || stood.back().page != &*page) stood.push_back({&kind, &*page, {}});
      stood.back().agents.push_back(agent);
    }
  }
  for (const Stood& each : stood) list(*each.kind, *each.page, each.agents, writes);
  writes.flush();
  if (!stood.empty()) settle(crowd, stood, cmd);
}

void applyChanges(Crowd::Impl& crowd) {
  if (!changesWait(crowd)) return;
  ++crowd.tick;  // the one that would carry them
  gpu::submitAndWait(*crowd.context, [&](vk::CommandBuffer cmd) {
    gpu::allToAll(cmd);
    recordChanges(crowd, cmd);
    gpu::allToAll(cmd);
  });
  --crowd.tick;
}

void beginWatch(const Crowd::Impl& crowd, uint32_t kind, vk::CommandBuffer cmd) {
  Writes writes(cmd, crowd.edits.staging());
  Standing standing(crowd, crowd.kinds[kind]);
  for (const HerdRun& of : runsOf(crowd, kind)) {
    const Spawner spawner = spawnerOf(crowd, *of.herd, *of.run);
    for (const Part& part : partsOf(crowd, *of.run))
      for (uint32_t i = 0; i < part.agents; ++i)
        standing.beginWatch(spawner, part.firstAgent + i, *part.page, part.first + i, writes);
  }
  writes.flush();
}

}  // namespace skitter::crowd
