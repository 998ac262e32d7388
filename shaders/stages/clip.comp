#version 460
#extension GL_GOOGLE_include_directive : require
#include "stages/awake.glsl"
#include "shared/ik_batch.h"
#include "lib/clip.glsl"

layout(constant_id = CONSTANT_CLIPS) const int CLIPS = 1;

LOAD4_BUFFER(BINDING_BODY, bodies);
LOAD4_BUFFER(BINDING_PLAY, plays);
STORE4_BUFFER(BINDING_PLAY_OUT, playsOut);
LOAD4_BUFFER(BINDING_CLIP, clips);
LOAD4_BUFFER(BINDING_CLIP_FRAME, frames);
layout(set = 0, binding = BINDING_LIST, std430) writeonly buffer ListBlock { uint list[]; };
layout(set = 0, binding = BINDING_COUNTERS, std430) buffer CountersBlock { uint counters[]; };
#include "lib/clip_frame.glsl"

void main() {
  int agent = agentAt(int(gl_GlobalInvocationID.x));
  if (agent < 0) return;
  int playAt = agent * PLAY_STRIDE;
  Body body = LOAD_BODY(agent);
  Play play = unpackPlay(LOAD4(plays, playAt), LOAD4(plays, playAt + 1), LOAD4(plays, playAt + 2));
  float speed = body.surfaceSpeed + abs(body.turnRate) * parameters.homeRadius;

  vec4 to = LOAD4(clips, int(play.to)), from = LOAD4(clips, int(play.from));
  play.toRate = to.w > 0.0 ? min(speed / to.w, parameters.clipRateMost) : 1.0;
  play.fromRate = from.w > 0.0 ? min(speed / from.w, parameters.clipRateMost) : 1.0;
  play.toTime = wrapped(play.toTime + play.toRate * parameters.dt, to.z);
  play.fromTime = wrapped(play.fromTime + play.fromRate * parameters.dt, from.z);
  play.weight = min(1.0, play.weight + parameters.clipFade);

  bool standing = false;
  for (int c = 0; c < CLIPS; ++c) standing = standing || LOAD4(clips, c).w == 0.0;
  float least = 3e38, best = play.to;
  for (int c = 0; c < CLIPS; ++c) {
    float cost = clipCost(parameters, LOAD4(clips, c).w, speed, standing);
    cost -= float(c) == play.to ? parameters.clipHysteresis : 0.0;
    best = cost < least ? float(c) : best;
    least = min(least, cost);
  }
  if (best != play.to && play.weight >= 1.0) {
    vec4 next = LOAD4(clips, int(best));
    float phase = play.toTime / max(to.z, 1e-6);
    play.from = play.to;
    play.fromTime = play.toTime;
    play.fromRate = play.toRate;
    play.to = best;
    play.toTime = next.w > 0.0 && to.w > 0.0 ? phase * next.z : 0.0;
    play.weight = 0.0;
    from = to;
    to = next;
  }

  // Few agents fade from one clip to another in a tick: they are listed for pose.
  if (play.weight < 1.0) {
    uint place = atomicAdd(counters[COUNTER_LISTED], 1u);
    list[place] = uint(agent);
    atomicMax(counters[COUNTER_DISPATCH_X], (place + 1u) * uint(JOINTS) / uint(WORK_GROUP) + 1u);
  }

  STORE4(playsOut, playAt, vec4(play.to, play.toTime, play.from, play.fromTime));
  STORE4(playsOut, playAt + 1, vec4(play.weight, play.toRate, play.fromRate, 0.0));
  STORE4(playsOut, playAt + 2, vec4(frameAt(to, play.toTime), frameAt(from, play.fromTime)));
}
