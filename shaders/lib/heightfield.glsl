#ifndef HEIGHTFIELD_GLSL
#define HEIGHTFIELD_GLSL

// Height and gradient (h, gx, gz) at world (x, z). Four texels and a lerp written out: a sampler's own filter
// has 8-bit weights on real GPUs. They are gathered from the corner between them, half a texel from any others.
vec3 heightAt(sampler2D heights, vec2 origin, vec2 inverseSpacing, vec2 world) {
  ivec2 size = textureSize(heights, 0);
  vec2 u = clamp((world - origin) * inverseSpacing, vec2(0.0), vec2(size - 1));
  ivec2 i = min(ivec2(floor(u)), size - 2);
  vec2 f = u - vec2(i);
  vec4 g = textureGather(heights, vec2(i + 1) / vec2(size));
  float h00 = g.w, h10 = g.z, h01 = g.x, h11 = g.y;
  float h0 = h00 + f.x * (h10 - h00);
  float h1 = h01 + f.x * (h11 - h01);
  float gx0 = h10 - h00, gx1 = h11 - h01;
  return vec3(h0 + f.y * (h1 - h0), (gx0 + f.y * (gx1 - gx0)) * inverseSpacing.x, (h1 - h0) * inverseSpacing.y);
}

#endif
