#include "evolve/archive.h"

#include <algorithm>
#include <cmath>

namespace skitter::evolve {
namespace {

constexpr double leastShare = 0.4, shareStep = 0.075;

uint32_t stepOf(double share) {
  const double step = std::floor((share - leastShare) / shareStep);
  return static_cast<uint32_t>(std::clamp(step, 0.0, double{Archive::steps - 1}));
}

}  // namespace

bool Archive::offer(size_t pattern, uint32_t cell, const Elite& elite) {
  std::optional<Elite>& holder = cells_[pattern][cell];
  if (!(elite.fitness > (holder ? holder->fitness : 0))) return false;
  holder = elite;
  return true;
}

uint64_t Archive::filledCount() const {
  uint64_t count = 0;
  for (const auto& cells : cells_)
    count += static_cast<uint64_t>(
        std::ranges::count_if(cells, [](const std::optional<Elite>& cell) { return cell.has_value(); }));
  return count;
}

std::vector<const Elite*> Archive::elitesOf(size_t pattern) const {
  std::vector<const Elite*> elites;
  for (const std::optional<Elite>& cell : cells_[pattern])
    if (cell) elites.push_back(&*cell);
  return elites;
}

const Elite* Archive::bestOf(size_t pattern) const {
  const Elite* best = nullptr;
  for (const Elite* elite : elitesOf(pattern)) {
    const bool isFitter = best == nullptr || elite->fitness > best->fitness ||
                          (elite->fitness == best->fitness && elite->candidate < best->candidate);
    if (isFitter) best = elite;
  }
  return best;
}

uint32_t cellOf(const Rig& rig, uint32_t idle, std::span<const float> shares) {
  double middle = 0, carriers = 0;
  for (size_t leg = 0; leg < rig.legs.size(); ++leg)
    if ((idle >> leg & 1u) == 0) middle += double{rig.legs[leg].home.z}, ++carriers;
  middle /= carriers;
  double sums[2] = {0, 0}, counts[2] = {0, 0};
  for (size_t leg = 0; leg < rig.legs.size(); ++leg) {
    if ((idle >> leg & 1u) != 0) continue;
    const size_t side = double{rig.legs[leg].home.z} > middle ? 0 : 1;
    sums[side] += double{shares[leg]};
    ++counts[side];
  }
  const double rear = sums[1] / counts[1];
  const double front = counts[0] > 0 ? sums[0] / counts[0] : rear;
  return stepOf(front) * Archive::steps + stepOf(rear);
}

}  // namespace skitter::evolve
