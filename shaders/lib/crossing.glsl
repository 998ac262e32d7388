#ifndef CROSSING_GLSL
#define CROSSING_GLSL

// Twice the signed area of a triangle.
float area(vec2 a, vec2 b, vec2 c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }

// Whether two segments cross; those that only touch do not.
bool cross2(vec2 a, vec2 b, vec2 c, vec2 d) {
  return area(a, b, c) * area(a, b, d) < 0.0 && area(c, d, a) * area(c, d, b) < 0.0;
}

#endif
