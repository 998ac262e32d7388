// Obstacles as agents see them who keep clear of them (docs/stages/avoid.md): layout.
#ifndef SKITTER_WALLS_H
#define SKITTER_WALLS_H

#ifdef __cplusplus
namespace skitter::shared {
#define WALL inline constexpr int
#else
#define WALL const int
#endif

// BINDING_WALL, vec4.
//   [0] columns, rows, cells a metre, unused
//   [1] x, z of the corner of cell (0, 0), unused x 2
//   [WALL_HEADS + cell] index of the cell's first edge, number of its edges, unused x 2
// An edge, WALL_EDGE_STRIDE; those of an obstacle follow each other, and obstacles are in the scene's order:
//   [0] x, z of its start, x, z of its end
//   [1] radius; 1 if it is the last one of its obstacle; 1 if that is a polygon, which edges go round as +x
//       turns to +z; unused
WALL WALL_HEADS = 2;
WALL WALL_EDGE_STRIDE = 2;
// Obstacles that an agent keeps clear of.
WALL NEAREST_WALLS = 4;

#undef WALL
#ifdef __cplusplus
}  // namespace skitter::shared
#endif
#endif
