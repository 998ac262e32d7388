#include "crowd/ways/trails.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "base/split_mix.h"
#include "crowd/herd.h"
#include "crowd/radius.h"
#include "crowd/ways/stops.h"
#include "embedded/forage_fade_comp.h"
#include "embedded/forage_lay_comp_storage.h"
#include "embedded/forage_lay_comp_texel.h"
#include "embedded/forage_lay_levels_comp_storage.h"
#include "embedded/forage_lay_levels_comp_texel.h"
#include "gpu/barrier.h"
#include "gpu/context.h"
#include "gpu/submit.h"
#include "gpu/transfer.h"
#include "ways/ground.h"

namespace skitter {
namespace crowd {
namespace {

constexpr double whole32 = 4294967296.0;
uint32_t grainsOf(float units) {
  return static_cast<uint32_t>(std::lround(double{units} * shared::GRAINS_A_UNIT));
}

uint32_t as32(double share) {
  return static_cast<uint32_t>(std::min(std::floor(whole32 * share), whole32 - 1));
}

int inQuanta(float metres) { return static_cast<int>(std::lround(double{metres} * shared::FORAGE_QUANTA)); }

// Whether the cell's middle is within that disc, or the disc's within the cell.
bool isPlace(const CostGrid& grid, size_t cell, const glm::vec2& centre, float radius) {
  return glm::distance(middleOf(grid, cell), glm::dvec2(centre)) <= double{radius} ||
         cellAt(grid, centre) == cell;
}

int placeOfCell(const Forage& forage, const CostGrid& grid, size_t cell) {
  using namespace shared;
  if (isPlace(grid, cell, forage.nest.centre, forage.nest.radius)) return PLACE_NEST;
  for (size_t s = 0; s < forage.food.size(); ++s)
    if (isPlace(grid, cell, forage.food[s].centre, forage.food[s].radius))
      return PLACE_FOOD + static_cast<int>(s);
  for (size_t b = 0; b < forage.branches.size(); ++b)
    if (isPlace(grid, cell, forage.branches[b].centre, forage.branches[b].radius))
      return PLACE_BRANCH + static_cast<int>(b);
  return PLACE_NONE;
}

// A bit for each direction in which a move is open. From an impassable cell, any that leads out.
uint32_t movesFrom(const CostGrid& grid, size_t cell) {
  const glm::ivec2 at(cell % grid.columns, cell / grid.columns);
  const bool leadsOut = !skitter::ways::isPassable(grid, at);
  uint32_t moves = 0;
  for (uint32_t d = 0; d < skitter::ways::directionCount; ++d) {
    const bool isOpen = leadsOut ? skitter::ways::isPassable(grid, at + skitter::ways::stepOf(d))
                                 : skitter::ways::isOpen(grid, at, d);
    if (isOpen) moves |= 1u << d;
  }
  return moves;
}

CostGrid trailGridFor(const Crowd::Impl& crowd, const Kind& kind) {
  const Heightfield& terrain = crowd.terrain;
  return costGrid(
      terrain, crowd.scene.obstacles,
      {.legLength = kind.rig.legLength,
       .footprint = footprintRadius(kind.rig),
       .margin = kind.parameters.edgeMargin,
       .ways = kind.wayfaring->ways,
       .cell = Trails::cellOf(*kind.wayfaring->forage, std::max(terrain.extentX(), terrain.extentZ()))});
}

}  // namespace

uint32_t ForageNumbers::leaveOf(const Forage& forage, double dt) {
  return forage.rest > 0 ? as32(dt / double{forage.rest}) : std::numeric_limits<uint32_t>::max();
}

uint64_t ForageNumbers::everyOf(double dt) {
  return dt > 0 ? static_cast<uint64_t>(std::max(1ll, std::llround(1 / dt))) : 1;
}

uint32_t ForageNumbers::evaporationOf(const Forage& forage, double dt) {
  return as32(1 - std::exp(-static_cast<double>(everyOf(dt)) * dt / double{forage.life}));
}

ForageNumbers numbersOf(const Forage& forage) {
  return {grainsOf(forage.threshold), grainsOf(forage.layHome), grainsOf(forage.layOut)};
}

float Trails::cellOf(const Forage& forage, float longestSide) {
  const double least = std::max(double{forage.cell}, double{longestSide} / mostCellsASide);
  return static_cast<float>(std::ceil(least * shared::FORAGE_QUANTA) / shared::FORAGE_QUANTA);
}

Trails::Trails(const gpu::Context& context, const Forage& forage, uint64_t seed, const CostGrid& grid,
               bool levels)
    : context_(&context), forage_(forage), seed_(seed) {
  using namespace shared;
  using enum gpu::BindingKind;
  gpu::KernelInfo lay{"forage_lay",
                      {embedded::forage_lay_comp_texel(), embedded::forage_lay_comp_storage()},
                      {{BINDING_LAY_FORAGER, load4}, {BINDING_LAY_TRAIL, store}},
                      sizeof(TrailConstants)};
  if (levels) {
    lay.code = {embedded::forage_lay_levels_comp_texel(), embedded::forage_lay_levels_comp_storage()};
    lay.bindings.push_back({BINDING_LAY_RATE, load4});
  }
  lay_ = gpu::Kernel(context, lay);
  fade_ = gpu::Kernel(
      context,
      {"forage_fade", embedded::forage_fade_comp(), {{BINDING_LAY_TRAIL, store}}, sizeof(TrailConstants)});
  const size_t cells = grid.cost.size();
  ground_ = gpu::Buffer(context, (FORAGE_CELLS + cells) * sizeof(uint32_t), "forage ground");
  trail_ = gpu::Buffer(context, (TRAIL_CELLS + cells) * sizeof(uint32_t), "trail");
  gpu::clear(context, trail_);
  faded_ = fade_.bind(context, {{BINDING_LAY_TRAIL, &trail_}});
  setGrid(grid);
}

void Trails::setGrid(const CostGrid& grid) {
  using namespace shared;
  grid_ = grid;
  ++revision_;
  const ForageNumbers numbers = numbersOf(forage_);
  const size_t nest = cellAt(grid, forage_.nest.centre);
  std::vector<uint32_t> words(FORAGE_CELLS + grid.cost.size(), 0);
  words[FORAGE_COLUMNS] = grid.columns;
  words[FORAGE_ROWS] = grid.rows;
  words[FORAGE_CELL] = static_cast<uint32_t>(inQuanta(grid.cell));
  words[FORAGE_ORIGIN_X] = std::bit_cast<uint32_t>(inQuanta(grid.origin.x));
  words[FORAGE_ORIGIN_Z] = std::bit_cast<uint32_t>(inQuanta(grid.origin.y));
  words[FORAGE_NEST_COLUMN] = static_cast<uint32_t>(nest % grid.columns);
  words[FORAGE_NEST_ROW] = static_cast<uint32_t>(nest / grid.columns);
  words[FORAGE_SEED_LOW] = static_cast<uint32_t>(seed_);
  words[FORAGE_SEED_HIGH] = static_cast<uint32_t>(seed_ >> 32);
  words[FORAGE_THRESHOLD] = numbers.threshold;
  words[FORAGE_POWER] = forage_.power;
  words[FORAGE_LAY_HOME] = numbers.layHome;
  words[FORAGE_LAY_OUT] = numbers.layOut;
  words[FORAGE_PATIENCE] = forage_.patience;
  for (size_t s = 0; s < forage_.food.size(); ++s) words[FORAGE_AMOUNTS + s] = forage_.food[s].amount;
  for (size_t cell = 0; cell < grid.cost.size(); ++cell)
    words[FORAGE_CELLS + cell] =
        movesFrom(grid, cell) | static_cast<uint32_t>(placeOfCell(forage_, grid, cell)) << FORAGE_PLACE_SHIFT;
  gpu::upload(*context_, ground_, words);
}

void Trails::bind(Page& page) const {
  using namespace shared;
  std::vector<gpu::Binding> buffers = {{BINDING_LAY_FORAGER, &page.forager}, {BINDING_LAY_TRAIL, &trail_}};
  if (page.rate) buffers.push_back({BINDING_LAY_RATE, &page.rate});
  page.laid = lay_.bind(*context_, buffers);
  const TrailConstants nothing{};
  gpu::submitAndWait(*context_, [&](vk::CommandBuffer cmd) {
    lay_.dispatch(cmd, page.laid, gpu::bytesOf(nothing), 1);
    gpu::computeToCompute(cmd);
    fade_.dispatch(cmd, faded_, gpu::bytesOf(nothing), 1);
    gpu::allToAll(cmd);
  });
}

void Trails::record(vk::CommandBuffer cmd, std::span<const Page> pages, uint64_t tick, float dt) const {
  using shared::TrailConstants;
  for (const Page& page : pages) {
    const TrailConstants constants{.count = page.agents, .evaporation = 0, .tick = static_cast<float>(tick)};
    lay_.dispatch(cmd, page.laid, gpu::bytesOf(constants), gpu::groupsFor(page.agents, shared::WORK_GROUP));
  }
  gpu::computeToCompute(cmd);
  if (tick % ForageNumbers::everyOf(double{dt}) != 0) return;
  const auto cells = static_cast<uint32_t>(grid_.cost.size());
  const TrailConstants constants{.count = cells,
                                 .evaporation = ForageNumbers::evaporationOf(forage_, double{dt}),
                                 .tick = static_cast<float>(tick)};
  fade_.dispatch(cmd, faded_, gpu::bytesOf(constants), gpu::groupsFor(cells, shared::WORK_GROUP));
  gpu::computeToCompute(cmd);
}

std::vector<uint32_t> Trails::groundWords() const { return gpu::download<uint32_t>(*context_, ground_); }

std::vector<uint32_t> Trails::trailWords() const { return gpu::download<uint32_t>(*context_, trail_); }

void beginTrails(Crowd::Impl& crowd, uint32_t k) {
  Kind& kind = crowd.kinds[k];
  if (!kind.forages()) return;
  kind.trails = std::make_unique<Trails>(*crowd.context, *kind.wayfaring->forage,
                                         base::SplitMix64::draw(crowd.seed, uint64_t{k} + 1),
                                         trailGridFor(crowd, kind), crowd.rates.has_value());
}

void bindTrails(const Crowd::Impl&, Kind& kind) {
  if (!kind.trails) return;
  for (Page& page : kind.pages) kind.trails->bind(page);
}

void recordTrails(const Crowd::Impl& crowd, vk::CommandBuffer cmd) {
  for (const Kind& kind : crowd.kinds)
    if (kind.trails) kind.trails->record(cmd, kind.pages, crowd.tick, crowd.dt);
}

void renewTrails(Crowd::Impl& crowd) {
  if (!forages(crowd)) return;
  crowd.context->waitIdle();
  for (Kind& kind : crowd.kinds)
    if (kind.trails) kind.trails->setGrid(trailGridFor(crowd, kind));
}

uint64_t bytesOfTrail(const Crowd::Impl& crowd, const Kind& kind) {
  if (!kind.forages()) return 0;
  return (shared::TRAIL_CELLS + trailGridFor(crowd, kind).cost.size()) * sizeof(uint32_t);
}

bool forages(const Crowd::Impl& crowd) {
  return std::ranges::any_of(crowd.kinds, [](const Kind& kind) { return kind.trails != nullptr; });
}

}  // namespace crowd

Foraging Crowd::foraging(uint32_t herd) const {
  using namespace shared;
  Foraging done;
  const crowd::Kind& kind = impl_->kindOf(herd);
  if (!kind.trails) return done;
  impl_->context->waitIdle();
  const std::vector<uint32_t> words = kind.trails->trailWords();
  const Forage& forage = kind.trails->forage();
  done.brought = words[DEED_BROUGHT];
  done.empty = words[DEED_EMPTY];
  for (size_t s = 0; s < forage.food.size(); ++s) done.taken.push_back(words[PLACE_FOOD + DEED_AT + s]);
  for (size_t b = 0; b < forage.branches.size(); ++b)
    done.passed.push_back(words[PLACE_BRANCH + DEED_AT + b]);
  return done;
}

PheromoneGrid Crowd::pheromone(uint32_t herd) const {
  PheromoneGrid made;
  const crowd::Kind& kind = impl_->kindOf(herd);
  if (!kind.trails) return made;
  impl_->context->waitIdle();
  const CostGrid& grid = kind.trails->grid();
  made = {.columns = grid.columns, .rows = grid.rows, .cell = grid.cell, .origin = grid.origin};
  const std::vector<uint32_t> words = kind.trails->trailWords();
  for (size_t cell = 0; cell < grid.cost.size(); ++cell)
    made.units.push_back(static_cast<float>(words[shared::TRAIL_CELLS + cell]) / shared::GRAINS_A_UNIT);
  return made;
}

}  // namespace skitter
