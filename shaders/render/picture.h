// What every shader of a picture knows, a uniform block to GLSL (std140: matrices and vec4 only) and a struct
// to C++. Picture space is the world moved by a whole number of tiles, so that the camera is near its origin
// and float32 stays exact wherever on the map the camera is.
#ifndef SKITTER_PICTURE_H
#define SKITTER_PICTURE_H

#ifdef __cplusplus
#include <cstdint>
#include <glm/glm.hpp>
namespace skitter::shared {
#define SKITTER_PICTURE_CONST inline constexpr int
#define SKITTER_PICTURE_FUNCTION constexpr
using glm::mat4;
using glm::vec4;
using uint = uint32_t;
#else
#define SKITTER_PICTURE_CONST const int
#define SKITTER_PICTURE_FUNCTION
#endif

// Two squares beside each other in one shadow map: sharp near the camera, coarse further away.
SKITTER_PICTURE_CONST SHADOW_CASCADES = 2;
// Instance lists of a page, and their indirect draws: the camera's levels of detail, then the near cascade's
// finer and coarser shadows, the far cascade's, who darkens the ground that it touches, and who is drawn as
// splats (splat.comp). Last, who goes over to splats, and is on that list, too, and whose shadow does,
// near and far: an entry holds the agent and how far it has gone (fade.glsl). Where agents have rates of
// their own there is one more, of all that the others have. With occlusion two more of each of the camera's
// lists, of its levels and FADING, are drawn in its place: of whom the last picture showed, and of the others
// whom this one shows.
SKITTER_PICTURE_CONST CAMERA_LODS = 5;
SKITTER_PICTURE_CONST NEAR_FINE = 5;
SKITTER_PICTURE_CONST NEAR_COARSE = 6;
SKITTER_PICTURE_CONST FAR_SHADOWS = 7;
SKITTER_PICTURE_CONST CONTACTS = 8;
SKITTER_PICTURE_CONST SPLATS = 9;
SKITTER_PICTURE_CONST FADING = 10;
SKITTER_PICTURE_CONST NEAR_FADING = 11;
SKITTER_PICTURE_CONST FAR_FADING = 12;
SKITTER_PICTURE_CONST SHOWN = 13;
SKITTER_PICTURE_CONST CAMERA_LISTS = CAMERA_LODS + 1;
SKITTER_PICTURE_FUNCTION int cameraList(int place) { return place < CAMERA_LODS ? place : FADING; }
SKITTER_PICTURE_CONST FIRST_LOOK = 14;
SKITTER_PICTURE_CONST LATER = FIRST_LOOK + CAMERA_LISTS;
SKITTER_PICTURE_CONST INSTANCE_LISTS = LATER + CAMERA_LISTS;
// The camera's levels from this one on are lit at their vertices.
SKITTER_PICTURE_CONST FIRST_VERTEX_LIT = 2;
// clipFromPicture[VIEW_CAMERA], then one of each cascade.
SKITTER_PICTURE_CONST VIEW_CAMERA = 0;
SKITTER_PICTURE_CONST VIEWS = 3;
// Cells along a patch of the ground.
SKITTER_PICTURE_CONST PATCH_CELLS = 8;
// uint32 of a VkDrawIndexedIndirectCommand, or of what lists without draws have in its place (ListDispatch).
SKITTER_PICTURE_CONST DRAW_WORDS = 5;
// Pixels along a square of the picture that is looked at for splats.
SKITTER_PICTURE_CONST SPLAT_TILE = 32;

struct Picture {
  mat4 clipFromPicture[VIEWS];
  vec4 planes[4];  // of the camera's pyramid: inside where dot(xyz, p) + w > 0
  vec4 eye;        // xyz; metres across a pixel one metre away
  vec4 right;      // scaled to the edge of the picture one metre ahead
  vec4 up;         // likewise
  vec4 forward;    // unit; metres ahead at which shadows have faded
  vec4 sun;        // unit, towards the sun
  vec4 tile;       // x, z of the tile at the origin of picture space; distance at which drawing ends;
                   // 1 / distance at which fog has taken 63 %
  vec4 ground;     // picture x, z of height sample (0, 0); metres a sample in x and z
  vec4 shadow;     // metres a texel in the near and the far cascade; height of the eye above the terrain's
                   // highest point, 0 if below; size of the shadow map's square in texels
};

// Push constants of crowd drawing.
struct CrowdConstants {
  uint view;        // into clipFromPicture
  uint palette;     // pose entries an agent
  uint firstAgent;  // of the page among its kind's
  uint kind;
};

// Push constants of drawing obstacles.
struct ObstacleConstants {
  uint view;  // into clipFromPicture
};

// Push constants of cull.
struct CullConstants {
  uint agents;
  float radius;                      // about the body's position, metres
  float lodPixels[CAMERA_LODS - 1];  // the radius in pixels from which each level but the last serves
  float contactPixels;               // the same of contacts
  float splatPixels;                 // the radius in pixels below which an agent is splats
  float shadePixels;                 // the same of its shadow
  uint listsShown;                   // whether there is the list SHOWN
};

// The depth pyramid (depth_pyramid.glsl): pixels along its smallest squares, and its levels.
SKITTER_PICTURE_CONST PYRAMID_CELL = 4;
SKITTER_PICTURE_CONST PYRAMID_LEVELS = 7;
// Squares along so many pixels, at a level.
SKITTER_PICTURE_FUNCTION int pyramidSquares(int pixels, int level) {
  return ((pixels + PYRAMID_CELL - 1) / PYRAMID_CELL + (1 << level) - 1) >> level;
}
struct PyramidConstants {
  uint width, height;  // of the picture
  uint level;
};

// Push constants of first_look and second_look.
struct OcclusionConstants {
  uint agents;         // of the page
  uint palette;        // pose entries an agent
  uint width, height;  // of the picture
  uint boxes;
};

// A box about what a bone carries of the skin, from where the bone starts at rest. Boxes make up hulls: a
// triangle of the skin lies in the convex hull of the boxes of one of these.
struct HullBox {
  vec4 centre;   // metres; twice the bone (entry of the pose palette), and 1 more for a hull's last box
  vec4 extents;  // half of its sides; the largest half width of ribbons
};

// Push constants of interpolate_bodies and interpolate_poses (docs/levels.md, Pictures). They write records
// of an agent as it is shown. Its pose is as `pose` is; its body, of BODY_STRIDE vec4, has
//   [0] local x, y (world), local z, tile: as in `body`
//   [1] the share of the way from the last picture to the agent's state that this one goes;
//       the tick of the last picture that showed the pose, -1 if it was not the last picture; of who plays
//       clips the tick, between two, of which the pose is; unused
//   [2] of who plays clips: the orientation
struct InterpolationConstants {
  uint agents;   // of the page
  uint palette;  // pose entries an agent
  float tick;    // of the crowd, in this picture
  float before;  // in the last one; -1 before the first
};

// Push constants of pose_clips.
struct ClipPoseConstants {
  uint agents;  // of the page
  float tick;   // of the crowd, in this picture
  float dt;     // of its ticks, seconds
  float fade;   // a tick's share of a cross-fade
};

// Footprints (docs/stages/pictures.md): a ring of the latest, of PRINT_STRIDE vec4 each:
//   [0] place: local x, y (world), local z, tile
//   [1] tick of the picture that left it, radius (metres), unused x 2
SKITTER_PICTURE_CONST PRINTS = 131072;
SKITTER_PICTURE_CONST PRINT_STRIDE = 2;
// uint32: how many have been left in all; the indirect dispatch over those of the ring; the indirect draw of
// those that are seen.
SKITTER_PICTURE_CONST PRINT_TOTAL = 0;
SKITTER_PICTURE_CONST PRINT_GROUPS = 1;
SKITTER_PICTURE_CONST PRINT_DRAW = 4;
// In place of the first tick of a step that no picture has found yet.
SKITTER_PICTURE_CONST PRINT_UNSEEN = -16777216;
struct FootprintConstants {
  uint agents;   // of the page; these four serve leave_prints alone
  uint records;  // of its legs
  uint legs;     // of an agent
  float radius;  // of a print, metres
  float tick;    // of the crowd, in this picture
  float life;    // ticks
};

// Push constants of splats and of what draws them.
struct SplatConstants {
  uint palette;     // pose entries an agent
  uint firstAgent;  // of the page among its kind's
  uint kind;
  uint agents;         // of the page
  float radius;        // about the body's position, metres
  uint width, height;  // of the picture
  float splatPixels;   // this and the rest as in CullConstants
  float shadePixels;
};

// A shape between two ends, each relative to the rest start of a bone (entry of the pose palette).
struct SplatPart {
  vec4 from, to;              // xyz; radius, metres
  vec4 colourFrom, colourTo;  // linear RGB; bone
};

#ifdef __cplusplus
}  // namespace skitter::shared
#endif
#endif
