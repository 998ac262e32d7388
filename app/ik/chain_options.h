#pragma once

#include <optional>
#include <string>
#include <vector>

#include "skitter/ik.h"

namespace CLI {
class App;
}

namespace skitter::app {

// The chain that `skitter ik` solves, as its flags describe it.
struct IkChainOptions {
  std::optional<uint64_t> joints;
  std::vector<double> bones;  // empty: equal ones, of total length 1
  std::string rest = "bent", limits = "none";
  bool freeBase = false;
  std::optional<glm::vec3> pole;

  void addTo(CLI::App& command);
  // Throws Error(input) naming the flag at fault.
  ik::Chain chain() const;
};

// Throws Error(input) where `solver` cannot take this chain, with the flag that made it so.
void checkSolver(ik::Solver solver, const ik::Chain& chain, const IkChainOptions& options);

}  // namespace skitter::app
