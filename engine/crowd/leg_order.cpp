#include "crowd/leg_order.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace skitter::crowd {
namespace {

// Below it a creature stands on too few legs for legs of two groups to be in the air: a hexapod on four of
// them, the front one of one side and the rear one of the other lifted, may come to lean over their edge.
constexpr size_t kFewLegs = 8;
// Neighbours further apart in lag would have to wait for each other (docs/stages/gait.md).
constexpr float kMostBetweenNeighbours = 0.75f;

}  // namespace

std::vector<size_t> legsAround(const Rig& rig) {
  glm::vec3 middle(0);
  for (const Leg& leg : rig.legs) middle += leg.home / static_cast<float>(rig.legs.size());
  const auto direction = [&](size_t l) {
    const glm::vec3 out = rig.legs[l].home - middle;
    return std::atan2(out.x, out.z);
  };
  std::vector<size_t> ring(rig.legs.size());
  std::iota(ring.begin(), ring.end(), size_t{0});
  std::stable_sort(ring.begin(), ring.end(), [&](size_t a, size_t b) { return direction(a) < direction(b); });
  return ring;
}

std::vector<LegOrder> legOrder(const Rig& rig) {
  std::vector<LegOrder> order(rig.legs.size());
  const auto meet = [&](size_t a, size_t b) {
    if (rig.legs[a].group != rig.legs[b].group)
      order[a].neighbours |= 1u << b, order[b].neighbours |= 1u << a;
  };
  const std::vector<size_t> ring = legsAround(rig);
  for (size_t i = 0; i < ring.size(); ++i) meet(ring[i], ring[(i + 1) % ring.size()]);
  for (size_t a = 0; rig.legs.size() < kFewLegs && a < rig.legs.size(); ++a)
    for (size_t b = 0; b < a; ++b) meet(a, b);

  for (size_t l = 0; l < rig.legs.size(); ++l) {
    float rear = rig.legs[l].home.z, front = rear;
    for (const Leg& other : rig.legs) {
      if (other.group != rig.legs[l].group) continue;
      rear = std::min(rear, other.home.z);
      front = std::max(front, other.home.z);
    }
    if (front - rear > 1e-3f * rig.legLength) order[l].lag = (rig.legs[l].home.z - rear) / (front - rear);
  }
  float widest = 0;
  for (size_t a = 0; a < order.size(); ++a)
    for (size_t b = 0; b < order.size(); ++b)
      if ((order[a].neighbours >> b & 1u) != 0) widest = std::max(widest, order[a].lag - order[b].lag);
  if (widest > kMostBetweenNeighbours)
    for (LegOrder& leg : order) leg.lag *= kMostBetweenNeighbours / widest;
  return order;
}

}  // namespace skitter::crowd
