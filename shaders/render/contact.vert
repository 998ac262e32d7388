#version 460
#extension GL_GOOGLE_include_directive : require
// Ground that a foot or a body keeps from the sky: a small square that lies on the ground below it, moved a
// little towards the eye.
#include "picture.glsl"
#include "fold.glsl"
#include "lib/heightfield.glsl"
#include "lib/load4.glsl"
#include "lib/math.glsl"

layout(constant_id = CONSTANT_STUMPS) const bool STUMPS = false;
layout(push_constant) uniform ConstantBlock { CrowdConstants constants; };
LOAD4_BUFFER(DRAW_BODY, bodies)
LOAD4_BUFFER(DRAW_POSE, poses)
layout(set = 0, binding = DRAW_HEIGHTS) uniform sampler2D heights;

layout(location = 0) in uint agent;
layout(location = 1) in uint bone;
layout(location = 2) in vec4 foot;   // relative to the bone's rest start; metres above ground where it ends
layout(location = 3) in vec4 where;  // x, z from the middle, in radii; radius, metres; share that is kept off
layout(location = 0) out vec2 outFromMiddle;
layout(location = 1) out float outShare;

float groundAt(Field field, vec2 p) {
  vec2 at = (p - picture.ground.xy) / picture.ground.zw;
  return heightAt(heights, field, foldedAt(at, field.last).at).x;
}

void main() {
  vec4 a = LOAD4(bodies, int(agent) * BODY_STRIDE);
  vec3 body = a.xyz + TILE_SIZE * vec3(tileX(a.w) - picture.tile.x, 0.0, tileZ(a.w) - picture.tile.y);
  int entry = (int(agent * constants.palette) + int(bone)) * POSE_STRIDE;
  vec4 start = LOAD4(poses, entry + 1);
  vec3 middle = body + start.xyz + rotate(LOAD4(poses, entry), foot.xyz);

  Field field = fieldOf(heights, vec2(0.0), vec2(1.0));
  float above = middle.y - groundAt(field, middle.xz);
  outShare = where.w * (1.0 - smoothstep(0.0, foot.w, above));
  if (STUMPS && start.w != 0.0) outShare = 0.0;
  outFromMiddle = where.xy;
  vec2 p = middle.xz + where.xy * where.z;
  vec3 position = vec3(p.x, groundAt(field, p), p.y);
  // The ground's triangles differ from the ground by half a pixel, root mean square.
  vec3 toEye = picture.eye.xyz - position;
  float away = length(toEye), depth = away * picture.tile.w;
  outShare *= exp(-depth * depth);
  position += toEye * ((0.012 + 2.0 * picture.eye.w * away) / away);
  gl_Position = picture.clipFromPicture[VIEW_CAMERA] * vec4(position, 1.0);
  if (outShare <= 0.0) gl_Position = vec4(0.0, 0.0, 0.0, 1.0);
}
