#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/ik/figures.h"
#include "skitter/ik.h"

namespace skitter::app {

// What `skitter ik` did, told to people or as JSON.
struct IkSummary {
  std::string device, rest, limits;
  ik::Chain chain;
  ik::Options solve;    // as it was done: no automatic solver, no default of iterations
  std::string targets;  // the file; empty: made from the seed
  uint64_t seed = 0;
  uint32_t chains = 0;
  uint64_t rows = 0;
  std::vector<std::string> files;

  void print(const IkFigures& figures) const;
  nlohmann::ordered_json json(const IkFigures& figures) const;
};

}  // namespace skitter::app
