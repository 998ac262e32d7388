#pragma once

#include <optional>
#include <string>
#include <vector>

namespace skitter::experiments {

// One direction of a plot. Ends that are not given are taken from the data, rounded out to ticks.
struct AxisInfo {
  std::string label = {};
  bool log = false;
  std::optional<double> least = {}, most = {};
};

struct Tick {
  double value;
  std::string label;  // may be empty: a line without a number
};

// A scale from the data to [0, 1], with its ticks.
class Axis {
 public:
  // Only values count that are finite and, on a logarithmic axis, above 0. There may be none.
  Axis(const AxisInfo& info, const std::vector<double>& values);

  double place(double value) const;  // 0 at the least end, 1 at the most; beyond them outside [0, 1]
  bool holds(double value) const;    // it can be drawn
  double least() const { return least_; }
  double most() const { return most_; }
  const std::vector<Tick>& ticks() const { return ticks_; }

 private:
  bool log_;
  double least_ = 0, most_ = 1;
  std::vector<Tick> ticks_;
};

}  // namespace skitter::experiments
