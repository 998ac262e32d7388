// A picture's depths, coarsely: squares of PYRAMID_CELL pixels, of twice as many, and so on, each with the depth of the
// furthest that it shows (after Greene, Kass and Miller 1993, "Hierarchical Z-buffer visibility").
struct PyramidLevel {
  ivec2 size;  // squares
  int first;   // the place of the first among all levels' squares, row by row
};

// Without a loop that some lanes leave early, which lavapipe gets wrong (docs/devices.md).
PyramidLevel pyramidLevel(int level, ivec2 pixels) {
  int first = 0;
  for (int i = 0; i < PYRAMID_LEVELS - 1; ++i)
    first += i < level ? pyramidSquares(pixels.x, i) * pyramidSquares(pixels.y, i) : 0;
  return PyramidLevel(ivec2(pyramidSquares(pixels.x, level), pyramidSquares(pixels.y, level)), first);
}
