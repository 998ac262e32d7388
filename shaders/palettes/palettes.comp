#version 460
#extension GL_GOOGLE_include_directive : require
// The palette of each agent, an entry an invocation.
#include "transforms.glsl"

layout(constant_id = CONSTANT_ENTRIES) const int ENTRIES = 1;
layout(constant_id = CONSTANT_JOINTS_STRETCH) const bool JOINTS_STRETCH = false;
layout(constant_id = CONSTANT_RELATIVE) const bool RELATIVE = false;
layout(constant_id = CONSTANT_LOSES_BONES) const bool LOSES_BONES = false;
LOAD4_BUFFER(TRANSFORM_POSE, poses)
LOAD4_BUFFER(TRANSFORM_START, starts)

void main() {
  uint transform = gl_GlobalInvocationID.x;
  uint agent = transform / uint(ENTRIES), entry = transform - agent * uint(ENTRIES);
  if (agent >= constants.agents) return;
  int body = int(constants.first + agent) * BODY_STRIDE;
  if (isAbsent(body)) {
    writeNothing(transform);
    return;
  }
  int pose = int((constants.first + agent) * uint(ENTRIES) + entry) * (JOINTS_STRETCH ? MATRIX_STRIDE : POSE_STRIDE);
  vec3 from = RELATIVE ? vec3(0.0) : fromOrigin(LOAD4(bodies, body));
  vec4 back = LOAD4(bodies, body + 2) * vec4(-1.0, -1.0, -1.0, 1.0);
  if (JOINTS_STRETCH) {
    mat4x3 m = transpose(mat3x4(LOAD4(poses, pose), LOAD4(poses, pose + 1), LOAD4(poses, pose + 2)));
    if (RELATIVE) m = matrixOf(back) * m;
    mat3 turn = transpose(mat3(constants.rows[0].xyz, constants.rows[1].xyz, constants.rows[2].xyz));
    writeMatrix(transform, turn * mat3(m) * transpose(turn), constants.how.z * turnedToHost(m[3] + from));
    return;
  }
  vec4 rotation = LOAD4(poses, pose);
  vec3 place = LOAD4(poses, pose + 1).xyz;
  if (RELATIVE) {
    rotation = quaternionProduct(back, rotation);
    place = rotate(back, place);
  }
  if (LOSES_BONES && LOAD4(poses, pose + 1).w != 0.0) {
    writePoint(transform, from + place);
    return;
  }
  writeRotation(transform, rotation, from + place - rotate(rotation, LOAD4(starts, int(entry)).xyz));
}
