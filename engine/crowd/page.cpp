#include "crowd/page.h"

#include <algorithm>
#include <bit>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>

#include "crowd/grid.h"
#include "crowd/record.h"
#include "crowd/stage.h"
#include "gpu/barrier.h"
#include "gpu/context.h"
#include "gpu/submit.h"
#include "gpu/transfer.h"
#include "skitter/error.h"

namespace skitter::crowd {
namespace {

constexpr uint32_t kMostPageAgents = 65536;

}  // namespace

uint32_t Kind::herdOf(uint64_t agent) const {
  return static_cast<uint32_t>(std::ranges::upper_bound(firstAgents, agent) - firstAgents.begin()) - 1;
}

gpu::Binding bindingOf(const Crowd::Impl& crowd, const Kind& kind, const Page& page, uint32_t binding) {
  using namespace shared;
  if (const std::optional<Record> record = recordAt(binding)) return {binding, &page.of(*record)};
  switch (binding) {
    case BINDING_PARAMETERS:
      return {binding, &kind.parameterBlock};
    case BINDING_HEIGHTS:
      return {binding, &crowd.heights};
    case BINDING_RIG:
      return {binding, &kind.rigBuffer};
    case BINDING_KEY:
      return {binding, &kind.keyBuffer};
    case BINDING_CLIP:
      return {binding, &kind.clipHeads};
    case BINDING_CLIP_FRAME:
      return {binding, &kind.clipTimes};
    case BINDING_CLIP_ROW:
      return {binding, &kind.clipRows};
    case BINDING_CLIP_LEG:
      return {binding, &kind.clipLegs};
    case BINDING_CLIP_JOINT:
      return {binding, &kind.clipBones};
    case BINDING_LIST:
      return {binding, &page.list};
    case BINDING_COUNTERS:
      return {binding, &page.counters};
    case BINDING_HISTOGRAM:
      return {binding, &page.histogram};
    case BINDING_AWAKE:
    case BINDING_AWAKE_OUT:
      return {binding, &page.awake};
    case BINDING_FOOTFALL_OUT:
      return {binding, &page.footfall};
    case BINDING_CELL:
      return {binding, &crowd.grid->cells};
    case BINDING_PLACE:
      return {binding, &crowd.grid->places};
    case BINDING_WALKER:
      return {binding, &crowd.grid->walkers};
    case BINDING_WAY:
      return {binding, &kind.ways->records()};
    case BINDING_FORAGE_GROUND:
      return {binding, &kind.trails->ground()};
    case BINDING_TRAIL:
      return {binding, &kind.trails->trail()};
    case BINDING_GAIT_MAP:
      return {binding, &kind.gaitMapBuffer};
    case BINDING_WALL:
      return {binding, &kind.wallBuffer};
    case BINDING_LEVELS:
      return {binding, &crowd.rates->words};
    case BINDING_CROWDING:
      return {binding, &crowd.grid->crowding};
    default:
      throw std::logic_error("a stage has binding " + std::to_string(binding) +
                             ", which nothing is bound to");
  }
}

gpu::Bindings bindingsOf(const Crowd::Impl& crowd, const Kind& kind, const Page& page,
                         const ReadyStage& stage) {
  // Avoid's velocity takes the place of navigate's.
  const bool isSteered = kind.avoids && !stage.makes.has(StageId::avoid);
  std::vector<gpu::Binding> list;
  for (const gpu::BindingDecl& declared : stage.bindings) {
    list.push_back(bindingOf(crowd, kind, page, declared.binding));
    if (isSteered && declared.binding == shared::BINDING_STEER) list.back().resource = &page.avoid;
  }
  return stage.first.bind(*crowd.context, list);
}

bool keeps(const Kind& kind, const CrowdOptions& options, Record record) {
  bool read = false, written = false;
  for (const Stage& stage : kind.stages)
    for (const gpu::BindingDecl& declared : stage.bindings)
      if (recordAt(declared.binding) == record) (isWritten(declared.binding) ? written : read) = true;
  switch (infoOf(record).kept) {
    case Kept::always:
      return true;
    case Kept::bound:
      return read || written;
    case Kept::hurt:
      return kind.hurts;
    case Kept::exchanged:
      break;
  }
  return options.feet ? read || written : read && written;
}

namespace {

// The herd of that place; one without agents in the page has none.
Part partOf(const Kind& kind, uint32_t herd, const Page& page) {
  const auto begin = static_cast<uint32_t>(kind.firstAgents[herd]);
  const auto end =
      static_cast<uint32_t>(herd + 1 < kind.firstAgents.size() ? kind.firstAgents[herd + 1] : kind.agents);
  const uint32_t from = std::max(begin, page.firstAgent), to = std::min(end, page.firstAgent + page.agents);
  return {.kind = &kind,
          .page = &page,
          .firstAgent = from - begin,
          .first = from - page.firstAgent,
          .agents = to > from ? to - from : 0,
          .row = herd - kind.herdOf(page.firstAgent)};
}

// Where the page's herds begin, for shaders to look up an agent's.
void uploadHerds(const gpu::Context& context, const Kind& kind, const Page& page) {
  const int rows = 1 << kind.herdSteps;
  std::vector<uint32_t> begins(static_cast<size_t>(rows), UINT32_MAX);
  const uint32_t first = kind.herdOf(page.firstAgent);
  const uint32_t last = kind.herdOf(page.firstAgent + page.agents - 1);
  for (uint32_t herd = first; herd <= last; ++herd) begins[herd - first] = partOf(kind, herd, page).first;
  gpu::uploadBytes(context, page.counters, std::as_bytes(std::span(begins)),
                   bytesOfCounters(shared::counterHerd(0, rows)));
}

// What is spawned is written once, to where the device copies it from; all else begins as zeros, and so does
// everything without spawners.
void spawn(const gpu::Context& context, const std::vector<PageBuffer>& buffers, const Kind& kind,
           std::span<const Spawner> spawners, const gpu::HostBuffer& staging, const Page& page) {
  SpawnRecords records;
  gpu::submitAndWait(context, [&](vk::CommandBuffer cmd) {
    uint64_t end = 0;
    for (const PageBuffer& each : buffers) {
      const gpu::Buffer& buffer = each.in(page);
      if (!each.spawned || spawners.empty()) {
        cmd.fillBuffer(buffer.handle(), 0, VK_WHOLE_SIZE, 0);
        continue;
      }
      records.of(*each.record) =
          staging.as<float>().subspan(end / sizeof(float), buffer.size() / sizeof(float));
      cmd.copyBuffer(staging.handle(), buffer.handle(),
                     vk::BufferCopy{.srcOffset = end, .size = buffer.size()});
      end += buffer.size();
    }
    gpu::allToAll(cmd);
    for (uint32_t herd = 0; herd < spawners.size(); ++herd)
      if (const Part part = partOf(kind, herd, page); part.agents > 0)
        spawners[herd].write(part.firstAgent, part.agents, part.first, records);
  });
}

}  // namespace

namespace {

bool binds(const Kind& kind, Record record) {
  return std::ranges::any_of(kind.stages, [&](const Stage& stage) {
    return std::ranges::any_of(stage.bindings, [&](const gpu::BindingDecl& declared) {
      return recordAt(declared.binding) == record;
    });
  });
}

PageBuffer recordBuffer(const Crowd::Impl& crowd, const Kind& kind, Record record) {
  const RecordInfo info = infoOf(record);
  PageBuffer made{.name = info.name, .bytes = bytesOfRecord(kind, record), .record = record};
  if (info.per == Per::leg) {
    made.bytes *= static_cast<uint64_t>(kind.legs);
    made.inBlocks = true;
  }
  if (info.per == Per::watched) made.agents = crowd.watchEvery;
  if (keeps(kind, crowd.options, record))
    made.spawned = info.spawned;
  else
    made.most = made.bytes;
  return made;
}

}  // namespace

uint64_t bytesOfRecord(const Kind& kind, Record record) {
  return 16 * static_cast<uint64_t>(strideOf(record, kind.legs, kind.bones, kind.clips.joints));
}

std::vector<PageBuffer> pageBuffers(const Crowd::Impl& crowd, const Kind& kind) {
  using namespace shared;
  constexpr uint32_t aPage = UINT32_MAX;
  const int rows = 1 << kind.herdSteps;
  const CrowdOptions& options = crowd.options;
  const auto legs = static_cast<uint64_t>(kind.legs);
  std::vector<PageBuffer> buffers;
  for (const Record record : allRecords)
    if (keeps(kind, options, record) || binds(kind, record))
      buffers.push_back(recordBuffer(crowd, kind, record));
  buffers.push_back({.name = "list", .bytes = legs * sizeof(uint32_t), .buffer = &Page::list});
  if (options.measure)
    buffers.push_back({.name = "histogram",
                       .bytes = bytesOfCounters(rows * HISTOGRAM_BUCKETS),
                       .buffer = &Page::histogram,
                       .agents = aPage});
  if (options.footfalls > 0)
    buffers.push_back({.name = "footfall",
                       .bytes = legs * FOOTFALL_STRIDE * 16,
                       .buffer = &Page::footfall,
                       .most = uint64_t{options.footfalls} * FOOTFALL_STRIDE * 16});
  if (kind.tinted) buffers.push_back({.name = "tint", .bytes = 16, .buffer = &Page::tint});
  // The last work group reads on after the list's end.
  constexpr uint64_t anEntry = AWAKE_STRIDE * 16;
  PageBuffer awake{.name = "awake", .bytes = anEntry, .buffer = &Page::awake, .agents = BLOCK};
  if (kind.rests(options))
    awake.more = WORK_GROUP * anEntry;
  else
    awake.most = anEntry;
  buffers.push_back(awake);
  buffers.push_back({.name = "counters",
                     .bytes = bytesOfCounters(counterHerd(rows, rows)),
                     .buffer = &Page::counters,
                     .agents = aPage,
                     .use = gpu::BufferUse::indirect});
  return buffers;
}

uint32_t agentsPerPage(const Crowd::Impl& crowd, const Kind& kind) {
  using shared::BLOCK;
  const gpu::Context& context = *crowd.context;
  uint64_t limit = context.limits().maxStorageBufferRange;
  if (context.texelLoads()) limit = std::min(limit, context.limits().maxTexelBufferElements * 16);
  uint64_t agents =
      crowd.options.pageAgents > 0 ? std::min(crowd.options.pageAgents, kMostPageAgents) : kMostPageAgents;
  std::vector<PageBuffer> buffers = pageBuffers(crowd, kind);
  // Where the crowd has no poses of agents that play clips, a renderer makes as many as a page has agents.
  if (kind.controller == Controller::clip) buffers.push_back(recordBuffer(crowd, kind, Record::pose));
  for (const PageBuffer& buffer : buffers) {
    const uint64_t fit = limit / buffer.bytes * buffer.agents;
    agents = std::min(agents, buffer.inBlocks ? fit / BLOCK * BLOCK : fit);
    if (agents == 0)
      throw deviceError(context.report().name + ": a binding reaches " + std::to_string(limit) +
                        " bytes, one agent's " + buffer.name + " needs " + std::to_string(buffer.bytes));
  }
  // Blocks have numbers throughout a kind, however it is paged.
  if (crowd.options.levels) agents = std::max<uint64_t>(agents / BLOCK, 1) * BLOCK;
  return static_cast<uint32_t>(agents);
}

int herdStepsOf(const Crowd::Impl& crowd, const Kind& kind) {
  const uint64_t most = agentsPerPage(crowd, kind);
  uint32_t rows = 1;
  for (uint64_t first = 0; first < kind.agents; first += most) {
    const uint64_t last = std::min(first + most, kind.agents) - 1;
    rows = std::max(rows, kind.herdOf(last) - kind.herdOf(first) + 1);
  }
  return std::bit_width(rows - 1);
}

uint64_t bytesOf(const Crowd::Impl& crowd, const Kind& kind) {
  const std::vector<PageBuffer> buffers = pageBuffers(crowd, kind);
  const uint32_t most = agentsPerPage(crowd, kind);
  const auto ofPage = [&](uint64_t count) {
    uint64_t bytes = 0;
    for (const PageBuffer& buffer : buffers) bytes += buffer.bytesOf(static_cast<uint32_t>(count));
    return bytes;
  };
  return kind.agents / most * ofPage(most) + ofPage(kind.agents % most);
}

std::vector<Page> makePages(const Crowd::Impl& crowd, const Kind& kind, std::span<const Spawner> spawners) {
  const auto agents = static_cast<uint32_t>(kind.agents);
  const uint32_t most = std::min(agents, agentsPerPage(crowd, kind));
  const std::vector<PageBuffer> buffers = pageBuffers(crowd, kind);
  uint64_t staged = 0;
  for (const PageBuffer& each : buffers) staged += each.spawned ? each.bytesOf(most) : 0;
  const gpu::HostBuffer staging(*crowd.context, staged, gpu::HostUse::upload, "spawn staging");
  std::vector<Page> pages;
  for (uint32_t first = 0; first < agents; first += most) {
    Page& page = pages.emplace_back();
    page.firstAgent = first;
    page.agents = std::min(most, agents - first);
    for (const PageBuffer& each : buffers)
      each.in(page) = gpu::Buffer(*crowd.context, each.bytesOf(page.agents), each.name, each.use);
    page.footfallRoom = static_cast<uint32_t>(page.footfall.size() / (shared::FOOTFALL_STRIDE * 16));
    spawn(*crowd.context, buffers, kind, spawners, staging, page);
    if (kind.herdSteps > 0) uploadHerds(*crowd.context, kind, page);
    for (const ReadyStage& stage : kind.stages) {
      page.bindings.emplace_back();
      if (!stage.seesCrowd) page.bindings.back() = bindingsOf(crowd, kind, page, stage);
    }
  }
  return pages;
}

std::vector<Part> partsOf(const Crowd::Impl& crowd, const SizeRun& run) {
  std::vector<Part> parts;
  if (run.agents == 0) return parts;
  const Kind& kind = crowd.kinds[run.kind];
  for (const Page& page : kind.pages)
    if (const Part part = partOf(kind, run.place, page); part.agents > 0) parts.push_back(part);
  return parts;
}

std::vector<Part> partsOf(const Crowd::Impl& crowd, uint32_t herd) {
  std::vector<Part> parts;
  for (const SizeRun& run : crowd.herdAt(herd).runs)
    for (Part& part : partsOf(crowd, run)) {
      part.firstAgent += run.firstOfHerd;
      parts.push_back(part);
    }
  return parts;
}

CounterRow rowOf(const gpu::Context& context, const Part& part) {
  CounterRow row;
  gpu::downloadBytes(context, part.page->counters, std::as_writable_bytes(std::span(row)),
                     bytesOfCounters(shared::counterRow(static_cast<int>(part.row))));
  return row;
}

RunSample sampleOf(uint32_t firstAgent, uint32_t agents, const AgentSample& sample) {
  const uint32_t past = firstAgent > sample.first ? (firstAgent - sample.first) % sample.stride : 0;
  const uint32_t first = firstAgent <= sample.first ? sample.first - firstAgent
                         : past > 0                 ? sample.stride - past
                                                    : 0;
  return {first, agents > first ? (agents - first - 1) / sample.stride + 1 : 0};
}

}  // namespace skitter::crowd
