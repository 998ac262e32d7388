#version 460
#extension GL_GOOGLE_include_directive : require
// What all points of a splatted agent share: its place, its light at the body, and which points it has.
#include "picture.glsl"
#include "hash.glsl"
#include "tint.h"
#include "render/splat.h"
#include "lib/load4.glsl"

layout(local_size_x = SPLAT_GROUP) in;
layout(push_constant) uniform ConstantBlock { SplatAgentConstants constants; };
layout(constant_id = CONSTANT_TINTED) const bool TINTED = false;
LOAD4_BUFFER(DRAW_BODY, bodies)
LOAD4_BUFFER(DRAW_TINT, tints)
layout(set = 0, binding = DRAW_GROUND) uniform sampler2D groundMap;
layout(set = 0, binding = DRAW_SHADOW) uniform sampler2DShadow shadowMap;
layout(set = 0, binding = DRAW_INSTANCES, std430) readonly buffer Instances { uint instances[]; };
layout(set = 0, binding = DRAW_COMMANDS, std430) readonly buffer Commands { uint commands[]; };
layout(set = 0, binding = DRAW_SPLAT_STATE, std430) buffer State { uint state[]; };
STORE4_BUFFER(DRAW_SPLATS, splats)

// The share of sunlight that others leave at the body, which is moved off its own shadow.
float unshaded(vec3 p) {
  p += picture.sun.xyz * constants.radius;
  vec3 nearAt = (picture.clipFromPicture[1] * vec4(p, 1.0)).xyz, farAt = (picture.clipFromPicture[2] * vec4(p, 1.0)).xyz;
  bool isNear = max(abs(nearAt.x), abs(nearAt.y)) < 0.98;
  vec3 at = isNear ? nearAt : farAt;
  vec2 place = vec2(0.25, 0.5) * at.xy + vec2(isNear ? 0.25 : 0.75, 0.5);
  float lit = texture(shadowMap, vec3(place, at.z));
  bool inside = max(abs(at.x), abs(at.y)) < 1.0;
  float ahead = dot(p - picture.eye.xyz, picture.forward.xyz);
  return inside ? mix(lit, 1.0, smoothstep(0.8, 0.98, ahead / picture.forward.w)) : 1.0;
}

void main() {
  uint count = commands[SPLAT_LIST * DRAW_WORDS + 1];
  for (uint i = gl_GlobalInvocationID.x; i < count; i += gl_NumWorkGroups.x * SPLAT_GROUP) {
    uint agent = instances[SPLAT_LIST * constants.agents + i];
    vec4 a = LOAD4(bodies, int(agent) * BODY_STRIDE);
    vec3 p = a.xyz + TILE_SIZE * vec3(tileX(a.w) - picture.tile.x, 0.0, tileZ(a.w) - picture.tile.y);
    vec3 fromEye = p - picture.eye.xyz;
    float away = length(fromEye), pixels = constants.radius / (max(away, 1e-3) * picture.eye.w);

    uint first = constants.first[0], end = constants.first[1];
    for (int level = 1; level < SPLAT_LEVELS; ++level)
      if (pixels > constants.pixels[level - 1]) first = constants.first[level], end = constants.first[level + 1];

    // As crowd.vert colours agents.
    uint h = hashed(uvec2(agent + constants.firstAgent, constants.kind));
    float value = LEAST_VALUE + VALUE_RANGE * unitOf(h), warmth = unitOf(h * 0x9E3779B1u) - 0.5;
    vec4 tint = vec4(1.0, 1.0, 1.0, 0.0);
    if (TINTED) tint = LOAD4(tints, int(agent));
    int flags = int(tint.w);
    if ((flags & TINT_VARIED) != 0) value = 1.0, warmth = 0.0;
    vec3 factor = tint.xyz * value * vec3(1.0 + WARMTH_RANGE * warmth, 1.0, 1.0 - WARMTH_RANGE * warmth);
    // Below 0: only the lightness of the points' colours counts.
    float points = float(first) + float(SPLAT_COUNTS) * float(end - first);
    if ((flags & TINT_LIGHTNESS) != 0) points = -points;

    vec2 at = (p.xz - picture.ground.xy) / picture.ground.zw;
    vec4 ground = textureLod(groundMap, (at + 0.5) / vec2(textureSize(groundMap, 0)), 0.0);
    // As light.glsl's haze.
    float depth = away * picture.tile.w;
    float towards = max(dot(fromEye.xz, picture.sun.xz), 0.0) * inversesqrt(max(dot(fromEye.xz, fromEye.xz), 1e-8));
    towards *= towards; towards *= towards; towards *= towards;

    STORE4(splats, i * SPLAT_STRIDE, vec4(p, float(agent)));
    STORE4(splats, i * SPLAT_STRIDE + 1, vec4(factor, points));
    STORE4(splats, i * SPLAT_STRIDE + 2, vec4(ground.w * unshaded(p), ground.z, exp(-depth * depth), towards));

    vec4 clip = picture.clipFromPicture[VIEW_CAMERA] * vec4(p, 1.0);
    float row = (0.5 - 0.5 * clip.y / max(clip.w, 1e-3)) * float(constants.height), reach = 1.5 * pixels + 3.0;
    uint top = uint(clamp(row - reach, 0.0, float(constants.height)));
    uint bottom = uint(clamp(row + reach, 0.0, float(constants.height)));
    atomicMax(state[1], 1u);
    atomicMax(state[STATE_BOTTOM], bottom);
    atomicMax(state[STATE_TOP], constants.height - top);
    atomicAdd(state[STATE_POINTS], end - first);
  }
}
