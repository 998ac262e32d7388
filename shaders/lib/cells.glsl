#ifndef CELLS_GLSL
#define CELLS_GLSL
// The agents in the 25 cells about a place: five runs, one per row of cells (docs/stages/avoid.md).

struct Runs {
  ivec4 before;     // agents in the first run, the first two, three and four
  ivec4 toWalker;   // from the number of an agent of the first four runs to its walker
  int lastToWalker;
  int count;        // agents in the runs
  int all;          // walkers of the grid, after which they begin anew
};

Runs runsOf(vec4 a, vec4 b, vec4 c, vec4 d, vec4 e) {
  Runs runs;
  int ab = int(a.y) + int(b.y), abc = ab + int(c.y), abcd = abc + int(d.y);
  runs.before = ivec4(int(a.y), ab, abc, abcd);
  runs.toWalker = ivec4(int(a.x), int(b.x) - int(a.y), int(c.x) - ab, int(d.x) - abc);
  runs.lastToWalker = int(e.x) - abcd;
  runs.count = abcd + int(e.y);
  runs.all = int(c.w);
  return runs;
}

// Reads the buffer `cells` of so many buckets, a power of two.
#define LOAD_CELL(bucket, buckets) LOAD4(cells, (bucket) & ((buckets) - 1))
#define LOAD_RUNS(bucket, row, buckets)                                                                             \
  runsOf(LOAD_CELL((bucket) - 2 * (row), buckets), LOAD_CELL((bucket) - (row), buckets), LOAD_CELL(bucket, buckets), \
         LOAD_CELL((bucket) + (row), buckets), LOAD_CELL((bucket) + 2 * (row), buckets))

// The walker of the i-th of them.
int walkerIn(Runs runs, int i) {
  int at = i + (i < runs.before.x   ? runs.toWalker.x
                : i < runs.before.y ? runs.toWalker.y
                : i < runs.before.z ? runs.toWalker.z
                : i < runs.before.w ? runs.toWalker.w
                                    : runs.lastToWalker);
  return at >= runs.all ? at - runs.all : at;
}

#endif
