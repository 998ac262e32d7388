#ifndef SUPPORT_GLSL
#define SUPPORT_GLSL
// The support polygon of as many points as there are legs.
#include "lib/math.glsl"

// How far the centre is inside the hull of those of `q` that count, which are relative to it; the others are copies of
// one that does. The least support is on a normal of a line through two of them, or right away from one. Points that
// are nearer to each other, or to the centre, than a millionth of `unitLength` give no direction.
float marginOf(vec2 q[LEGS], float unitLength) {
  const float FAR = 3e38;
  float margin = FAR, none = 1e-12 * unitLength * unitLength;
  for (int i = 0; i < LEGS; ++i) {
    vec2 away = -unit(q[i]);
    float support = -FAR;
    for (int k = 0; k < LEGS; ++k) support = max(support, dot(away, q[k]));
    margin = dot(q[i], q[i]) > none ? min(margin, support) : margin;
    for (int j = 0; j < i; ++j) {
      vec2 edge = q[j] - q[i], normal = unit(vec2(-edge.y, edge.x));
      float high = -FAR, low = FAR;
      for (int k = 0; k < LEGS; ++k) {
        float along = dot(normal, q[k]);
        high = max(high, along);
        low = min(low, along);
      }
      margin = dot(edge, edge) > none ? min(margin, min(high, -low)) : margin;
    }
  }
  return margin < FAR ? margin : 0.0;
}

// The same of the tips that are planted, a mask, of all legs' tips; -unitLength where none is.
float marginOfPlanted(vec2 q[LEGS], uint planted, float unitLength) {
  vec2 anchor = vec2(0.0);
  for (int leg = 0; leg < LEGS; ++leg) anchor = (planted >> leg & 1u) != 0u ? q[leg] : anchor;
  for (int leg = 0; leg < LEGS; ++leg) q[leg] = (planted >> leg & 1u) != 0u ? q[leg] : anchor;
  return planted != 0u ? marginOf(q, unitLength) : -unitLength;
}

#endif
