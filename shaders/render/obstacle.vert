#version 460
#extension GL_GOOGLE_include_directive : require
// A point of an obstacle, as high above the very surface that the crowd walks on as its vertex says.
#include "picture.glsl"
#include "ground_map.glsl"
#include "lib/heightfield.glsl"

layout(push_constant) uniform ConstantBlock { ObstacleConstants constants; };
layout(set = 0, binding = DRAW_HEIGHTS) uniform sampler2D heights;
layout(location = 0) in vec3 place;   // world x, z; metres above the ground
layout(location = 1) in vec3 normal;  // of a wall on level ground, unit

layout(location = 0) out vec3 outPosition;
layout(location = 1) out vec3 outNormal;
layout(location = 2) out vec3 outAt;    // height sample; metres above the ground
layout(location = 3) out vec2 outOpen;  // openness to the sky, sunlight that hills leave

void main() {
  vec2 p = place.xy - TILE_SIZE * picture.tile.xy;
  vec2 at = (p - picture.ground.xy) / picture.ground.zw;
  Field field = fieldOf(heights, vec2(0.0), vec2(1.0));
  outPosition = vec3(p.x, heightAt(heights, field, foldedAt(at, field.last).at).x + place.z, p.y);
  gl_Position = picture.clipFromPicture[constants.view] * vec4(outPosition, 1.0);

  vec4 ground = groundMapAt(at);
  vec3 up = normalize(vec3(-ground.x, 1.0, -ground.y));
  outNormal = normalize(vec3(normal.x, 0.0, normal.z) + normal.y * up);
  outAt = vec3(at, place.z);
  outOpen = ground.zw;
}
