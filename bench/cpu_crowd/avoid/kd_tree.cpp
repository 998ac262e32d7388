#include "bench/cpu_crowd/avoid/kd_tree.h"

#include <algorithm>
#include <utility>

namespace skitter::cpu_avoid {
namespace {

constexpr uint32_t leafPoints = 10;

}  // namespace

KdTree::KdTree(size_t points, size_t pieces) : points_(points), nodes_(2 * points + 1), wanted_(pieces) {
  for (size_t i = 0; i < points; ++i) points_[i].number = static_cast<uint32_t>(i);
  cut_.reserve(2 * pieces);
  level_.reserve(2 * pieces);
}

uint32_t KdTree::cut(const Run& run) {
  const auto begin = points_.begin() + run.first, end = points_.begin() + run.last;
  Node& node = nodes_[run.node];
  node = {begin->x, begin->x, begin->z, begin->z, run.first, run.last, 0};
  for (auto point = begin; point != end; ++point) {
    node.lowX = std::min(node.lowX, point->x);
    node.highX = std::max(node.highX, point->x);
    node.lowZ = std::min(node.lowZ, point->z);
    node.highZ = std::max(node.highZ, point->z);
  }
  if (run.last - run.first <= leafPoints) return run.last;
  const bool alongX = node.highX - node.lowX >= node.highZ - node.lowZ;
  const float middle = alongX ? 0.5f * (node.lowX + node.highX) : 0.5f * (node.lowZ + node.highZ);
  const auto parted = alongX ? std::partition(begin, end, [=](const Point& p) { return p.x < middle; })
                             : std::partition(begin, end, [=](const Point& p) { return p.z < middle; });
  auto right = static_cast<uint32_t>(parted - points_.begin());
  // All in one place, or as near as numbers are.
  if (right == run.first || right == run.last) right = run.first + (run.last - run.first) / 2;
  node.right = run.node + 2 * (right - run.first);
  return right;
}

void KdTree::grow(const Run& run) {
  const uint32_t right = cut(run);
  if (right == run.last) return;
  grow({run.node + 1, run.first, right});
  grow({nodes_[run.node].right, right, run.last});
}

void KdTree::begin() {
  cut_.clear();
  if (!points_.empty()) cut_.push_back({0, 0, static_cast<uint32_t>(points_.size())});
  while (!cut_.empty() && cut_.size() < wanted_) {
    level_.clear();
    for (const Run& run : cut_) {
      const uint32_t right = cut(run);
      if (right == run.last) continue;  // a leaf, which is done
      level_.push_back({run.node + 1, run.first, right});
      level_.push_back({nodes_[run.node].right, right, run.last});
    }
    cut_.swap(level_);
  }
}

struct KdTree::Search {
  Point from;
  float limit;  // of squared distances
  Found found;

  void tell(uint32_t at, float distance2, const std::vector<Point>& points) {
    const auto isBefore = [&](size_t place) {
      return distance2 < found.distance2[place] ||
             (distance2 == found.distance2[place] && points[at].number < points[found.at[place]].number);
    };
    if (distance2 > limit || (found.count == mostFound && !isBefore(mostFound - 1))) return;
    size_t place = found.count < mostFound ? found.count++ : mostFound - 1;
    for (; place > 0 && isBefore(place - 1); --place) {
      found.at[place] = found.at[place - 1];
      found.distance2[place] = found.distance2[place - 1];
    }
    found.at[place] = at;
    found.distance2[place] = distance2;
    if (found.count == mostFound) limit = found.distance2[mostFound - 1];
  }
};

KdTree::Found KdTree::nearest(uint32_t self, float distance) const {
  Search search{points_[self], distance * distance, {}};
  look(0, search);
  return search.found;
}

void KdTree::look(uint32_t number, Search& search) const {
  const Node& node = nodes_[number];
  if (node.right == 0) {
    for (uint32_t i = node.first; i < node.last; ++i) {
      const float x = points_[i].x - search.from.x, z = points_[i].z - search.from.z;
      if (points_[i].number != search.from.number) search.tell(i, x * x + z * z, points_);
    }
    return;
  }
  const auto distance2 = [&](const Node& part) {
    const float x = std::max({part.lowX - search.from.x, search.from.x - part.highX, 0.0f});
    const float z = std::max({part.lowZ - search.from.z, search.from.z - part.highZ, 0.0f});
    return x * x + z * z;
  };
  uint32_t nearer = number + 1, farther = node.right;
  float near = distance2(nodes_[nearer]), far = distance2(nodes_[farther]);
  if (far < near) {
    std::swap(nearer, farther);
    std::swap(near, far);
  }
  if (near <= search.limit) look(nearer, search);
  if (far <= search.limit) look(farther, search);
}

}  // namespace skitter::cpu_avoid
