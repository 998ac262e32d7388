#include "crowd/grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <memory>

#include "crowd/page.h"
#include "crowd/radius.h"
#include "embedded/grid_count_comp_storage.h"
#include "embedded/grid_count_comp_texel.h"
#include "embedded/grid_overlap_comp_storage.h"
#include "embedded/grid_overlap_comp_texel.h"
#include "embedded/grid_place_comp_storage.h"
#include "embedded/grid_place_comp_texel.h"
#include "embedded/grid_scatter_comp_storage.h"
#include "embedded/grid_scatter_comp_texel.h"
#include "embedded/grid_sum_comp_storage.h"
#include "embedded/grid_sum_comp_texel.h"
#include "gpu/barrier.h"
#include "gpu/context.h"
#include "gpu/submit.h"
#include "gpu/transfer.h"
#include "skitter/error.h"

namespace skitter::crowd {
namespace {

// Squares of reaches must be ints.
constexpr uint32_t longestReachInQuanta = 32767;
constexpr float finestQuanta = 1024;  // in a metre
// Two cells are longer than any reach by this, for the float32 cell number of a place within 4 km, of cells
// of at least `leastCell`, errs by a 250th.
constexpr float cellMargin = 1.01f;
constexpr uint32_t leastCell = 128;  // quanta
constexpr double secondsATurn = 2;
constexpr double longestRound = 1.0 / 15 + 5e-7;  // seconds; a tick of 1/60 is a float
constexpr uint32_t mostRoundTicks = 4;
constexpr uint32_t leastBuckets = 256, leastRun = 64, mostRuns = 4096;

uint64_t agentsOf(const Crowd::Impl& crowd) {
  uint64_t agents = 0;
  for (const Kind& kind : crowd.kinds) agents += kind.agents;
  return agents;
}

// At least twice as many as agents, where bindings reach so many.
uint32_t bucketsFor(const Crowd::Impl& crowd) {
  const uint64_t wanted = std::bit_ceil(std::max<uint64_t>(2 * agentsOf(crowd), leastBuckets));
  return static_cast<uint32_t>(std::min(wanted, std::bit_floor(bytesABinding(*crowd.context) / 16)));
}

uint64_t walkerBytes(uint64_t agents) { return agents * shared::WALKER_PARTS * 16; }

bool hasGrid(const Crowd::Impl& crowd) { return crowd.options.crowding || avoids(crowd); }

template <class Each>
void eachPage(const Crowd::Impl& crowd, const Each& each) {
  for (const Kind& kind : crowd.kinds)
    for (const Page& page : kind.pages) each(kind, page);
}

void bindPages(Crowd::Impl& crowd) {
  using namespace shared;
  const Grid& grid = *crowd.grid;
  for (Kind& kind : crowd.kinds)
    for (Page& page : kind.pages) {
      page.counted =
          grid.count.bind(*crowd.context, {{BINDING_BODY, &page.body}, {BINDING_GRID_COUNT, &grid.counts}});
      page.scattered = grid.scatter.bind(*crowd.context, {{BINDING_BODY, &page.body},
                                                          {BINDING_GRID_CELL, &grid.cells},
                                                          {BINDING_GRID_COUNT, &grid.counts},
                                                          {BINDING_GRID_PLACE_OUT, &grid.places},
                                                          {BINDING_GRID_WALKER_OUT, &grid.walkers}});
      for (size_t i = 0; i < kind.stages.size(); ++i)
        if (kind.stages[i].seesCrowd) page.bindings[i] = bindingsOf(crowd, kind, page, kind.stages[i]);
    }
}

}  // namespace

uint64_t bytesABinding(const gpu::Context& context) {
  const uint64_t storage = context.limits().maxStorageBufferRange;
  return context.texelLoads() ? std::min(storage, uint64_t{context.limits().maxTexelBufferElements} * 16)
                              : storage;
}

uint32_t Quanta::radiusOf(const Kind& kind) const {
  return std::max(1u, static_cast<uint32_t>(std::lround(footprintRadius(kind.rig) * inMetre)));
}

uint32_t Quanta::lookOf(const Kind& kind) const {
  return static_cast<uint32_t>(std::lround(lookLegLengths * kind.rig.legLength * inMetre));
}

uint32_t Quanta::droppedBits() const {
  // The greatest power has its own key, and one that is greater is nobody's.
  constexpr uint64_t powers = (uint64_t{1} << (31 - shared::NEIGHBOUR_KEY_BITS)) - 1;
  uint32_t bits = 0;
  while (uint64_t{longestReach} * longestReach >> bits >= powers) ++bits;
  return bits;
}

Quanta quantaOf(const Crowd::Impl& crowd) {
  for (Quanta quanta{.inMetre = finestQuanta};; quanta.inMetre /= 2) {
    uint32_t widest = 0, farthest = 0;
    for (const Kind& kind : crowd.kinds)
      if (!kind.stages.empty()) widest = std::max(widest, quanta.radiusOf(kind));
    for (const Kind& kind : crowd.kinds)
      if (!kind.stages.empty())
        farthest = std::max(farthest, quanta.radiusOf(kind) + (kind.avoids ? quanta.lookOf(kind) : 0));
    quanta.longestReach = farthest + widest;
    if (quanta.longestReach <= longestReachInQuanta) return quanta;
  }
}

uint32_t turnOf(const Crowd::Impl& crowd) {
  const auto ticksATurn = std::max<int64_t>(1, std::llround(secondsATurn / double{crowd.dt}));
  return static_cast<uint32_t>(crowd.tick / static_cast<uint64_t>(ticksATurn));
}

uint32_t roundTicksOf(float dt) {
  uint32_t ticks = mostRoundTicks;
  while (ticks > 1 && ticks * double{dt} > longestRound) ticks /= 2;
  return ticks;
}

namespace {

// How avoid finds who looks around, in the bits above those that neighbours drop.
uint32_t roundBits(float dt, const Page& page, uint64_t tick) {
  const uint32_t ticks = roundTicksOf(dt);
  const auto block = static_cast<uint32_t>((ticks - tick % ticks) % ticks);
  return ticks << 8 | block << 12 | page.firstAgent % (ticks * shared::BLOCK) << 16;
}

}  // namespace

uint32_t lookersOf(const Page& page, float dt) {
  const uint32_t round = roundTicksOf(dt) * shared::BLOCK;
  return (page.firstAgent % round + page.agents + round - 1) / round * shared::BLOCK;
}

uint32_t numberOf(const Crowd::Impl& crowd, const Kind& kind) {
  uint64_t number = 0;
  for (const Kind& each : crowd.kinds) {
    if (&each == &kind) break;
    number += each.agents;
  }
  return static_cast<uint32_t>(number);
}

bool avoids(const Crowd::Impl& crowd) { return std::ranges::any_of(crowd.kinds, &Kind::avoids); }

uint64_t bytesOfGrid(const Crowd::Impl& crowd) {
  if (!hasGrid(crowd)) return 0;
  const uint64_t agents = agentsOf(crowd), buckets = bucketsFor(crowd);
  return buckets * (16 + 4) + agents * 16 + walkerBytes(agents);
}

Grid::Grid(const Crowd::Impl& crowd) : quanta(quantaOf(crowd)), buckets(bucketsFor(crowd)) {
  using namespace shared;
  using enum gpu::BindingKind;
  const gpu::Context& context = *crowd.context;
  const uint64_t agents = agentsOf(crowd), reach = bytesABinding(context);
  if (walkerBytes(agents) > reach)
    throw deviceError(fmt::format("{}: a binding reaches {} bytes, {} agents among whom some avoid need {}",
                                  context.report().name, reach, agents, walkerBytes(agents)));
  row = GRID_ROW(std::bit_width(buckets) - 1);
  run = std::max(leastRun, buckets / mostRuns);
  counts = gpu::Buffer(context, uint64_t{buckets} * 4, "grid counts");
  sums = gpu::Buffer(context, uint64_t{buckets / run} * 4, "grid sums");
  cells = gpu::Buffer(context, uint64_t{buckets} * 16, "grid cells");
  places = gpu::Buffer(context, agents * 16, "grid places");
  walkers = gpu::Buffer(context, walkerBytes(agents), "grid walkers");
  crowding = gpu::Buffer(context, shared::CROWDING_WORDS * 4, "crowding");

  const auto kernel = [&](const char* name, const gpu::ShaderCode& code,
                          std::vector<gpu::BindingDecl> bindings) {
    return gpu::Kernel(context, {name, code, std::move(bindings), sizeof(GridConstants)});
  };
  count = kernel("grid_count", {embedded::grid_count_comp_texel(), embedded::grid_count_comp_storage()},
                 {{BINDING_BODY, load4}, {BINDING_GRID_COUNT, store}});
  sum = kernel("grid_sum", {embedded::grid_sum_comp_texel(), embedded::grid_sum_comp_storage()},
               {{BINDING_GRID_COUNTED, load4}, {BINDING_GRID_SUM_OUT, store}});
  place = kernel("grid_place", {embedded::grid_place_comp_texel(), embedded::grid_place_comp_storage()},
                 {{BINDING_GRID_COUNTED, load4}, {BINDING_GRID_SUM, load4}, {BINDING_GRID_CELL_OUT, store}});
  scatter =
      kernel("grid_scatter", {embedded::grid_scatter_comp_texel(), embedded::grid_scatter_comp_storage()},
             {{BINDING_BODY, load4},
              {BINDING_GRID_CELL, load4},
              {BINDING_GRID_COUNT, store},
              {BINDING_GRID_PLACE_OUT, store},
              {BINDING_GRID_WALKER_OUT, store}});
  summed = sum.bind(context, {{BINDING_GRID_COUNTED, &counts}, {BINDING_GRID_SUM_OUT, &sums}});
  placed = place.bind(
      context, {{BINDING_GRID_COUNTED, &counts}, {BINDING_GRID_SUM, &sums}, {BINDING_GRID_CELL_OUT, &cells}});
  if (crowd.options.crowding) {
    overlap =
        kernel("grid_overlap", {embedded::grid_overlap_comp_texel(), embedded::grid_overlap_comp_storage()},
               {{BINDING_GRID_CELL, load4}, {BINDING_GRID_WALKER, load4}, {BINDING_GRID_CROWDING, store}});
    overlapped = overlap.bind(
        context,
        {{BINDING_GRID_CELL, &cells}, {BINDING_GRID_WALKER, &walkers}, {BINDING_GRID_CROWDING, &crowding}});
  }
  gpu::submitAndWait(context, [&](vk::CommandBuffer cmd) {
    cmd.fillBuffer(counts.handle(), 0, VK_WHOLE_SIZE, GRID_EMPTY);
    for (const gpu::Buffer* buffer : {&sums, &cells, &places, &walkers, &crowding})
      cmd.fillBuffer(buffer->handle(), 0, VK_WHOLE_SIZE, 0);
    gpu::allToAll(cmd);
  });
}

float Grid::cellsAQuantum() const {
  return 1 /
         std::max(cellMargin / 2 * static_cast<float>(quanta.longestReach), static_cast<float>(leastCell));
}

shared::GridConstants Grid::gridConstantsOf(const Crowd::Impl& crowd, const Kind& kind,
                                            const Page& page) const {
  return {.count = page.agents,
          .first = numberOf(crowd, kind) + page.firstAgent,
          .buckets = buckets,
          .row = row,
          .run = run,
          .quanta = quanta.inMetre,
          .cells = cellsAQuantum(),
          .radius = static_cast<float>(quanta.radiusOf(kind)),
          .avoids = kind.avoids ? 1.0f : 0.0f};
}

shared::TickConstants Grid::constantsOf(const Crowd::Impl& crowd, const Kind& kind, const Page& page,
                                        const Stage& stage, uint64_t tick) const {
  return {.count = page.agents,
          .tick = static_cast<float>(stage.makes.has(StageId::avoid) ? turnOf(crowd) : tick),
          .first = numberOf(crowd, kind) + page.firstAgent,
          .every = buckets,
          .watched = quanta.droppedBits() | roundBits(crowd.dt, page, tick),
          .room = quanta.lookOf(kind),
          .sleepTime = 1 / quanta.inMetre};
}

void Grid::record(const Crowd::Impl& crowd, vk::CommandBuffer cmd) const {
  const auto overAgents = [&](const gpu::Kernel& kernel, gpu::Bindings Page::*bindings) {
    eachPage(crowd, [&](const Kind& kind, const Page& page) {
      kernel.dispatch(cmd, page.*bindings, gpu::bytesOf(gridConstantsOf(crowd, kind, page)),
                      gpu::groupsFor(page.agents, shared::WORK_GROUP));
    });
    gpu::computeToCompute(cmd);
  };
  shared::GridConstants shape{};
  shape.count = buckets / run;
  shape.buckets = buckets;
  shape.row = row;
  shape.run = run;
  shape.quanta = quanta.inMetre;
  shape.cells = cellsAQuantum();
  const auto overRuns = [&](const gpu::Kernel& kernel, const gpu::Bindings& bindings) {
    kernel.dispatch(cmd, bindings, gpu::bytesOf(shape), gpu::groupsFor(shape.count, shared::WORK_GROUP));
    gpu::computeToCompute(cmd);
  };
  overAgents(count, &Page::counted);
  overRuns(sum, summed);
  overRuns(place, placed);
  overAgents(scatter, &Page::scattered);
  if (!overlap) return;
  overlap.dispatch(cmd, overlapped, gpu::bytesOf(shape),
                   gpu::groupsFor(static_cast<uint32_t>(agentsOf(crowd)), shared::WORK_GROUP));
  gpu::computeToCompute(cmd);
}

void shareGround(Crowd::Impl& crowd) {
  if (!crowd.grid && !hasGrid(crowd)) return;
  crowd.context->waitIdle();
  std::unique_ptr<Grid> before = std::move(crowd.grid);
  if (!hasGrid(crowd)) return;
  crowd.grid = std::make_unique<Grid>(crowd);
  bindPages(crowd);
  // No tick pays for the translation to machine code.
  gpu::submitAndWait(*crowd.context, [&](vk::CommandBuffer cmd) {
    crowd.grid->record(crowd, cmd);
    gpu::allToAll(cmd);
  });
  // That dispatch counted too, and belongs to no tick.
  std::vector<uint32_t> words(shared::CROWDING_WORDS);
  if (before) words = gpu::download<uint32_t>(*crowd.context, before->crowding);
  gpu::upload(*crowd.context, crowd.grid->crowding, words);
}

}  // namespace skitter::crowd

namespace skitter {

Crowding Crowd::crowding() const {
  Crowding crowding;
  if (!impl_->grid) return crowding;
  impl_->context->waitIdle();
  using namespace shared;
  const std::vector<uint32_t> words = gpu::download<uint32_t>(*impl_->context, impl_->grid->crowding);
  const auto wide = [&](size_t at) { return uint64_t{words[at + 1]} << 32 | words[at]; };
  const auto shares = [](auto number) { return static_cast<double>(number) / CROWDING_SHARES; };
  if (crowd::avoids(*impl_)) crowding.droppedNeighbours = wide(CROWDING_DROPPED);
  if (!impl_->options.crowding) return crowding;
  const auto agentTicks = static_cast<double>(std::max<uint64_t>(impl_->agentTicks, 1));
  crowding.overlapMost = shares(words[CROWDING_MOST]);
  crowding.overlapMean = shares(wide(CROWDING_OVERLAP)) / agentTicks;
  crowding.pairs = static_cast<double>(wide(CROWDING_PAIRS)) / agentTicks;
  return crowding;
}

}  // namespace skitter
