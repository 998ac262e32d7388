#version 460
#extension GL_GOOGLE_include_directive : require
// A level of the depth pyramid: the finest from the picture's depth, each other from the one before.
#include "bindings.h"
#include "picture.h"
#include "skitter/records.h"
#include "depth_pyramid.glsl"

layout(local_size_x = WORK_GROUP) in;
layout(push_constant) uniform ConstantBlock { PyramidConstants constants; };
layout(set = 0, binding = DRAW_PYRAMID, std430) buffer Pyramid { float pyramid[]; };
#ifdef SAMPLES
layout(set = 0, binding = DRAW_DEPTH) uniform sampler2DMS depths;
#else
layout(set = 0, binding = DRAW_DEPTH) uniform sampler2D depths;
#endif

float furthestIn(ivec2 pixel) {
#ifdef SAMPLES
  float furthest = 1.0;
  for (int i = 0; i < textureSamples(depths); ++i) furthest = min(furthest, texelFetch(depths, pixel, i).x);
  return furthest;
#else
  return texelFetch(depths, pixel, 0).x;
#endif
}

void main() {
  ivec2 pixels = ivec2(constants.width, constants.height);
  PyramidLevel level = pyramidLevel(int(constants.level), pixels);
  int place = int(gl_GlobalInvocationID.x);
  if (place >= level.size.x * level.size.y) return;
  ivec2 cell = ivec2(place % level.size.x, place / level.size.x);
  float furthest = 1.0;
  if (constants.level == 0u) {
    ivec2 end = min((cell + 1) * PYRAMID_CELL, pixels);
    for (int y = cell.y * PYRAMID_CELL; y < end.y; ++y)
      for (int x = cell.x * PYRAMID_CELL; x < end.x; ++x) furthest = min(furthest, furthestIn(ivec2(x, y)));
  } else {
    PyramidLevel finer = pyramidLevel(int(constants.level) - 1, pixels);
    ivec2 end = min(2 * cell + 2, finer.size);
    for (int y = 2 * cell.y; y < end.y; ++y)
      for (int x = 2 * cell.x; x < end.x; ++x) furthest = min(furthest, pyramid[finer.first + y * finer.size.x + x]);
  }
  pyramid[level.first + place] = furthest;
}
