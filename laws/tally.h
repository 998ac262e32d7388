#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "laws/law.h"

namespace skitter::laws {

// How a herd kept a law: for tables.
struct Figure {
  Law law;
  uint32_t herd = 0;
  Bound bound;
  uint64_t samples = 0, beyond = 0;  // beyond the bound, on its worse side
  uint64_t agents = 0, judged = 0;   // agents that went beyond it, and all that were judged
  uint64_t firstTick = 0;            // in which it was seen broken
  double worst = 0;                  // in the law's unit
  // What the bound is held against, of all samples: the worst or, of a law with a share, the percentile.
  double value = 0;
  bool isKept = true;
  std::string text = {};  // a sentence, where it is broken
};

// What was seen of a herd, law by law.
class Tally {
 public:
  Tally(uint32_t herd, std::string rig, std::string controller);

  void add(Law law, uint32_t agent, uint64_t tick, double value);
  std::vector<Figure> figures() const;  // of the laws that were judged
  std::vector<Figure> broken() const;   // those of them that were broken

 private:
  // Values on one side of a bound.
  struct Side {
    uint64_t beyond = 0, agents = 0, firstTick = 0;
    double worst = 0;  // in the law's unit
    std::vector<bool> hasAgent;
  };
  struct Row {
    uint64_t samples = 0, judged = 0;
    std::vector<bool> hasAgent;
    Side under, over;
    // Every so many-th value, so that they never are more than `mostKept`.
    std::vector<float> values;
    uint64_t every = 1;
  };
  static constexpr size_t mostKept = 4096;
  static void note(Side& side, uint32_t agent, uint64_t tick, double value, bool isWorse);
  static void keep(Row& row, double value);
  Figure figureOf(Law law) const;

  uint32_t herd_;
  std::string rig_, controller_;
  std::array<Row, lawCount> rows_;
};

}  // namespace skitter::laws
