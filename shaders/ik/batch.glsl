// What both entry points of the batch begin with.
#include "lib/load4.glsl"
#include "shared/bindings.h"
#include "shared/ik_batch.h"
#include "shared/records.h"
#include "lib/math.glsl"

layout(local_size_x = WORK_GROUP) in;
layout(constant_id = CONSTANT_BONES) const int BONES = 4;
layout(constant_id = CONSTANT_SOLVER) const int SOLVER = SOLVER_STRETCH_ALIGN;
layout(constant_id = CONSTANT_PREVIOUS) const bool PREVIOUS = false;
layout(constant_id = CONSTANT_BASES) const bool BASES = false;
layout(constant_id = CONSTANT_ROTATIONS) const bool ROTATIONS = false;
layout(constant_id = CONSTANT_TWISTS) const bool TWISTS = false;

LOAD4_BUFFER(BATCH_RIG, rig);
LOAD4_BUFFER(BATCH_TARGET, targets);
LOAD4_BUFFER(BATCH_BASE, bases);
LOAD4_BUFFER(BATCH_STATE, states);
STORE4_BUFFER(BATCH_STATE_OUT, statesOut);
STORE4_BUFFER(BATCH_JOINT_OUT, jointsOut);
STORE4_BUFFER(BATCH_ROTATION_OUT, rotationsOut);
STORE4_BUFFER(BATCH_REPORT_OUT, reportsOut);
layout(push_constant) uniform BatchBlock { BatchConstants constants; };

// The least change of the error that counts as progress.
float leastProgress() { return max(1e-3 * constants.tolerance, 3e-7); }
