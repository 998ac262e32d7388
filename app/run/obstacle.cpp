#include "app/run/obstacle.h"

#include <algorithm>
#include <cmath>

#include "skitter/records.h"

namespace skitter::app {
namespace {

// Leg lengths, and leg lengths a second.
constexpr float kRadius = 1.4f, kHeight = 0.35f, kAhead = 3, kSpeed = 0.8f;

glm::vec2 middleOf(const HerdState& herd) {
  glm::vec2 sum(0);
  for (size_t agent = 0; agent < herd.agents; ++agent) {
    const float* b = herd.body.data() + agent * shared::BODY_STRIDE * 4;
    sum += glm::vec2(shared::tileX(b[3]), shared::tileZ(b[3])) * shared::TILE_SIZE + glm::vec2(b[0], b[2]);
  }
  return sum / static_cast<float>(std::max(1u, herd.agents));
}

}  // namespace

Obstacle::Obstacle(const Crowd& crowd) : ground_(crowd.terrain()) {
  const float length = crowd.rig(0).legLength;
  const HerdState herd = crowd.download(0);
  start_ = middleOf(herd) + glm::vec2(0, kAhead * length);
  // Never thinner than the grid can hold.
  radius_ = std::max(kRadius * length, 2 * std::max(ground_.spacingX, ground_.spacingZ));
  height_ = kHeight * length;
  width_ = std::max(4 * length, 0.7f * std::sqrt(static_cast<float>(std::max(1u, herd.agents))) * length);
}

Obstacle::Obstacle(const Crowd& crowd, const nlohmann::ordered_json& saved) : ground_(crowd.terrain()) {
  saved.at("startX").get_to(start_.x);
  saved.at("startZ").get_to(start_.y);
  saved.at("radius").get_to(radius_);
  saved.at("height").get_to(height_);
  saved.at("width").get_to(width_);
  const auto& covered = saved.at("covered");
  covered.at("x").get_to(covered_.x);
  covered.at("z").get_to(covered_.z);
  covered.at("columns").get_to(covered_.columns);
  covered.at("rows").get_to(covered_.rows);
  ground_.edit(covered_.x, covered_.z, covered_.columns, covered_.rows,
               saved.at("ground").get<std::vector<float>>());
}

// The rest of the ground is as the crowd has it.
nlohmann::ordered_json Obstacle::json() const {
  std::vector<float> heights;
  for (uint32_t z = covered_.z; z < covered_.z + covered_.rows; ++z) {
    const auto first =
        ground_.heights.begin() + static_cast<std::ptrdiff_t>(z) * ground_.columns + covered_.x;
    heights.insert(heights.end(), first, first + covered_.columns);
  }
  return {{"startX", start_.x},
          {"startZ", start_.y},
          {"radius", radius_},
          {"height", height_},
          {"width", width_},
          {"covered",
           {{"x", covered_.x}, {"z", covered_.z}, {"columns", covered_.columns}, {"rows", covered_.rows}}},
          {"ground", heights}};
}

void Obstacle::move(Crowd& crowd, double seconds) {
  const float speed = kSpeed * crowd.rig(0).legLength;
  const glm::vec2 centre = start_ + glm::vec2(width_ * static_cast<float>(std::sin(speed / width_ * seconds)),
                                              0.3f * speed * static_cast<float>(seconds));
  const auto index = [](float at, float origin, float spacing, uint32_t samples) {
    return static_cast<uint32_t>(
        std::clamp(std::floor((at - origin) / spacing), 0.0f, static_cast<float>(samples - 1)));
  };
  const uint32_t left = index(centre.x - radius_, ground_.originX(), ground_.spacingX, ground_.columns);
  const uint32_t right = index(centre.x + radius_, ground_.originX(), ground_.spacingX, ground_.columns) + 1;
  const uint32_t near = index(centre.y - radius_, ground_.originZ(), ground_.spacingZ, ground_.rows);
  const uint32_t far = index(centre.y + radius_, ground_.originZ(), ground_.spacingZ, ground_.rows) + 1;
  auto now = covered_;
  now.x = left, now.z = near;
  now.columns = std::min(right + 1, ground_.columns) - left,
  now.rows = std::min(far + 1, ground_.rows) - near;
  // One rectangle over where it was and where it is.
  auto both = now;
  if (covered_.columns > 0) {
    both.x = std::min(now.x, covered_.x), both.z = std::min(now.z, covered_.z);
    both.columns = std::max(now.x + now.columns, covered_.x + covered_.columns) - both.x;
    both.rows = std::max(now.z + now.rows, covered_.z + covered_.rows) - both.z;
  }
  std::vector<float> heights;
  for (uint32_t z = both.z; z < both.z + both.rows; ++z) {
    for (uint32_t x = both.x; x < both.x + both.columns; ++x) {
      const glm::vec2 at(ground_.originX() + ground_.spacingX * static_cast<float>(x),
                         ground_.originZ() + ground_.spacingZ * static_cast<float>(z));
      const float r = std::min(1.0f, glm::length(at - centre) / radius_);
      heights.push_back(ground_.heights[size_t{z} * ground_.columns + x] +
                        height_ * (1 - r * r) * (1 - r * r));
    }
  }
  crowd.editHeights(both.x, both.z, both.columns, both.rows, heights);
  covered_ = now;
}

}  // namespace skitter::app
