#include "skitter/colony.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "embedded/colony_judge_comp.h"
#include "embedded/colony_tighten_comp.h"
#include "embedded/colony_update_comp.h"
#include "embedded/colony_walk_comp.h"
#include "gpu/context.h"
#include "gpu/kernel.h"
#include "gpu/submit.h"
#include "gpu/transfer.h"
#include "shared/colony.h"
#include "skitter/error.h"
#include "ways/ground.h"

namespace skitter {
namespace {

constexpr uint32_t iterationsASubmission = 16;  // short enough for devices that end long submissions
// Mesa's software device ends all loops of an invocation once they have gone round 65,535 times. A pass of
// tightening has three loops over a trip, each of at most `steps` moves.
constexpr uint32_t loopsOfDispatch = 60000;
constexpr uint32_t mostIterations = (1u << 29) - 1;  // a trail holds the iteration and three bits

void checkRange(const char* name, double found, double least, double most) {
  if (!(found >= least && found <= most))
    throw inputError(fmt::format("{} of a colony is {}, expected {} to {}", name, found, least, most));
}

Colony::Options checkedOptions(Colony::Options options, const CostGrid& grid) {
  if (options.rule != ColonyRule::mmas && options.rule != ColonyRule::acs)
    throw inputError(fmt::format("the rule of a colony is {}, expected one of {}",
                                 static_cast<uint32_t>(options.rule), namesOf(allColonyRules)));
  if (options.steps == 0) options.steps = std::min(8 * (grid.columns + grid.rows), Colony::maxSteps);
  checkRange("ants", options.ants, 1, Colony::maxAnts);
  checkRange("steps", options.steps, 1, Colony::maxSteps);
  if (options.crew > options.ants) options.crew = options.ants;
  checkRange("crew", options.crew, 1, options.ants);
  checkRange("passes", options.passes, 0, Colony::maxSteps);
  checkRange("beta", options.beta, 0, 8);
  checkRange("margin", static_cast<double>(options.margin), 1.0 / 512, 64);
  checkRange("evaporation", static_cast<double>(options.evaporation), 1.0 / 4096, 4095.0 / 4096);
  checkRange("least", static_cast<double>(options.least), 0x1p-16, 1 - 0x1p-20);
  checkRange("greed", static_cast<double>(options.greed), 0, 1);
  checkRange("wear", static_cast<double>(options.wear), 0, 1);
  checkRange("forget", static_cast<double>(options.forget), 0, 1);
  checkRange("forgetRadius", options.forgetRadius, 0, Colony::maxSide);
  return options;
}

uint32_t fixedShare(float share, double unit) {
  return static_cast<uint32_t>(std::lround(static_cast<double>(share) * unit));
}

shared::ColonyConstants constantsOf(const Colony::Options& options, const CostGrid& grid, glm::uvec2 nest,
                                    glm::uvec2 goal) {
  return {.columns = grid.columns,
          .rows = grid.rows,
          .nest = nest.y * grid.columns + nest.x,
          .goal = goal.y * grid.columns + goal.x,
          .ants = options.ants,
          .crew = options.crew,
          .steps = options.steps,
          .passes = options.passes,
          .seedLow = static_cast<uint32_t>(options.seed),
          .seedHigh = static_cast<uint32_t>(options.seed >> 32),
          .iteration = 0,
          .update = shared::UPDATE_WEIGHTS,
          .beta = options.beta,
          .margin = fixedShare(options.margin, 512),
          .evaporation = fixedShare(options.evaporation, 4096),
          .least = fixedShare(options.least, 0x1p20),
          .bestEvery = options.bestEvery,
          .greed = static_cast<uint32_t>(std::min(static_cast<double>(options.greed) * 0x1p32, 0x1p32 - 1)),
          .wear = fixedShare(options.wear, 4096),
          .forget = fixedShare(options.forget, 4096)};
}

// Moves of four bits, eight a word.
std::vector<uint32_t> unpackedMoves(uint32_t count, const auto& wordAt) {
  std::vector<uint32_t> directions(count);
  for (uint32_t move = 0; move < count; ++move)
    directions[move] = (wordAt(move / 8) >> (4 * (move % 8))) & 15;
  return directions;
}

}  // namespace

struct Colony::Impl {
  Impl(Device&, const CostGrid&, glm::uvec2 nest, glm::uvec2 goal, const Options&);

  const gpu::Context* context;
  CostGrid grid;
  glm::uvec2 nest, goal;
  Options options;
  shared::ColonyConstants constants;
  gpu::Buffer ground, pheromone, weight, mark, move, trip, chain, crossing, trail, best;
  gpu::Kernel walk, tighten, judge, update;
  gpu::Bindings walkBindings, tightenBindings, judgeBindings, updateBindings;

  uint32_t cells() const { return grid.columns * grid.rows; }
  uint32_t crews() const { return gpu::groupsFor(options.ants, options.crew); }
  uint32_t moveWords() const { return gpu::groupsFor(options.steps, 8); }

  void makeBuffers();
  void makeKernels();
  gpu::Kernel makeKernel(const char* entry, std::span<const uint8_t> builtin, std::vector<int> bindings);
  gpu::Bindings bind(const gpu::Kernel&) const;
  using Buffers = std::array<const gpu::Buffer*, shared::COLONY_BEST + 1>;
  Buffers buffers() const;  // by binding
  void begin();
  void recordUpdate(vk::CommandBuffer, uint32_t kind) const;
  void recordTightening(vk::CommandBuffer) const;
  void recordIteration(vk::CommandBuffer);
  void recordIterations(vk::CommandBuffer, uint32_t iterations);
  void checkIterations(uint32_t iterations) const;
  void forgetNear(std::span<const glm::uvec2>);
  void measureBest();
  ColonyPath pathAlong(const std::vector<uint32_t>& directions, uint32_t length, uint32_t iteration) const;
};

Colony::Impl::Impl(Device& device, const CostGrid& costs, glm::uvec2 from, glm::uvec2 to,
                   const Options& wanted)
    : context(&device.context()), grid(costs), nest(from), goal(to) {
  ways::checkGrid(grid);
  ways::checkCell(grid, "nest", nest);
  ways::checkCell(grid, "goal", goal);
  options = checkedOptions(wanted, grid);
  constants = constantsOf(options, grid, nest, goal);
  makeBuffers();
  makeKernels();
  begin();
}

void Colony::Impl::makeBuffers() {
  const DeviceLimits& limits = context->limits();
  const uint64_t most =
      std::min<uint64_t>(limits.maxStorageBufferRange / (8 * sizeof(uint32_t)),
                         uint64_t{limits.maxComputeWorkGroupCountX} * shared::COLONY_CELL_GROUP);
  if (cells() > most)
    throw deviceError(
        fmt::format("a colony's grid has {} cells, {} takes {}", cells(), context->report().name, most));
  struct Need {
    gpu::Buffer* buffer;
    uint64_t words;
    const char* name;
  };
  const uint64_t edges = uint64_t{8} * cells(), ants = options.ants;
  const Need needs[] = {{&ground, cells(), "colony ground"},
                        {&pheromone, edges, "colony pheromone"},
                        {&weight, edges, "colony weights"},
                        {&mark, ants * gpu::groupsFor(cells(), 32), "colony marks"},
                        {&move, ants * moveWords(), "colony moves"},
                        {&trip, ants * 2, "colony trips"},
                        {&chain, uint64_t{2} * crews() * (options.steps + 1), "colony chains"},
                        {&crossing, options.rule == ColonyRule::acs ? edges : 0, "colony crossings"},
                        {&trail, cells(), "colony trail"},
                        {&best, uint64_t{shared::BEST_HEAD} + moveWords(), "colony best"}};
  uint64_t bytes = 0;
  for (const Need& need : needs) bytes += need.words * sizeof(uint32_t);
  if (bytes > limits.availableBytes)
    throw deviceError(fmt::format("a colony of {} ants on {} x {} cells needs {} MiB, {} has {} MiB",
                                  options.ants, grid.columns, grid.rows, bytes >> 20, context->report().name,
                                  limits.availableBytes >> 20));
  for (const Need& need : needs)
    *need.buffer = gpu::Buffer(*context, need.words * sizeof(uint32_t), need.name);
}

gpu::Kernel Colony::Impl::makeKernel(const char* entry, std::span<const uint8_t> builtin,
                                     std::vector<int> bindings) {
  std::span<const uint8_t> code = builtin;
  for (const Shader& other : options.shaders)
    if (other.entry == entry) code = other.code;
  std::vector<gpu::BindingDecl> declared;
  for (const int binding : bindings)
    declared.push_back({static_cast<uint32_t>(binding), gpu::BindingKind::store});
  return {*context,
          {.name = fmt::format("colony {}", entry),
           .code = code,
           .bindings = std::move(declared),
           .pushBytes = sizeof(shared::ColonyConstants),
           .constants = {{shared::CONSTANT_RULE, static_cast<uint32_t>(options.rule)}}}};
}

void Colony::Impl::makeKernels() {
  using namespace shared;
  using namespace embedded;
  walk = makeKernel("walk", colony_walk_comp(),
                    {COLONY_GROUND, COLONY_WEIGHT, COLONY_MARK, COLONY_MOVE, COLONY_TRIP, COLONY_CROSSING});
  tighten =
      makeKernel("tighten", colony_tighten_comp(), {COLONY_GROUND, COLONY_MOVE, COLONY_TRIP, COLONY_CHAIN});
  judge = makeKernel("judge", colony_judge_comp(),
                     {COLONY_GROUND, COLONY_MOVE, COLONY_TRIP, COLONY_TRAIL, COLONY_BEST});
  update = makeKernel("update", colony_update_comp(),
                      {COLONY_GROUND, COLONY_PHEROMONE, COLONY_WEIGHT, COLONY_TRAIL, COLONY_CROSSING});
  walkBindings = bind(walk);
  tightenBindings = bind(tighten);
  judgeBindings = bind(judge);
  updateBindings = bind(update);
}

gpu::Bindings Colony::Impl::bind(const gpu::Kernel& kernel) const {
  std::vector<gpu::Binding> list;
  for (const gpu::BindingDecl& declared : kernel.layout().declarations())
    list.push_back({declared.binding, buffers().at(declared.binding)});
  return kernel.bind(*context, list);
}

Colony::Impl::Buffers Colony::Impl::buffers() const {
  return {&ground, &pheromone, &weight, &mark, &move, &trip, &chain, &crossing, &trail, &best};
}

void Colony::Impl::begin() {
  gpu::upload(*context, ground, ways::groundOf(grid));
  const uint32_t first = options.rule == ColonyRule::mmas ? shared::FULL_PHEROMONE : constants.least;
  gpu::upload(*context, pheromone, std::vector<uint32_t>(size_t{8} * cells(), first));
  for (const gpu::Buffer* buffer : {&move, &crossing, &trail, &best}) gpu::clear(*context, *buffer);
  gpu::upload(*context, best, std::vector<uint32_t>{0, shared::NO_WAY, 0, 0});
  std::vector<uint32_t> none;
  for (uint32_t ant = 0; ant < options.ants; ++ant) none.insert(none.end(), {0, shared::NO_WAY});
  gpu::upload(*context, trip, none);
  gpu::submitAndWait(*context, [&](vk::CommandBuffer cmd) { recordUpdate(cmd, shared::UPDATE_WEIGHTS); });
}

void Colony::Impl::recordUpdate(vk::CommandBuffer cmd, uint32_t kind) const {
  shared::ColonyConstants own = constants;
  own.update = kind;
  gpu::transferToCompute(cmd);
  update.dispatch(cmd, updateBindings, gpu::bytesOf(own), gpu::groupsFor(cells(), shared::COLONY_CELL_GROUP));
  gpu::computeToCompute(cmd);
}

void Colony::Impl::recordTightening(vk::CommandBuffer cmd) const {
  const uint32_t passesOfDispatch = loopsOfDispatch / (3 * options.steps);
  static_assert(loopsOfDispatch / (3 * maxSteps) > 0);
  for (uint32_t done = 0; done < options.passes; done += passesOfDispatch) {
    shared::ColonyConstants own = constants;
    own.passes = std::min(passesOfDispatch, options.passes - done);
    tighten.dispatch(cmd, tightenBindings, gpu::bytesOf(own), gpu::groupsFor(crews(), shared::COLONY_GROUP));
    gpu::computeToCompute(cmd);
  }
}

void Colony::Impl::recordIteration(vk::CommandBuffer cmd) {
  const auto push = gpu::bytesOf(constants);
  gpu::computeToTransfer(cmd);
  cmd.fillBuffer(mark.handle(), 0, VK_WHOLE_SIZE, 0);
  gpu::transferToCompute(cmd);
  walk.dispatch(cmd, walkBindings, push, gpu::groupsFor(options.ants, shared::COLONY_GROUP));
  gpu::computeToCompute(cmd);
  recordTightening(cmd);
  judge.dispatch(cmd, judgeBindings, push, 1);
  gpu::computeToCompute(cmd);
  recordUpdate(cmd, shared::UPDATE_ITERATION);
  ++constants.iteration;
}

void Colony::Impl::recordIterations(vk::CommandBuffer cmd, uint32_t iterations) {
  gpu::computeToCompute(cmd);
  gpu::transferToCompute(cmd);
  for (uint32_t n = 0; n < iterations; ++n) recordIteration(cmd);
  gpu::computeToTransfer(cmd);
}

void Colony::Impl::checkIterations(uint32_t iterations) const {
  if (iterations > mostIterations - constants.iteration)
    throw inputError(fmt::format("{} iterations of a colony after {}, expected at most {}", iterations,
                                 constants.iteration, mostIterations));
}

// Marks the cells within the radius in the ground, forgets there, and computes all weights anew.
void Colony::Impl::forgetNear(std::span<const glm::uvec2> changed) {
  std::vector<uint32_t> words = ways::groundOf(grid);
  const uint32_t radius = options.forgetRadius;
  for (const glm::uvec2 cell : changed) {
    const glm::uvec2 first(cell.x - std::min(cell.x, radius), cell.y - std::min(cell.y, radius));
    const glm::uvec2 last(std::min(cell.x + radius, grid.columns - 1),
                          std::min(cell.y + radius, grid.rows - 1));
    for (uint32_t row = first.y; row <= last.y; ++row)
      for (uint32_t column = first.x; column <= last.x; ++column)
        words[size_t{row} * grid.columns + column] |= shared::GROUND_CHANGED;
  }
  gpu::upload(*context, ground, words);
  gpu::submitAndWait(*context, [&](vk::CommandBuffer cmd) { recordUpdate(cmd, shared::UPDATE_FORGET); });
}

void Colony::Impl::measureBest() {
  std::vector<uint32_t> words = gpu::download<uint32_t>(*context, best);
  if (words[shared::BEST_LENGTH] == shared::NO_WAY) return;
  const auto wordAt = [&](uint32_t word) { return words[size_t{shared::BEST_HEAD} + word]; };
  const std::vector<uint32_t> directions = unpackedMoves(words[shared::BEST_MOVES], wordAt);
  words[shared::BEST_LENGTH] = ways::lengthAlong(grid, ways::groundOf(grid), nest, directions);
  gpu::upload(*context, best, words);
}

ColonyPath Colony::Impl::pathAlong(const std::vector<uint32_t>& directions, uint32_t length,
                                   uint32_t iteration) const {
  ColonyPath path{.fixedLength = length,
                  .length = static_cast<double>(length) / 512 * static_cast<double>(grid.cell),
                  .iteration = iteration};
  glm::uvec2 cell = nest;
  const auto add = [&] {
    path.cells.push_back(cell);
    path.points.push_back(grid.origin + grid.cell * (glm::vec2(cell) + 0.5f));
  };
  add();
  for (const uint32_t direction : directions) {
    cell = ways::beside(cell, direction);
    add();
  }
  return path;
}

Colony::Colony(Device& device, const CostGrid& grid, glm::uvec2 nest, glm::uvec2 goal, const Options& options)
    : impl_(std::make_unique<Impl>(device, grid, nest, goal, options)) {}
Colony::~Colony() = default;
Colony::Colony(Colony&&) noexcept = default;
Colony& Colony::operator=(Colony&&) noexcept = default;

const Colony::Options& Colony::options() const { return impl_->options; }
uint32_t Colony::iteration() const { return impl_->constants.iteration; }

uint64_t Colony::memoryBytes() const {
  uint64_t bytes = 0;
  for (const gpu::Buffer* buffer : impl_->buffers()) bytes += buffer->size();
  return bytes;
}

void Colony::record(VkCommandBuffer commandBuffer, uint32_t iterations) {
  impl_->checkIterations(iterations);
  impl_->recordIterations(vk::CommandBuffer(commandBuffer), iterations);
}

void Colony::search(uint32_t iterations) {
  Impl& colony = *impl_;
  colony.checkIterations(iterations);
  for (uint32_t done = 0; done < iterations; done += iterationsASubmission)
    gpu::submitAndWait(*colony.context, [&](vk::CommandBuffer cmd) {
      colony.recordIterations(cmd, std::min(iterationsASubmission, iterations - done));
    });
}

void Colony::setCosts(std::span<const glm::uvec2> cells, std::span<const float> costs) {
  Impl& colony = *impl_;
  if (cells.size() != costs.size())
    throw inputError(fmt::format("a colony was given {} costs for {} cells", costs.size(), cells.size()));
  for (size_t n = 0; n < cells.size(); ++n) {
    ways::checkCell(colony.grid, "changed cell", cells[n]);
    ways::checkCost(cells[n], costs[n]);
  }
  for (size_t n = 0; n < cells.size(); ++n)
    colony.grid.cost[size_t{cells[n].y} * colony.grid.columns + cells[n].x] = costs[n];
  colony.forgetNear(cells);
  colony.measureBest();
}

std::optional<ColonyPath> Colony::best() const {
  const std::vector<uint32_t> words = gpu::download<uint32_t>(*impl_->context, impl_->best);
  if (words[shared::BEST_LENGTH] == shared::NO_WAY) return {};
  const auto wordAt = [&](uint32_t word) { return words[size_t{shared::BEST_HEAD} + word]; };
  return impl_->pathAlong(unpackedMoves(words[shared::BEST_MOVES], wordAt), words[shared::BEST_LENGTH],
                          words[shared::BEST_FOUND]);
}

std::vector<std::optional<ColonyPath>> Colony::downloadTrips() const {
  const Impl& colony = *impl_;
  const std::vector<uint32_t> moves = gpu::download<uint32_t>(*colony.context, colony.move),
                              ends = gpu::download<uint32_t>(*colony.context, colony.trip);
  std::vector<std::optional<ColonyPath>> trips(colony.options.ants);
  for (size_t ant = 0; ant < trips.size(); ++ant) {
    const uint32_t count = ends[2 * ant], length = ends[2 * ant + 1];
    if (length == shared::NO_WAY) continue;
    const auto wordAt = [&](uint32_t word) { return moves[size_t{word} * trips.size() + ant]; };
    trips[ant] = colony.pathAlong(unpackedMoves(count, wordAt), length, colony.constants.iteration);
  }
  return trips;
}

std::vector<uint32_t> Colony::downloadPheromone() const {
  return gpu::download<uint32_t>(*impl_->context, impl_->pheromone);
}

}  // namespace skitter
