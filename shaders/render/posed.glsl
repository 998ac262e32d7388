// A point of an agent, carried by an entry of its palette alone.
#include "lib/load4.glsl"
#include "lib/math.glsl"

layout(constant_id = CONSTANT_MATRICES) const bool MATRICES = false;
layout(constant_id = CONSTANT_STUMPS) const bool STUMPS = false;
LOAD4_BUFFER(DRAW_POSE, poses)

// Relative to the agent's position; of a lost bone the stump's end, as of its skin (skin.glsl).
vec3 posed(int record, vec3 part, out bool lost) {
  if (MATRICES) {
    int entry = record * MATRIX_STRIDE;
    vec4 a = LOAD4(poses, entry), b = LOAD4(poses, entry + 1), c = LOAD4(poses, entry + 2), at = vec4(part, 1.0);
    lost = STUMPS && a.xyz == vec3(0.0) && b.xyz == vec3(0.0);
    return vec3(dot(a, at), dot(b, at), dot(c, at));
  }
  int entry = record * POSE_STRIDE;
  vec4 start = LOAD4(poses, entry + 1);
  lost = STUMPS && start.w != 0.0;
  return start.xyz + rotate(LOAD4(poses, entry), lost ? vec3(0.0) : part);
}
