#ifndef CELLS_GLSL
#define CELLS_GLSL
// The agents in the nine cells about a place: three runs, one per row of cells (docs/stages/avoid.md).

struct Runs {
  ivec2 a, b, c;  // place of the first agent, agents
  int all;        // agents of the grid, after whom places begin anew
};

// Reads the buffer `cells` of so many buckets, a power of two.
ivec2 runOf(vec4 cell) { return ivec2(cell.xy); }
#define LOAD_CELL(bucket, buckets) LOAD4(cells, (bucket) & ((buckets) - 1))
#define LOAD_RUNS(bucket, row, buckets)                                                            \
  Runs(runOf(LOAD_CELL((bucket) - (row), buckets)), runOf(LOAD_CELL(bucket, buckets)),             \
       runOf(LOAD_CELL((bucket) + (row), buckets)), int(LOAD_CELL(bucket, buckets).w))

int agentsIn(Runs runs) { return runs.a.y + runs.b.y + runs.c.y; }

// The place of the i-th of them.
int placeIn(Runs runs, int i) {
  int ab = runs.a.y + runs.b.y;
  int at = i < runs.a.y ? runs.a.x + i : i < ab ? runs.b.x + i - runs.a.y : runs.c.x + i - ab;
  return at >= runs.all ? at - runs.all : at;
}

#endif
