#include "gait_maps.h"

#include <cstddef>
#include <cstdint>
#include <vector>

#include "shared/adapt.h"
#include "validation/vec4s.h"

namespace skitter::test {

reference::GaitMap oneLegMap(const reference::Creature& creature) {
  const size_t legs = creature.limbs.size();
  reference::GaitMap map;
  for (size_t c = 0; c <= legs; ++c) {
    reference::GaitCandidate& candidate = map.candidates.emplace_back();
    candidate.groups = creature.groups;
    candidate.expected = 1 - 0.05 * static_cast<double>(c);
    for (size_t l = 0; l < legs; ++l) {
      const reference::Limb& limb = creature.limbs[l];
      const bool isIdle = l + 1 == c;
      const uint32_t waits = c > 0 ? ~(1u << (c - 1)) : ~0u;
      candidate.legs.push_back(
          {.group = limb.group, .lag = limb.lag, .neighbours = isIdle ? 0 : limb.neighbours & waits});
      candidate.shares.push_back(isIdle ? 0 : 0.6);
    }
  }
  return map;
}

crowd::GaitMap recordsOf(const reference::GaitMap& map) {
  using validation::store;
  crowd::GaitMap result;
  result.candidates = static_cast<uint32_t>(map.candidates.size());
  for (const reference::GaitCandidate& candidate : map.candidates) {
    const size_t legs = candidate.legs.size(), first = result.records.size() / 4;
    result.records.resize(4 * (first + static_cast<size_t>(shared::gaitMapStride(static_cast<int>(legs)))));
    store(result.records, first,
          {static_cast<double>(candidate.groups), candidate.speed, candidate.expected, 0});
    store(result.records, first + 1, {candidate.shift, 0});
    const size_t rows = first + size_t{shared::GAIT_MAP_LEGS};
    for (size_t l = 0; l < legs; ++l) {
      const reference::Hurt::Turn& turn = candidate.legs[l];
      store(result.records, rows + l, {turn.group, turn.lag, turn.neighbours, turn.slowness});
      result.records[4 * (rows + legs) + l] = static_cast<float>(candidate.shares[l]);
    }
  }
  return result;
}

}  // namespace skitter::test
