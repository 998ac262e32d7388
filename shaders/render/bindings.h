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

BINDING CONSTANT_INFLUENCES = 0;
BINDING CONSTANT_MATRICES = 1;  // poses are matrices
BINDING CONSTANT_ROOTS = 2;     // colours are written as their square roots, for the edge filter
BINDING CONSTANT_TINTED = 3;    // agents have tints (tint.h)
BINDING CONSTANT_STUMPS = 4;    // bones may be lost
#undef BINDING

#ifdef __cplusplus
}  // namespace skitter::shared
#endif
#endif
