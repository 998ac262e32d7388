#version 460
#extension GL_GOOGLE_include_directive : require
// The squares of the picture in which there are splats.
#include "picture.glsl"

layout(push_constant) uniform ConstantBlock { SplatConstants constants; };
layout(set = 0, binding = DRAW_SPLAT_TILES, std430) readonly buffer Tiles { uint tiles[]; };

void main() {
  uint across = (constants.width + SPLAT_TILE - 1) / SPLAT_TILE, tile = uint(gl_InstanceIndex);
  uvec2 corner = uvec2(gl_VertexIndex == 1 || gl_VertexIndex >= 4, gl_VertexIndex == 2 || gl_VertexIndex == 3 || gl_VertexIndex == 5);
  vec2 size = vec2(constants.width, constants.height);
  vec2 at = min(vec2((uvec2(tile % across, tile / across) + corner) * SPLAT_TILE), size);
  gl_Position = vec4(vec2(2.0, -2.0) * at / size + vec2(-1.0, 1.0), 0.0, 1.0);
  if (tiles[tile] == 0u) gl_Position = vec4(0.0, 0.0, 0.0, 1.0);
}
