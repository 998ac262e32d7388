#include "cpu_reference/ways/forage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

namespace skitter::reference {
namespace {

constexpr double quanta = 1024;  // in a metre
constexpr uint32_t mostGrains = (1u << 20) - 1;
// Directions 0 to 7 turn from +x by +z.
constexpr std::array<int64_t, 8> stepX = {1, 1, 0, -1, -1, -1, 0, 1}, stepZ = {0, 1, 1, 1, 0, -1, -1, -1};

// Draw n of SplitMix64 with this key (Steele, Lea and Flood 2014).
uint64_t drawOf(uint64_t key, uint64_t n) {
  uint64_t z = key + n * 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

int64_t alongAxis(double tile, double local, int64_t origin, int64_t cell, int64_t count) {
  const auto place = static_cast<int64_t>(tile * tileSize * quanta + std::floor(local * quanta));
  const auto index =
      static_cast<int64_t>(std::floor(static_cast<double>(place - origin) / static_cast<double>(cell)));
  return std::clamp<int64_t>(index, 0, count - 1);
}

int64_t cellUnder(const ForageMap& map, const AgentBody& body) {
  return alongAxis(body.tileZ, body.localZ, map.originZ, map.cell, map.rows) * map.columns +
         alongAxis(body.tileX, body.localX, map.originX, map.cell, map.columns);
}

bool areApart(const ForageMap& map, int64_t a, int64_t b) {
  return std::max(std::abs(a % map.columns - b % map.columns), std::abs(a / map.columns - b / map.columns)) >
         1;
}

int64_t cellBeside(const ForageMap& map, int64_t cell, int64_t direction) {
  const int64_t x = cell % map.columns + stepX[static_cast<size_t>(direction)];
  const int64_t z = cell / map.columns + stepZ[static_cast<size_t>(direction)];
  return x < 0 || z < 0 || x >= map.columns || z >= map.rows ? -1 : z * map.columns + x;
}

bool isOpen(const ForageMap& map, int64_t cell) {
  return cell >= 0 && map.passable[static_cast<size_t>(cell)];
}

// The way to the nest over flat ground, in 512ths of a cell.
int64_t homeLength(const ForageMap& map, int64_t cell) {
  const int64_t x = std::abs(cell % map.columns - map.nestColumn);
  const int64_t z = std::abs(cell / map.columns - map.nestRow);
  return 512 * std::max(x, z) + 212 * std::min(x, z);
}

// How far a direction leads along a heading.
int64_t along(const Forager& forager, int64_t direction) {
  const int64_t length = direction % 2 == 0 ? 512 : 362;
  const auto d = static_cast<size_t>(direction);
  return length * (forager.headingX * stepX[d] + forager.headingZ * stepZ[d]);
}

// How much nearer to the nest a move brings.
int64_t homeward(const ForageMap& map, int64_t cell, int64_t direction) {
  return homeLength(map, cell) - homeLength(map, cellBeside(map, cell, direction));
}

// How much an agent prefers a move for its direction alone.
uint64_t preference(const ForageMap& map, const Forager& forager, int64_t cell, int64_t direction) {
  int64_t most = 0;
  for (int64_t d = 0; d < 8; ++d) most = std::max(most, along(forager, d));
  const uint64_t ahead = 4 * along(forager, direction) > 3 * most ? 2 : 1;
  if (forager.state == Foraging::search) return ahead;
  const int64_t length = direction % 2 == 0 ? 512 : 724;
  return 2 * homeward(map, cell, direction) > length ? 4 * ahead : ahead;
}

// The moves that are ahead, or where none is, those that turn least. Who goes home takes one of them that
// leads there, if one does.
std::vector<int64_t> candidates(const ForageMap& map, const Forager& forager, int64_t cell) {
  std::vector<int64_t> open;
  const uint32_t moves = forageMoves(map, cell);
  for (int64_t d = 0; d < 8; ++d)
    if ((moves >> d & 1u) != 0) open.push_back(d);
  if (open.empty()) return open;
  int64_t most = along(forager, open.front());
  for (const int64_t d : open) most = std::max(most, along(forager, d));
  std::erase_if(open, [&](int64_t d) { return along(forager, d) < (most > 0 ? 1 : most); });
  const auto leadsAway = [&](int64_t d) { return homeward(map, cell, d) <= 0; };
  if (forager.state != Foraging::search && !std::all_of(open.begin(), open.end(), leadsAway))
    std::erase_if(open, leadsAway);
  return open;
}

// The choice function of Deneubourg et al. 1990; -1 where no move is open.
int64_t chooseMove(const ForageTuning& tuning, const ForageMap& map, const ForageTrail& trail,
                   const Forager& forager, int64_t cell, uint64_t random) {
  const std::vector<int64_t> open = candidates(map, forager, cell);
  std::vector<uint64_t> smells;
  for (const int64_t d : open)
    smells.push_back(uint64_t{tuning.threshold} +
                     std::min(trail.grains[static_cast<size_t>(cellBeside(map, cell, d))], mostGrains));
  if (open.empty()) return -1;
  const uint64_t most = std::max<uint64_t>(*std::max_element(smells.begin(), smells.end()), 1);
  std::vector<uint64_t> weights;
  uint64_t sum = 0;
  for (size_t i = 0; i < open.size(); ++i) {
    const uint64_t share = 1024 * smells[i] / most;
    uint64_t weight = share;
    for (uint32_t power = 1; power < tuning.power; ++power) weight = weight * share / 1024;
    weights.push_back(std::max<uint64_t>(weight, 1) * preference(map, forager, cell, open[i]));
    sum += weights.back();
  }
  const uint64_t mark = (random >> 32) * sum >> 32;
  uint64_t upTo = 0;
  for (size_t i = 0; i < open.size(); ++i)
    if (mark < (upTo += weights[i])) return open[i];
  std::abort();  // mark < sum
}

// The heading after a move.
void turnTo(int64_t direction, Forager& forager) {
  const auto turned = [](int64_t heading, int64_t step) {
    return static_cast<int64_t>(std::floor(static_cast<double>(3 * heading) / 4)) + 256 * step;
  };
  const auto d = static_cast<size_t>(direction);
  forager.headingX = turned(forager.headingX, stepX[d]);
  forager.headingZ = turned(forager.headingZ, stepZ[d]);
}

// It has come to a cell, and may change what it is about.
void arrive(const ForageTuning& tuning, const ForageMap& map, const ForageTrail& trail, int64_t cell,
            Forager& forager, ForageDeed& deed) {
  const auto at = static_cast<size_t>(cell);
  deed.entered = cell;
  ++forager.steps;
  const int64_t source = map.source[at], branch = map.branch[at];
  const auto turn = [&](Foraging state) {
    forager.state = state;
    forager.steps = 0;
    forager.headingX = -forager.headingX;
    forager.headingZ = -forager.headingZ;
  };
  if (forager.state == Foraging::search) {
    if (source >= 0 && trail.taken[static_cast<size_t>(source)] < map.amounts[static_cast<size_t>(source)]) {
      deed.kind = ForageDeed::Kind::took;
      deed.of = source;
      turn(Foraging::laden);
    } else if (forager.steps >= tuning.patience) {
      turn(Foraging::back);
    }
  } else if (map.nest[at]) {
    deed.kind = forager.state == Foraging::laden ? ForageDeed::Kind::brought : ForageDeed::Kind::empty;
    turn(Foraging::rest);
  }
  if (branch >= 0 && branch != forager.lastBranch) {
    deed.kind = ForageDeed::Kind::passed;
    deed.of = branch;
  }
  forager.lastBranch = branch;
  if (forager.state == Foraging::laden) deed.grains = tuning.layHome;
  if (forager.state == Foraging::search) deed.grains = tuning.layOut;
}

}  // namespace

ForageTuning overTicks(const ForageTuning& tuning, int ticks) {
  ForageTuning over = tuning;
  over.leave = std::min<uint64_t>(tuning.leave * static_cast<uint64_t>(ticks), 0xffffffff);
  return over;
}

uint32_t forageMoves(const ForageMap& map, int64_t cell) {
  uint32_t moves = 0;
  for (int64_t d = 0; d < 8; ++d) {
    const int64_t to = cellBeside(map, cell, d);
    bool open = isOpen(map, to);
    // From an impassable cell any way out is right.
    if (d % 2 == 1 && isOpen(map, cell))
      open = open && isOpen(map, cellBeside(map, cell, (d + 7) % 8)) &&
             isOpen(map, cellBeside(map, cell, (d + 1) % 8));
    moves |= open ? 1u << d : 0u;
  }
  return moves;
}

ForageResult forage(const ForageTuning& tuning, const ForageMap& map, const ForageTrail& trail,
                    const AgentBody& body, const Forager& before, double speed, int64_t number, uint64_t n) {
  ForageResult result;
  if (body.absent) return result;
  result.forager = before;
  Forager& forager = result.forager;
  const uint64_t random = drawOf(drawOf(tuning.seed, static_cast<uint64_t>(number) + 1), n);
  const uint32_t low = static_cast<uint32_t>(random);
  const int64_t here = cellUnder(map, body);
  const bool isLost = forager.cell < 0 || areApart(map, forager.cell, here);
  if (isLost) forager.cell = here;
  const bool acts = forager.state == Foraging::rest || forager.cell == here;
  if (acts && forager.headingX == 0 && forager.headingZ == 0) {
    forager.headingX = 1024 * stepX[low % 8];
    forager.headingZ = 1024 * stepZ[low % 8];
  }
  if (forager.state == Foraging::rest) {
    forager.cell = here;
    if (low >= tuning.leave) return result;
    forager.state = Foraging::search;
    forager.steps = 0;
    forager.lastBranch = -1;
  } else if (forager.cell == here) {
    arrive(tuning, map, trail, here, forager, result.deed);
    if (forager.state == Foraging::rest) return result;
  }
  if (forager.cell == here) {
    const int64_t direction = chooseMove(tuning, map, trail, forager, here, random);
    forager.cell = direction < 0 ? -1 : cellBeside(map, here, direction);
    if (direction >= 0) turnTo(direction, forager);
  }
  const int64_t goal = forager.cell < 0 ? map.nestRow * map.columns + map.nestColumn : forager.cell;
  const auto middle = [&](int64_t origin, int64_t index) {
    return (static_cast<double>(origin + map.cell * index) + static_cast<double>(map.cell) / 2) / quanta;
  };
  const glm::dvec2 target(middle(map.originX, goal % map.columns), middle(map.originZ, goal / map.columns));
  const glm::dvec2 delta = target - body.world();
  result.distance = glm::length(delta);
  result.velocity = delta * (speed / std::max(result.distance, 1e-6));
  return result;
}

ForageTrail freshTrail(const ForageMap& map) {
  ForageTrail trail;
  trail.taken.resize(map.amounts.size());
  trail.passed.resize(map.branches);
  trail.grains.resize(static_cast<size_t>(map.columns * map.rows));
  return trail;
}

void layTrail(const ForageDeed& deed, ForageTrail& trail) {
  if (deed.entered >= 0) trail.grains[static_cast<size_t>(deed.entered)] += deed.grains;
  switch (deed.kind) {
    case ForageDeed::Kind::none:
      return;
    case ForageDeed::Kind::empty:
      ++trail.empty;
      return;
    case ForageDeed::Kind::brought:
      ++trail.brought;
      return;
    case ForageDeed::Kind::took:
      ++trail.taken[static_cast<size_t>(deed.of)];
      return;
    case ForageDeed::Kind::passed:
      ++trail.passed[static_cast<size_t>(deed.of)];
  }
}

void evaporate(const ForageTuning& tuning, uint64_t n, ForageTrail& trail) {
  if (n % tuning.every != 0) return;
  for (uint32_t& grains : trail.grains) {
    grains = std::min(grains, mostGrains);
    const auto loss = static_cast<uint32_t>(grains * tuning.evaporation >> 32) + 1;
    grains -= std::min(grains, loss);
  }
}

}  // namespace skitter::reference
