#ifndef EIKONAL_GLSL
#define EIKONAL_GLSL

// The time of a cell that takes h to cross, from the lesser times a and b beside it in x and z: Godunov's upwind
// scheme (docs/ways.md).
float eikonal(float a, float b, float h) {
  float near = min(a, b), apart = abs(a - b);
  return apart >= h ? near + h : 0.5 * (a + b + sqrt(2.0 * h * h - apart * apart));
}

#endif
