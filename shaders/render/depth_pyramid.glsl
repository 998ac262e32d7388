// A picture's depths, coarsely: squares of PYRAMID_CELL pixels, of twice as many, and so on, each with the depth of the
// furthest that it shows (after Greene, Kass and Miller 1993, "Hierarchical Z-buffer visibility").
struct PyramidLevel {
  ivec2 size;  // squares
  int first;   // the place of the first among all levels' squares, row by row
};

// Without a loop that some lanes leave early: lavapipe would halve the size once more for these (docs/devices.md).
PyramidLevel pyramidLevel(int level, ivec2 pixels) {
  ivec2 finest = (pixels + PYRAMID_CELL - 1) / PYRAMID_CELL;
  int first = 0;
  for (int i = 0; i < PYRAMID_LEVELS - 1; ++i) {
    ivec2 size = (finest + (1 << i) - 1) >> i;
    first += i < level ? size.x * size.y : 0;
  }
  return PyramidLevel((finest + (1 << level) - 1) >> level, first);
}
