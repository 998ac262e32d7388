#include "ways/maps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

#include "app/colony/threat_map.h"

namespace skitter::test {
namespace {

constexpr float wall = std::numeric_limits<float>::infinity();

uint32_t fixedShareOf(float share, double unit) {
  return static_cast<uint32_t>(std::floor(static_cast<double>(share) * unit + 0.5));
}

std::string differenceOfTrip(const std::string& what, const std::optional<ColonyPath>& found,
                             const reference::ColonyTrip& expected, const ColonyCase& each) {
  if (found.has_value() != expected.arrived)
    return fmt::format("{}: arrived {}, reference {}", what, found.has_value(), expected.arrived);
  if (!found) return {};
  if (found->fixedLength != expected.length)
    return fmt::format("{}: length {}, reference {}", what, found->fixedLength, expected.length);
  if (found->cells.size() != expected.cells.size())
    return fmt::format("{}: {} cells, reference {}", what, found->cells.size(), expected.cells.size());
  for (size_t k = 0; k < expected.cells.size(); ++k)
    if (indexOf(each, found->cells[k]) != expected.cells[k])
      return fmt::format("{}: cell {} is {}, reference {}", what, k, indexOf(each, found->cells[k]),
                         expected.cells[k]);
  return {};
}

}  // namespace

uint32_t indexOf(const ColonyCase& each, glm::uvec2 cell) { return cell.y * each.grid.columns + cell.x; }

ColonyCase drawnCase(const std::string& name, const std::string& picture) {
  ColonyCase each{.name = name,
                  .grid = {.columns = 0, .rows = 0, .cell = 0.5f, .origin = {-3, 2}, .cost = {}}};
  std::istringstream lines(picture);
  for (std::string line; std::getline(lines, line); ++each.grid.rows) {
    each.grid.columns = static_cast<uint32_t>(line.size());
    for (uint32_t column = 0; column < line.size(); ++column) {
      const char sign = line[column];
      if (sign == 'n') each.nest = {column, each.grid.rows};
      if (sign == 'g') each.goal = {column, each.grid.rows};
      const bool isDigit = sign >= '1' && sign <= '9';
      each.grid.cost.push_back(sign == '#' ? wall : isDigit ? static_cast<float>(sign - '0') : 1.0f);
    }
  }
  return each;
}

ColonyCase threatCase(uint32_t side, uint64_t seed) {
  app::ThreatMap map = app::threatMap(side, seed);
  return {.name = fmt::format("threats {} of side {}", seed, side),
          .grid = std::move(map.grid),
          .nest = map.nest,
          .goal = map.goal};
}

reference::Colony referenceOf(const ColonyCase& each) {
  const Colony::Options& options = each.options;
  const CostGrid& grid = each.grid;
  reference::ColonyRecipe recipe;
  recipe.rule = options.rule == ColonyRule::mmas ? reference::ColonyRule::mmas : reference::ColonyRule::acs;
  recipe.ants = options.ants;
  recipe.crew = std::min(options.crew, options.ants);
  recipe.steps = options.steps == 0 ? 8 * (grid.columns + grid.rows) : options.steps;
  recipe.passes = options.passes;
  recipe.seed = options.seed;
  recipe.beta = options.beta;
  recipe.margin = fixedShareOf(options.margin, 512);
  recipe.evaporation = fixedShareOf(options.evaporation, 4096);
  recipe.least = fixedShareOf(options.least, 1 << 20);
  recipe.bestEvery = options.bestEvery;
  recipe.greed = options.greed < 1 ? static_cast<uint32_t>(static_cast<double>(options.greed) * 0x1p32)
                                   : std::numeric_limits<uint32_t>::max();
  recipe.wear = fixedShareOf(options.wear, 4096);
  recipe.forget = fixedShareOf(options.forget, 4096);
  recipe.forgetRadius = options.forgetRadius;
  return {{grid.columns, grid.rows, grid.cost}, recipe, indexOf(each, each.nest), indexOf(each, each.goal)};
}

std::string differenceNow(const Colony& colony, const reference::Colony& truth, const ColonyCase& each) {
  const std::string when = fmt::format("{}, iteration {}, ", each.name, truth.iteration());
  const std::vector<std::optional<ColonyPath>> trips = colony.downloadTrips();
  for (size_t ant = 0; ant < truth.trips().size(); ++ant) {
    const std::string text =
        differenceOfTrip(fmt::format("{}ant {}", when, ant), trips[ant], truth.trips()[ant], each);
    if (!text.empty()) return text;
  }
  const std::optional<ColonyPath> best = colony.best();
  const std::string text = differenceOfTrip(when + "best", best, truth.best(), each);
  if (!text.empty()) return text;
  if (best && best->iteration != truth.found())
    return fmt::format("{}best found in {}, reference {}", when, best->iteration, truth.found());
  const std::vector<uint32_t> pheromone = colony.downloadPheromone();
  if (pheromone.size() != truth.pheromone().size()) return when + "another count of pheromone";
  for (size_t edge = 0; edge < pheromone.size(); ++edge)
    if (pheromone[edge] != truth.pheromone()[edge])
      return fmt::format("{}pheromone {} is {}, reference {}", when, edge, pheromone[edge],
                         truth.pheromone()[edge]);
  return {};
}

std::string differenceOf(Colony& colony, reference::Colony& truth, const ColonyCase& each,
                         uint32_t iterations) {
  for (uint32_t n = 0; n < iterations; ++n) {
    colony.search(1);
    truth.iterate();
    const std::string text = differenceNow(colony, truth, each);
    if (!text.empty()) return text;
  }
  return {};
}

}  // namespace skitter::test
