#pragma once

#include <string>
#include <vector>

#include "crowd/simulation.h"

namespace skitter::test {

// A crowd of one herd in which something happens that is rare in a walk, replayed in lock step. The sound
// shaders pass in every situation. A fault that a walk does not show is refused in one of them; the first
// tick that is refused ends the situation.
struct Situation {
  const char* name;
  std::vector<Controller> controllers;  // those that are replayed in it with sound shaders
  std::vector<validation::StageResult> (*replayed)(Device&, Controller controller, const CrowdOptions&);
  bool onBothPaths = false;  // it has kernels that no other has, so it is replayed on either load path
};

const std::vector<Situation>& situations();
// Those of them that are of levels of rate.
const std::vector<Situation>& situationsAtRates();
const Situation& situationNamed(const std::string& name);

// Foragers with food on either side of a wall.
Scene foragersScene(Controller controller);
// Each agent is pushed in a direction of its own.
void pushAside(Crowd& crowd, uint32_t agent, float speed);

}  // namespace skitter::test
