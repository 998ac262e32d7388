#include <algorithm>
#include <cassert>
#include <utility>

#include "crowd/herd.h"

namespace skitter::crowd {
namespace {

// AgentId holds no more: the place stays empty from then on.
constexpr uint32_t kLastGeneration = (1u << 30) - 2;

}  // namespace

Presence::Presence(std::vector<uint32_t> made)
    : generations(std::move(made)),
      count(static_cast<uint32_t>(
          std::ranges::count_if(generations, [](uint32_t generation) { return generation % 2 == 0; }))) {}

Presence Presence::beginning(const skitter::Herd& from, std::span<const uint32_t> starts,
                             uint32_t generation) {
  std::vector<uint32_t> generations(from.agents + from.reserve, generation);
  for (uint32_t place = 0; place < generations.size(); ++place)
    if ((starts.empty() ? place : starts[place]) >= from.agents) ++generations[place];
  return Presence(std::move(generations));
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
