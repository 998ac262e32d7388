#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <vector>

#include "skitter/crowd.h"

namespace skitter::app {

// The deeds of a herd's foragers, in all and in each window of time.
struct ForageFigures {
  // From the window before to `until`.
  struct Window {
    double until = 0;  // seconds
    uint64_t brought = 0, empty = 0;
    std::vector<uint64_t> passed = {};  // of each branch
  };

  uint32_t herd = 0;
  Foraging done = {};
  std::vector<Window> windows = {};
};
nlohmann::ordered_json jsonOf(const std::vector<ForageFigures>& herds);

// Follows the foragers of a run's herds.
class ForageLog {
 public:
  static constexpr double windowSeconds = 10;

  ForageLog() = default;
  // The herds that forage now. What they have done already is of no window.
  explicit ForageLog(const Crowd& crowd);

  // After each tick of `dt` seconds; waits for the device as a window ends.
  void append(const Crowd& crowd, double dt);
  // With the window that has begun.
  std::vector<ForageFigures> figures(const Crowd& crowd, double dt);

 private:
  void endWindow(const Crowd& crowd, double until);

  std::vector<ForageFigures> herds_;
};

}  // namespace skitter::app
