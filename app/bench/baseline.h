#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "bench/crowd/contest.h"
#include "skitter/controller.h"

namespace skitter::app {

// Figures of an earlier `skitter bench --json`, which those of today are held against: for servers of
// continuous integration.
class Baseline {
 public:
  // Throws Error(input) where the file is no such figures.
  explicit Baseline(const std::filesystem::path& file);

  // How much longer the device's tick takes than it did, 0.1 for a tenth: by the median of today's turns, and
  // by their lower quartile, which a busy machine disturbs less.
  struct Slowdown {
    double median, low;
  };
  // A device that is a CPU is judged by CPU time, others by the wall's clock. None where the file has no such
  // match of that device, with poses or without.
  std::optional<Slowdown> slowdown(const std::string& device, Controller controller, bool poses,
                                   const bench::Match& match, bool cpu) const;

 private:
  nlohmann::json devices_;
};

}  // namespace skitter::app
