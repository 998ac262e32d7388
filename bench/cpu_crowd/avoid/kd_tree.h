#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace skitter::cpu_avoid {

// Points of a plane, and the nearest to one of them. A node that holds more than a few is cut across the
// longer side of what its points take up, in the middle. Points keep the order of the last tree, in which
// most of them need not move.
class KdTree {
 public:
  static constexpr size_t mostFound = 10;

  struct Point {
    float x = 0, z = 0;
    uint32_t number = 0;
  };
  // The nearest first, of equal ones the least number. `at` are places in points().
  struct Found {
    size_t count = 0;
    std::array<uint32_t, mostFound> at;
    std::array<float, mostFound> distance2;
  };

  // `pieces`: into how many subtrees at least the work is cut, where there are points for them.
  KdTree(size_t points, size_t pieces);

  // Points in the order of the tree.
  const std::vector<Point>& points() const { return points_; }
  std::vector<Point>& points() { return points_; }
  // Once they have moved: what is above the subtrees, and then each subtree, in any order.
  void begin();
  size_t pieces() const { return cut_.size(); }
  void finish(size_t piece) { grow(cut_[piece]); }

  // Those of points() that are nearest to the `self`-th, without it, up to a distance.
  Found nearest(uint32_t self, float distance) const;

 private:
  // A run of points; a subtree of m points takes less than 2 m nodes, in front those of its left part.
  struct Run {
    uint32_t node, first, last;
  };
  struct Node {
    float lowX, highX, lowZ, highZ;
    uint32_t first, last;  // points
    uint32_t right;        // node; the left one follows its parent. 0: a leaf
  };
  struct Search;

  // Bounds a run and cuts it. The point at which its right part begins, or its last one where it is a leaf.
  uint32_t cut(const Run& run);
  void grow(const Run& run);
  void look(uint32_t node, Search& search) const;

  std::vector<Point> points_;
  std::vector<Node> nodes_;
  std::vector<Run> cut_, level_;  // the pieces, and room to make them
  size_t wanted_;
};

}  // namespace skitter::cpu_avoid
