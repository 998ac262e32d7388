#version 460
#extension GL_GOOGLE_include_directive : require
// Points of an agent's skin, posed as the agent is, shaded as crowd.frag does and drawn into the canvas. A pixel is
// the greatest of the words that fall on it, so the order in which they come changes nothing.
#include "picture.glsl"
#include "light.glsl"
#include "tint.h"
#include "render/splat.h"
#include "lib/load4.glsl"
#include "lib/math.glsl"

layout(local_size_x = SPLAT_GROUP) in;
layout(push_constant) uniform ConstantBlock { SplatPointConstants constants; };
layout(constant_id = CONSTANT_MATRICES) const bool MATRICES = false;
layout(constant_id = CONSTANT_STUMPS) const bool STUMPS = false;
LOAD4_BUFFER(DRAW_POSE, poses)
LOAD4_BUFFER(DRAW_POINTS, points)
LOAD4_BUFFER(DRAW_SPLATS, splats)
layout(set = 0, binding = DRAW_COMMANDS, std430) readonly buffer Commands { uint commands[]; };
layout(set = 0, binding = DRAW_CANVAS, std430) buffer Canvas { uint canvas[]; };

void main() {
  uint count = commands[SPLAT_LIST * DRAW_WORDS + 1];
  vec3 sun = picture.sun.xyz;
  for (uint i = gl_WorkGroupID.x; i < count; i += gl_NumWorkGroups.x) {
    vec4 place = LOAD4(splats, i * SPLAT_STRIDE), look = LOAD4(splats, i * SPLAT_STRIDE + 1),
         air = LOAD4(splats, i * SPLAT_STRIDE + 2);
    int range = int(abs(look.w)), first = range % SPLAT_COUNTS, end = first + range / SPLAT_COUNTS;
    for (int k = first + int(gl_LocalInvocationIndex); k < end; k += SPLAT_GROUP) {
      vec4 a = LOAD4(points, k * POINT_STRIDE), b = LOAD4(points, k * POINT_STRIDE + 1);
      vec3 own = LOAD4(points, k * POINT_STRIDE + 2).rgb;
      int entry = (int(place.w) * int(constants.palette) + int(a.w)) * (MATRICES ? MATRIX_STRIDE : POSE_STRIDE);
      vec3 offset, way;
      bool lost = false;
      if (MATRICES) {
        vec4 x = LOAD4(poses, entry), y = LOAD4(poses, entry + 1), z = LOAD4(poses, entry + 2);
        offset = vec3(dot(x, vec4(a.xyz, 1.0)), dot(y, vec4(a.xyz, 1.0)), dot(z, vec4(a.xyz, 1.0)));
        way = unit(vec3(dot(x.xyz, b.xyz), dot(y.xyz, b.xyz), dot(z.xyz, b.xyz)));
      } else {
        vec4 rotation = LOAD4(poses, entry), start = LOAD4(poses, entry + 1);
        offset = start.xyz + rotate(rotation, a.xyz);
        way = rotate(rotation, b.xyz);
        lost = STUMPS && start.w != 0.0;
      }
      vec3 p = place.xyz + offset;
      vec4 clip = picture.clipFromPicture[VIEW_CAMERA] * vec4(p, 1.0);
      vec2 at = (0.5 + vec2(0.5, -0.5) * clip.xy / clip.w) * vec2(constants.width, constants.height);
      if (lost || clip.w <= 0.0 || any(lessThan(at, vec2(0.0))) ||
          any(greaterThanEqual(at, vec2(constants.width, constants.height))))
        continue;

      // A bone is round about its axis and seen from where the eye is. The far side of a skin is seen through
      // gaps between points alone, and turned so that it does not show.
      vec3 toEye = unit(picture.eye.xyz - p);
      float facingEye = dot(way, toEye);
      vec3 normal = b.w != 0.0 ? unit(toEye - way * facingEye) : (facingEye < 0.0 ? -way : way);
      float facing = max(dot(normal, sun), 0.0), lit = air.x;
      float openness = air.y * clamp(0.45 + 1.1 * offset.y, 0.3, 1.0);
      float sheen = max(dot(normal, unit(toEye + sun)), 0.0);
      sheen *= sheen; sheen *= sheen; sheen *= sheen; sheen *= sheen; sheen *= sheen;
      float rim = 1.0 - max(dot(normal, toEye), 0.0);
      rim *= rim * rim;
      if (look.w < 0.0) own = vec3(dot(own, vec3(RED_LIGHTNESS, GREEN_LIGHTNESS, BLUE_LIGHTNESS)));
      vec3 ambient = ambientLight(normal) * openness;
      vec3 light = own * look.rgb * (SUN_LIGHT * (facing * lit) + ambient) +
                   SUN_LIGHT * (0.10 * sheen * lit * smoothstep(0.0, 0.15, facing)) + ambient * (rim * 0.35);
      light = mix(HORIZON + vec3(0.42, 0.25, 0.10) * air.w, light, air.z);

      uvec3 colour = uvec3(developed(light) * vec3(63.0, 63.0, 31.0) + 0.5);
      float depth = 1.0 - (log2(clip.w - constants.nearer) - float(SPLAT_FIRST_OCTAVE)) / float(SPLAT_OCTAVES);
      // 0 is the empty canvas.
      uint word = uint(clamp(depth, 0.0, 1.0) * float(SPLAT_DEPTHS - 1) + 1.5) << 17 | colour.r << 11 | colour.g << 5 | colour.b;
      atomicMax(canvas[int(at.y) * int(constants.width) + int(at.x)], word);
    }
  }
}
