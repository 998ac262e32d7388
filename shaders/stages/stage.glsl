// What every stage's entry point begins with.
#include "lib/load4.glsl"
#include "shared/bindings.h"
#include "shared/records.h"
#include "shared/parameters.h"
#include "lib/math.glsl"
#include "lib/records.glsl"

layout(local_size_x = WORK_GROUP) in;
layout(constant_id = CONSTANT_LEGS) const int LEGS = 8;
layout(constant_id = CONSTANT_BONES) const int BONES = 4;
layout(constant_id = CONSTANT_GROUPS) const int GROUPS = 2;

layout(std140, set = 0, binding = BINDING_PARAMETERS) uniform ParametersBlock {
  Parameters parameters;
  vec4 rigLegs[MOST_LEGS * RIG_LEG_STRIDE];
};
// Of the rig's record of a leg that is the same for every invocation.
#define RIG_LEG(leg, i) rigLegs[(leg) * RIG_LEG_STRIDE + (i)]
layout(push_constant) uniform TickBlock { TickConstants constants; };
