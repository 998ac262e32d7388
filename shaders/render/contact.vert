#version 460
#extension GL_GOOGLE_include_directive : require
// Ground that a foot or a body keeps from the sky: a small square that lies on the ground below it, moved a
// little towards the eye.
#include "decal.glsl"
#include "lib/load4.glsl"
#include "posed.glsl"

layout(push_constant) uniform ConstantBlock { CrowdConstants constants; };
LOAD4_BUFFER(DRAW_BODY, bodies)

layout(location = 0) in uint agent;
layout(location = 1) in uint bone;
layout(location = 2) in vec4 foot;   // relative to the bone's rest start; metres above ground where it ends
layout(location = 3) in vec4 where;  // x, z from the middle, in radii; radius, metres; share that is kept off
layout(location = 0) out vec2 outFromMiddle;
layout(location = 1) out float outShare;

void main() {
  vec4 a = LOAD4(bodies, int(agent) * BODY_STRIDE);
  vec3 body = a.xyz + TILE_SIZE * vec3(tileX(a.w) - picture.tile.x, 0.0, tileZ(a.w) - picture.tile.y);
  bool lost;
  vec3 middle = body + posed(int(agent * constants.palette + bone), foot.xyz, lost);

  Field field = decalField();
  float above = middle.y - groundAt(field, middle.xz);
  outShare = where.w * (1.0 - smoothstep(0.0, foot.w, above));
  if (lost) outShare = 0.0;
  outFromMiddle = where.xy;
  gl_Position = decalAt(field, middle.xz + where.xy * where.z, outShare);
}
