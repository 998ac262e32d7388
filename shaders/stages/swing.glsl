#ifndef SWING_STAGE_GLSL
#define SWING_STAGE_GLSL
// Stage swing, for entry points that make it alone or together with ik; they declare its bindings.
#include "lib/hermite.glsl"
#include "stages/hurt.glsl"

#ifdef REACTS
#include "stages/ground.glsl"

// Where a foot goes as its leg folds; `body` is the record's first vec4.
vec4 foldedFoot(vec3 target, int leg, float fold, vec4 body, vec4 orientation) {
  vec3 root = LOAD4(rig, leg * rigStride(BONES)).xyz, home = LOAD4(rig, leg * rigStride(BONES) + 1).xyz;
  vec3 share = vec3(parameters.foldAside, parameters.foldBelow, parameters.foldAside);
  vec3 foot = mix(target, rotate(orientation, root + share * (home - root)), fold);
  float ground = groundAt(worldOf(body.xyz, tileOf(body.w)) + foot.xz).x;
  foot.y = max(foot.y, ground + fold * parameters.stepClearance - body.y);
  return vec4(foot, 0.0);
}
#endif

vec4 makeFoot(int agent, int record) {
#ifdef HURT
  if (!carries(agent, legOfRecord(record, LEGS))) return vec4(0.0);  // it has no target
#endif
  Step s = LOAD_STEP(record);
  vec4 body = LOAD4(bodies, agent * BODY_STRIDE);
  vec3 local = body.xyz;
  vec2 tile = tileOf(body.w);
  float u = stepProgress(s, thisTick);
  Swing flight = swingOf(s, LOAD_ARC(record), local, tile);
  vec4 foot = vec4(u >= 1.0 ? flight.p1 : swingPoint(flight, easedTime(u, startRate(flight))), u);
#ifdef REACTS
  Reaction r = LOAD_REACTION(agent);
  if (isFallen(r.phase)) foot = foldedFoot(foot.xyz, legOfRecord(record, LEGS), r.fold, body, LOAD4(bodies, agent * BODY_STRIDE + 2));
#endif
  return foot;
}

#endif
