#pragma once

#include <string>

#include "cpu_reference/stages/foothold.h"
#include "experiments/course.h"
#include "experiments/page/table.h"
#include "experiments/settings.h"
#include "skitter/device.h"
#include "skitter/heightfield.h"

namespace skitter::experiments {

// Figure 2: the ladder of a leg that lifts on uneven ground. The step happened on the device; its candidates
// are computed again in double from the device's own state. World metres.
struct Ladder {
  bool found = false;  // a leg lifted in the ticks that were looked at
  std::string leg;
  glm::dvec3 body{0}, root{0}, target{0}, liftOff{0};
  glm::dvec3 landing{0};  // the device's
  double legLength = 1;
  std::vector<glm::dvec3> points;  // candidates on the ground, in scan order: rungs of 3, 5, 7, 9
  std::vector<std::vector<glm::dvec3>> ground;  // rows of the terrain about them, for a drawing
  reference::FootholdResult result;
  double apart = 0;  // metres between the device's landing and the reference's

  Table table() const;
};

Ladder measureLadder(Device& device, const Heightfield& ground, const Settings& settings, Course& course);

}  // namespace skitter::experiments
