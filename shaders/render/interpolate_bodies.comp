#version 460
#extension GL_GOOGLE_include_directive : require
// Where each agent is shown, and how far its pose goes in this picture.
#include "bindings.h"
#include "picture.h"
#include "skitter/records.h"
#include "lib/load4.glsl"

layout(local_size_x = WORK_GROUP) in;
layout(push_constant) uniform ConstantBlock { InterpolationConstants constants; };
LOAD4_BUFFER(DRAW_BODY, bodies)
LOAD4_BUFFER(DRAW_RATE, rates)
LOAD4_BUFFER(DRAW_SHOWN_BODY, shown)
STORE4_BUFFER(DRAW_SHOWN_BODY_OUT, shownOut)

void main() {
  int agent = int(gl_GlobalInvocationID.x);
  if (agent >= int(constants.agents)) return;
  int at = agent * BODY_STRIDE;
  vec4 now = LOAD4(bodies, at), was = LOAD4(shown, at), state = LOAD4(shown, at + 1), rate = LOAD4(rates, agent);

  // It arrives in the last picture before its next tick, or at once if the last picture did not show it or it was put
  // somewhere else since. The end is compared, not divided: Vulkan lets a device round n / n down.
  bool goesOn = constants.before >= 0.0 && state.y == constants.before && rate.w <= constants.before;
  float arrival = rate.z + float(1 << int(rate.x)) - 1.0;
  float ticks = constants.tick - constants.before, left = arrival - constants.before;
  float share = goesOn && ticks < left ? ticks / left : 1.0;
  vec3 off = was.xyz - now.xyz +
             TILE_SIZE * vec3(tileX(was.w) - tileX(now.w), 0.0, tileZ(was.w) - tileZ(now.w));
  vec3 place = share < 1.0 ? now.xyz + (1.0 - share) * off : now.xyz;
  // Its pose is of before it was put there until it ticks.
  place.y = rate.w > rate.z ? ABSENT_HEIGHT : place.y;
  STORE4_TWO(shownOut, at, vec4(place, now.w), vec4(share, goesOn ? state.y : -1.0, state.z, 0.0));
}
