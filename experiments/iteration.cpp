#include "experiments/iteration.h"

#include <fmt/format.h>

#include <cmath>

#include "cpu_reference/ik/fabrik.h"

namespace skitter::experiments {

FabrikIteration measureIteration() {
  std::vector<reference::IkBone> bones;
  for (const double degrees : {75.0, 50.0, 15.0, -25.0}) {
    const double angle = degrees * 3.14159265358979 / 180;
    bones.push_back({.length = 0.25, .direction = {std::cos(angle), std::sin(angle), 0}});
  }
  const reference::IkChain chain = reference::makeIkChain(bones);
  FabrikIteration made;
  made.target = {0.62, 0.02, 0};
  made.before = reference::restState(chain).joints;
  made.backward = reference::tipToBase(chain.bones, made.target, made.before);
  made.forward = made.before;
  reference::baseToTip(chain.bones, made.backward, made.forward);
  return made;
}

Table FabrikIteration::table() const {
  Table table{{"pass", "joint", "x", "y"}};
  const auto add = [&](const char* pass, const std::vector<glm::dvec3>& joints) {
    for (size_t i = 0; i < joints.size(); ++i)
      table.rows.push_back({pass, fmt::format("{}", i), fmt::format("{:.6f}", joints[i].x),
                            fmt::format("{:.6f}", joints[i].y)});
  };
  add("before", before);
  add("backward", backward);
  add("forward", forward);
  table.rows.push_back({"target", "-", fmt::format("{:.6f}", target.x), fmt::format("{:.6f}", target.y)});
  return table;
}

}  // namespace skitter::experiments
