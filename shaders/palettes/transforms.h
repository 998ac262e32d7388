// What the shaders that write a host's transforms are bound to and told.
#ifndef SKITTER_TRANSFORMS_H
#define SKITTER_TRANSFORMS_H

#ifdef __cplusplus
#include <cstdint>
#include <glm/glm.hpp>
namespace skitter::shared {
#define TRANSFORM_CONST inline constexpr int
using glm::vec4;
using uint = uint32_t;
#else
#define TRANSFORM_CONST const int
#endif

TRANSFORM_CONST TRANSFORM_BODY = 0;           // LOAD4
TRANSFORM_CONST TRANSFORM_POSE = 1;           // LOAD4
TRANSFORM_CONST TRANSFORM_START = 2;          // LOAD4: where each entry's bone starts at rest
TRANSFORM_CONST TRANSFORM_OUT = 3;            // the host's
TRANSFORM_CONST CONSTANT_ENTRIES = 0;         // of a palette
TRANSFORM_CONST CONSTANT_JOINTS_STRETCH = 1;  // poses are matrices
TRANSFORM_CONST CONSTANT_QUATERNIONS = 2;     // are written
TRANSFORM_CONST CONSTANT_RELATIVE = 3;        // to the instance's transform
TRANSFORM_CONST CONSTANT_LOSES_BONES = 4;     // bones may be lost

// Push constants.
struct TransformConstants {
  // Rows of the turn to the host's axes; the origin within its tile (metres, world).
  vec4 rows[3];
  // The origin's tile x and z; units a metre where it leads to; -1 where the host's axes mirror, else 1.
  vec4 how;
  uint agents;  // that are written
  uint first;   // of them in the page
  // In vec4: where the first transform begins, from one transform to the next, from one of its vec4 to the
  // next.
  uint base;
  uint stride;
  uint plane;
  float size;  // by which the transforms scale
};

#ifdef __cplusplus
}  // namespace skitter::shared
#endif
#endif
