#pragma once

#include <functional>
#include <vector>

#include "cpu_reference/types.h"
#include "shared/parameters.h"
#include "skitter/heightfield.h"
#include "skitter/rig.h"

// A spider made of numbers: eight legs of four bones, leg length 1 m, two groups.
namespace skitter::test {

Rig spider();
// Its records as in include/skitter/records.h, with `padding` zero-length bones after each leg's own.
std::vector<float> rigRecordsOf(const Rig& rig, int padding = 0);
reference::Creature spiderCreature();

// A square field of `samples` a side around the origin.
Heightfield field(uint32_t samples, float spacing, const std::function<double(double x, double z)>& height);
Heightfield flatField(double height = 0);
// Hills, bumps and a little noise, slopes up to about 0.6.
Heightfield roughField();

shared::Parameters parametersFor(const Heightfield& terrain);

// A body at rest at world (x, z), its ground at `ground`, and a step that has long landed at each leg's home.
reference::AgentBody bodyAt(double x, double z, double ground = 0);
reference::Step plantedAt(const reference::AgentBody& body, const glm::dvec3& relative);
std::vector<reference::Step> stepsAtHome(const reference::Creature& creature,
                                         const reference::AgentBody& body);

}  // namespace skitter::test
