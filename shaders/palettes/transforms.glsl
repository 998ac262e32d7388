// A transform as the host reads it (include/skitter/palettes.h).
#include "lib/load4.glsl"
#include "lib/math.glsl"
#include "palettes/transforms.h"
#include "skitter/records.h"

layout(local_size_x = WORK_GROUP) in;
layout(constant_id = CONSTANT_QUATERNIONS) const bool QUATERNIONS = false;
layout(push_constant) uniform ConstantBlock { TransformConstants constants; };
LOAD4_BUFFER(TRANSFORM_BODY, bodies)
STORE4_BUFFER(TRANSFORM_OUT, transforms)

vec3 turnedToHost(vec3 v) {
  return vec3(dot(constants.rows[0].xyz, v), dot(constants.rows[1].xyz, v), dot(constants.rows[2].xyz, v));
}

// An agent's position relative to the origin, in metres along world axes. Tiles are subtracted first, so that
// nothing is lost far from the world's origin.
vec3 fromOrigin(vec4 body) {
  vec3 local = vec3(constants.rows[0].w, constants.rows[1].w, constants.rows[2].w);
  return body.xyz - local + TILE_SIZE * vec3(tileX(body.w) - constants.how.x, 0.0, tileZ(body.w) - constants.how.y);
}

void writeVec4(uint transform, uint part, vec4 value) {
  uint at = constants.base + transform * constants.stride + part * constants.plane;
  STORE4(transforms, at, value);
}

void writeMatrix(uint transform, mat3 linear, vec3 position) {
  mat3 sized = constants.size * linear;
  mat3x4 rows = transpose(mat4x3(sized[0], sized[1], sized[2], position));
  for (uint i = 0u; i < 3u; ++i) writeVec4(transform, i, rows[i]);
}

// From rest to `position` and the rotation, in metres along world axes.
void writeRotation(uint transform, vec4 rotation, vec3 position) {
  vec4 turned = vec4(constants.how.w * turnedToHost(rotation.xyz), rotation.w);
  vec3 place = constants.how.z * turnedToHost(position);
  if (QUATERNIONS) {
    writeVec4(transform, 0u, turned);
    writeVec4(transform, 1u, vec4(place, constants.size));
  } else {
    writeMatrix(transform, matrixOf(turned), place);
  }
}

// All that it moves goes to `position`, in metres along world axes.
void writePoint(uint transform, vec3 position) {
  vec3 place = constants.how.z * turnedToHost(position);
  if (QUATERNIONS) {
    writeVec4(transform, 0u, vec4(0.0, 0.0, 0.0, 1.0));
    writeVec4(transform, 1u, vec4(place, 0.0));
  } else {
    writeMatrix(transform, mat3(0.0), place);
  }
}

// Whether nobody is in the place whose body record begins there. The host draws nothing of it.
bool isAbsent(int body) { return LOAD4(bodies, body + 1).w != 0.0; }
void writeNothing(uint transform) {
  for (uint i = 0u; i < (QUATERNIONS ? 2u : 3u); ++i) writeVec4(transform, i, vec4(0.0));
}
