#include <algorithm>
#include <cassert>

#include "crowd/herd.h"

namespace skitter::crowd {
namespace {

// AgentId holds no more: the place stays empty from then on.
constexpr uint32_t kLastGeneration = (1u << 30) - 2;

}  // namespace

Presence::Presence(uint32_t agents, uint32_t places, uint32_t generation)
    : generations(places, generation + 1), count(agents), firstEmpty_(agents) {
  std::fill_n(generations.begin(), agents, generation);
}

uint32_t Presence::nextGeneration() const {
  if (generations.empty()) return 0;
  const uint32_t last = std::ranges::max(generations);
  return std::min(last / 2 * 2 + 2, kLastGeneration);
}

std::optional<uint32_t> Presence::lowestEmpty() const {
  for (auto place = firstEmpty_; place < generations.size(); ++place)
    if (!has(place) && generations[place] < kLastGeneration) return place;
  return {};
}

void Presence::come(uint32_t place) {
  assert(!has(place));
  ++generations[place];
  ++count;
  firstEmpty_ = std::max(firstEmpty_, lowestEmpty().value_or(static_cast<uint32_t>(generations.size())));
}

void Presence::leave(uint32_t place) {
  assert(has(place));
  ++generations[place];
  --count;
  firstEmpty_ = std::min(firstEmpty_, place);
}

}  // namespace skitter::crowd
