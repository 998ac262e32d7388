#version 460
#extension GL_GOOGLE_include_directive : require
// The poses in which those are shown whom the picture or its shadows show, bone by bone.
#include "bindings.h"
#include "picture.h"
#include "skitter/records.h"
#include "lib/load4.glsl"

layout(local_size_x = WORK_GROUP) in;
layout(constant_id = CONSTANT_MATRICES) const bool MATRICES = false;
layout(push_constant) uniform ConstantBlock { InterpolationConstants constants; };
LOAD4_BUFFER(DRAW_POSE, poses)
LOAD4_BUFFER(DRAW_SHOWN_BODY, shownBodies)
STORE4_BUFFER(DRAW_SHOWN_BODY_OUT, shownBodiesOut)
LOAD4_BUFFER(DRAW_SHOWN_POSE, shown)
STORE4_BUFFER(DRAW_SHOWN_POSE_OUT, shownOut)
layout(set = 0, binding = DRAW_INSTANCES, std430) readonly buffer Instances { uint instances[]; };
layout(set = 0, binding = DRAW_COMMANDS, std430) readonly buffer Commands { uint commands[]; };

void main() {
  uint place = gl_GlobalInvocationID.x;
  if (place >= commands[SHOWN * DRAW_WORDS + 1]) return;
  uint agent = instances[SHOWN * constants.agents + place];
  int body = int(agent) * BODY_STRIDE + 1, stride = MATRICES ? MATRIX_STRIDE : POSE_STRIDE;
  int first = int(agent * constants.palette) * stride;
  float share = LOAD4(shownBodies, body).x;
  STORE4(shownBodiesOut, body, vec4(share, constants.tick, 0.0, 0.0));
  for (int entry = 0; entry < int(constants.palette); ++entry) {
    int at = first + entry * stride;
    if (MATRICES) {
      // Each point that they carry goes straight.
      for (int row = 0; row < MATRIX_STRIDE; ++row) {
        vec4 now = LOAD4(poses, at + row);
        STORE4(shownOut, at + row, share < 1.0 ? mix(LOAD4(shown, at + row), now, share) : now);
      }
      continue;
    }
    vec4 rotation = LOAD4(poses, at), start = LOAD4(poses, at + 1);
    vec4 wasRotation = LOAD4(shown, at), wasStart = LOAD4(shown, at + 1);
    // Both quaternions of a rotation are the same to skin; the nearer one is the way to go.
    if (dot(wasRotation, rotation) < 0.0) wasRotation = -wasRotation;
    if (share < 1.0) {
      rotation = normalize(mix(wasRotation, rotation, share));
      start.xyz = mix(wasStart.xyz, start.xyz, share);
    }
    STORE4_TWO(shownOut, at, rotation, start);
  }
}
