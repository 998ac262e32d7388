// What every stage's entry point begins with.
#include "lib/load4.glsl"
#include "shared/bindings.h"
#include "skitter/records.h"
#include "shared/parameters.h"
#include "lib/math.glsl"
#include "lib/records.glsl"

layout(local_size_x = WORK_GROUP) in;
layout(constant_id = CONSTANT_LEGS) const int LEGS = 8;
layout(constant_id = CONSTANT_BONES) const int BONES = 4;
layout(constant_id = CONSTANT_GROUPS) const int GROUPS = 2;

layout(push_constant) uniform TickBlock { TickConstants constants; };
// Read at once, before any branch: below one, a device that masks lanes gathers what is uniform lane by lane.
float thisTick = constants.tick;
#ifndef WITHOUT_PARAMETERS
layout(std140, set = 0, binding = BINDING_PARAMETERS) uniform ParametersBlock {
  Parameters uniformParameters;
};
#define DECLARE_KNOWN(i, name) layout(constant_id = CONSTANT_PARAMETERS + i) const float known_##name = 0.0;
KNOWN_PARAMETERS(DECLARE_KNOWN)
Parameters allParameters() {
  Parameters p = uniformParameters;
#define TAKE_KNOWN(i, name) p.name = known_##name;
  KNOWN_PARAMETERS(TAKE_KNOWN)
  return p;
}
Parameters parameters = allParameters();
#endif
