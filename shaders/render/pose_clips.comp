#version 460
#extension GL_GOOGLE_include_directive : require
// Poses of agents that only play clips, of those whom the picture or its shadows show: frames of the clips, as stage
// clip has found them, or where blocks tick at rates of their own, those of the time at which a picture shows them.
#include "bindings.h"
#include "picture.h"
#include "skitter/records.h"
#include "shared/bindings.h"
#include "shared/ik_batch.h"
#include "shared/parameters.h"
#include "lib/load4.glsl"
#include "lib/math.glsl"
#include "lib/clip.glsl"

layout(local_size_x = WORK_GROUP) in;
layout(push_constant) uniform ConstantBlock { ClipPoseConstants constants; };
LOAD4_BUFFER(DRAW_BODY, bodies)
LOAD4_BUFFER(DRAW_PLAY, plays)
LOAD4_BUFFER(DRAW_CLIP_ROWS, rows)
STORE4_BUFFER(DRAW_SHOWN_POSE_OUT, posesOut)
layout(set = 0, binding = DRAW_INSTANCES, std430) readonly buffer Instances { uint instances[]; };
layout(set = 0, binding = DRAW_COMMANDS, std430) readonly buffer Commands { uint commands[]; };

#ifdef AT_RATES
LOAD4_BUFFER(DRAW_CLIPS, clips)
LOAD4_BUFFER(DRAW_CLIP_FRAMES, frames)
LOAD4_BUFFER(DRAW_RATE, rates)
LOAD4_BUFFER(DRAW_SHOWN_BODY, shownBodies)
STORE4_BUFFER(DRAW_SHOWN_BODY_OUT, shownBodiesOut)
#include "lib/clip_frame.glsl"

// So many of the crowd's ticks before its last one.
Play before(Play play, float ticks) {
  vec4 to = LOAD4(clips, int(play.to)), from = LOAD4(clips, int(play.from));
  play.weight = max(0.0, play.weight - ticks * constants.fade);
  play.frames = vec4(frameAt(to, wrapped(play.toTime - ticks * constants.dt * play.toRate, to.z)),
                     frameAt(from, wrapped(play.fromTime - ticks * constants.dt * play.fromRate, from.z)));
  return play;
}
#endif

void main() {
  uint place = gl_GlobalInvocationID.x;
  if (place >= commands[SHOWN * DRAW_WORDS + 1]) return;
  int agent = int(instances[SHOWN * constants.agents + place]), at = agent * BODY_STRIDE;
  Play play = unpackPlay(LOAD4(plays, agent * PLAY_STRIDE), LOAD4(plays, agent * PLAY_STRIDE + 1),
                         LOAD4(plays, agent * PLAY_STRIDE + 2));
  vec4 orientation = LOAD4(bodies, at + 2);
#ifdef AT_RATES
  vec4 state = LOAD4(shownBodies, at + 1), was = LOAD4(shownBodies, at + 2);
  float share = state.x, ticked = LOAD4(rates, agent).z, back = 0.0;
  if (share < 1.0) {
    orientation = normalize(mix(dot(was, orientation) < 0.0 ? -was : was, orientation, share));
    back = (1.0 - share) * (ticked - state.z);
    play = before(play, back);
  }
  STORE4(shownBodiesOut, at + 1, vec4(share, constants.tick, ticked - back, 0.0));
  STORE4(shownBodiesOut, at + 2, orientation);
#endif
  mat3 turned = matrixOf(orientation);
  for (int joint = 0; joint < JOINTS; ++joint) {
    vec4 m[3];
    LOAD_MATRIX(m, rows, play, joint);
    mat3x4 row = transpose(turned * transpose(mat3x4(m[0], m[1], m[2])));
    for (int r = 0; r < 3; ++r) STORE4(posesOut, (agent * JOINTS + joint) * MATRIX_STRIDE + r, row[r]);
  }
}
