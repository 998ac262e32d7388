#ifndef FOLD_GLSL
#define FOLD_GLSL

// Beyond its edge the terrain goes on as its mirror image, and beyond that as the image of the image.
struct Folded {
  vec2 at;       // the sample seen there
  vec2 way;      // -1 where its image is mirrored along x, z: gradients change sign
  float beyond;  // 0 on the terrain, 1 from ten samples beyond its edge on
};

Folded foldedAt(vec2 at, vec2 last) {
  vec2 turned = mod(at, 2.0 * last), past = max(-at, at - last);
  return Folded(last - abs(turned - last), 1.0 - 2.0 * step(last, turned),
                clamp(0.1 * max(past.x, past.y), 0.0, 1.0));
}

#endif
