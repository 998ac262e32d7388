// What all entry points of the batch begin with.
#include "lib/load4.glsl"
#include "skitter/records.h"
#include "shared/spline_batch.h"
#include "lib/cubic.glsl"

layout(local_size_x = WORK_GROUP) in;
layout(constant_id = CONSTANT_KEYS) const int KEYS = 2;
layout(constant_id = CONSTANT_CLOSED) const bool CLOSED = false;
const int SEGMENTS = KEYS - 1;

layout(push_constant) uniform SplineBlock { SplineConstants constants; };

// NaN is not within.
bool within(vec3 v, float bound) { return all(lessThanEqual(abs(v), vec3(bound))); }
