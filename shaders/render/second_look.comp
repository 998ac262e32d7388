#version 460
#extension GL_GOOGLE_include_directive : require
// Finds whom the depth of the ground, of splats and of those who have been drawn does not hide, and lists those of them
// who have not been drawn.
#include "picture.glsl"
#include "depth_pyramid.glsl"
#include "lib/load4.glsl"
#include "lib/math.glsl"
#include "look.glsl"

layout(constant_id = CONSTANT_MATRICES) const bool MATRICES = false;
layout(constant_id = CONSTANT_STUMPS) const bool STUMPS = false;
LOAD4_BUFFER(DRAW_BODY, bodies)
LOAD4_BUFFER(DRAW_POSE, poses)
LOAD4_BUFFER(DRAW_HULLS, boxes)
layout(set = 0, binding = DRAW_PYRAMID, std430) readonly buffer Pyramid { float pyramid[]; };

// Rounding changes a depth by less than this share, in a vertex shader and here.
const float ROUNDING = 1e-5;
// A ribbon is at least half a pixel wide to each side, and reaches half a pixel further at its ends.
const float RIBBON_PIXELS = 0.71;
const float LEAST_AHEAD = 0.05;  // metres, the near plane

// A hull's rectangle in the picture, pixels from the upper left corner, and its nearest depth.
struct Cover {
  vec2 least, most;
  float nearest;
};
const Cover NOTHING = Cover(vec2(1e30), vec2(-1e30), 0.0);

// Adds a box, as its bone carries it. False where it reaches the eye's plane.
bool addBox(vec3 body, int entry, vec4 centre, vec4 extents, inout Cover cover) {
  mat3 turned;
  vec3 middle;
  if (MATRICES) {
    int at = entry * MATRIX_STRIDE;
    mat3x4 rows = mat3x4(LOAD4(poses, at), LOAD4(poses, at + 1), LOAD4(poses, at + 2));
    turned = transpose(mat3(rows));
    middle = vec4(centre.xyz, 1.0) * rows;
  } else {
    vec4 start = LOAD4(poses, entry * POSE_STRIDE + 1);
    turned = matrixOf(LOAD4(poses, entry * POSE_STRIDE));
    // The skin of a lost bone meets in the stump's end (skin.glsl).
    if (STUMPS && start.w != 0.0) turned = mat3(0.0);
    middle = start.xyz + turned * centre.xyz;
  }
  mat3 sides = mat3(turned[0] * extents.x, turned[1] * extents.y, turned[2] * extents.z);  // halves of them
  mat4 view = picture.clipFromPicture[VIEW_CAMERA];
  vec4 at = view * vec4(body + middle, 1.0);
  vec4 x = view * vec4(sides[0], 0.0), y = view * vec4(sides[1], 0.0), z = view * vec4(sides[2], 0.0);
  // No place of the box is further away; ribbons reach so many metres beyond it, towards the eye, too.
  float away = distance(body + middle, picture.eye.xyz) + length(sides[0]) + length(sides[1]) + length(sides[2]);
  float reach = extents.w + RIBBON_PIXELS * away * picture.eye.w;
  float ahead = at.w - abs(x.w) - abs(y.w) - abs(z.w) - reach;
  if (ahead < LEAST_AHEAD) return false;
  // Off the picture's middle a length across the way to the eye covers more pixels.
  float wide = reach / (ahead * picture.eye.w) * (away / ahead);
  vec2 size = vec2(constants.width, constants.height);
  for (int corner = 0; corner < 8; ++corner) {
    vec4 clip = at + ((corner & 1) != 0 ? x : -x) + ((corner & 2) != 0 ? y : -y) + ((corner & 4) != 0 ? z : -z);
    vec2 seenAt = (0.5 + vec2(0.5, -0.5) * clip.xy / clip.w) * size;
    cover.least = min(cover.least, seenAt - wide);
    cover.most = max(cover.most, seenAt + wide);
  }
  cover.nearest = max(cover.nearest, at.z / ahead);
  return true;
}

bool isVisible(Cover cover) {
  ivec2 pixels = ivec2(constants.width, constants.height);
  // A pixel's samples lie anywhere within it.
  ivec2 first = ivec2(floor(clamp(cover.least, vec2(-1.0), vec2(pixels))));
  ivec2 last = ivec2(floor(clamp(cover.most, vec2(-1.0), vec2(pixels))));
  if (any(lessThan(last, ivec2(0))) || any(greaterThanEqual(first, pixels))) return false;
  first = max(first, 0);
  last = min(last, pixels - 1);
  ivec2 span = last - first + 1;
  int level = 0;
  for (int i = 0; i < PYRAMID_LEVELS - 1; ++i) level += max(span.x, span.y) > 2 * PYRAMID_CELL << i ? 1 : 0;
  PyramidLevel squares = pyramidLevel(level, pixels);
  first /= PYRAMID_CELL << level;
  last /= PYRAMID_CELL << level;
  float furthest = 1.0;
  for (int y = first.y; y <= last.y; ++y)
    for (int x = first.x; x <= last.x; ++x) furthest = min(furthest, pyramid[squares.first + y * squares.size.x + x]);
  return cover.nearest * (1.0 + ROUNDING) >= furthest;
}

bool isVisible(int agent) {
  vec4 a = LOAD4(bodies, agent * BODY_STRIDE);
  vec3 body = a.xyz + TILE_SIZE * vec3(tileX(a.w) - picture.tile.x, 0.0, tileZ(a.w) - picture.tile.y);
  Cover cover = NOTHING;
  for (int box = 0; box < int(constants.boxes); ++box) {
    vec4 centre = LOAD4(boxes, 2 * box), extents = LOAD4(boxes, 2 * box + 1);
    int code = int(centre.w);
    if (!addBox(body, agent * int(constants.palette) + code / 2, centre, extents, cover)) return true;
    if (code % 2 == 0) continue;
    if (isVisible(cover)) return true;
    cover = NOTHING;
  }
  return false;
}

void main() {
  uint place = gl_GlobalInvocationID.x;
  for (int i = 0; i < CAMERA_LISTS; ++i) {
    int list = cameraList(i);
    if (place >= countOf(list)) continue;
    uint entry = instances[list * constants.agents + place], agent = agentOf(entry);
    bool visible = isVisible(int(agent)), drawn = seen[agent] != 0u;
    if (visible && !drawn) append(uint(LATER + i), entry);
    seen[agent] = visible ? 1u : 0u;
  }
}
