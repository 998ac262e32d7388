// Binding numbers of the picture's shaders, set 0.
#ifndef SKITTER_RENDER_BINDINGS_H
#define SKITTER_RENDER_BINDINGS_H

#ifdef __cplusplus
namespace skitter::shared {
#define BINDING inline constexpr int
#else
#define BINDING const int
#endif

BINDING DRAW_PICTURE = 0;    // uniform block Picture
BINDING DRAW_BODY = 1;       // LOAD4
BINDING DRAW_POSE = 2;       // LOAD4
BINDING DRAW_HEIGHTS = 3;    // R32F
BINDING DRAW_GROUND = 4;     // gradient x, z; openness to the sky; sunlight: one texel a height sample
BINDING DRAW_SHADOW = 5;     // depth, compared
BINDING DRAW_INSTANCES = 6;  // uint, written by cull
BINDING DRAW_COMMANDS = 7;   // indirect draws, counted by cull
BINDING DRAW_DRAWN = 8;      // the picture before its edges are smoothed
BINDING DRAW_TINT = 9;       // LOAD4, one an agent; read where CONSTANT_TINTED says so

BINDING DRAW_MATERIAL = 10;  // uniform block MaterialBlock (material.h)
BINDING DRAW_TEXTURES = 11;  // the material's, in the order of TextureRole: five bindings

BINDING DRAW_SPLAT_PARTS = 16;  // LOAD4, SplatPart (picture.h)
BINDING DRAW_SPLATS = 17;       // uint a pixel (splat.glsl)
BINDING DRAW_SPLAT_TILES = 18;  // uint a square of SPLAT_TILE pixels: whether there are any

BINDING DRAW_RATE = 19;        // LOAD4
BINDING DRAW_SHOWN_BODY = 20;  // LOAD4 (InterpolationConstants), and so the others
BINDING DRAW_SHOWN_BODY_OUT = 21;
BINDING DRAW_SHOWN_POSE = 22;
BINDING DRAW_SHOWN_POSE_OUT = 23;

BINDING DRAW_STEP = 24;    // LOAD4
BINDING DRAW_PRINTS = 25;  // LOAD4 (FootprintConstants)
BINDING DRAW_PRINTS_OUT = 26;
BINDING DRAW_PRINT_STEPS = 27;   // float a leg
BINDING DRAW_PRINT_COUNTS = 28;  // uint, from PRINT_TOTAL on
BINDING DRAW_PRINT_LIST = 29;    // uint a print that is seen: its place in the ring

BINDING DRAW_PLAY = 30;  // LOAD4, and so the others
BINDING DRAW_CLIPS = 31;
BINDING DRAW_CLIP_FRAMES = 32;
BINDING DRAW_CLIP_ROWS = 33;

BINDING DRAW_DEPTH = 34;    // the picture's, as far as it is drawn
BINDING DRAW_PYRAMID = 35;  // float a square, level by level (depth_pyramid.glsl)
BINDING DRAW_HULLS = 36;    // LOAD4, HullBox (picture.h)
BINDING DRAW_SEEN = 37;     // uint an agent (look.glsl)

BINDING CONSTANT_INFLUENCES = 0;
BINDING CONSTANT_MATRICES = 1;  // poses are matrices
BINDING CONSTANT_ROOTS = 2;     // colours are written as their square roots, for the edge filter
BINDING CONSTANT_TINTED = 3;    // agents have tints (tint.h)
BINDING CONSTANT_TEXTURES = 4;  // which textures the material has, bit by bit
BINDING CONSTANT_CUTOUT = 5;    // what is less opaque than the material's cutoff is not drawn
BINDING CONSTANT_STUMPS = 6;    // bones may be lost
BINDING CONSTANT_DETAIL = 7;    // what of the ground may be seen: 1 clods, 2 grains and pebbles too
BINDING CONSTANT_SHADED = 8;    // ground on which shadows may fall
BINDING CONSTANT_STARS = 9;
BINDING CONSTANT_SPLAT_PARTS = 10;
BINDING CONSTANT_DENSE = 11;  // ground whose pixels get what varies slowly from its vertices
// From here on the numbers of the light, in the order of `LightNumbers` in render/light.h. As numbers of the
// picture's block they would cost a software device a fifth of what ground costs.
BINDING CONSTANT_LIGHT = 16;
#undef BINDING

#ifdef __cplusplus
}  // namespace skitter::shared
#endif
#endif
