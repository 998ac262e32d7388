#ifndef HEIGHTFIELD_GLSL
#define HEIGHTFIELD_GLSL

// Where samples are: `last` is the last one's number, `inverseSize` 1 / (last + 1).
struct Field {
  vec2 origin, inverseSpacing, last, inverseSize;
};

Field fieldOf(sampler2D heights, vec2 origin, vec2 inverseSpacing) {
  vec2 size = vec2(textureSize(heights, 0));
  return Field(origin, inverseSpacing, size - 1.0, 1.0 / size);
}

// Height and gradient (h, gx, gz) at world (x, z). Four texels and a lerp written out: a sampler's own filter
// has 8-bit weights on real GPUs. They are gathered from the corner between them, half a texel from any others.
vec3 heightAt(sampler2D heights, Field field, vec2 world) {
  vec2 u = clamp((world - field.origin) * field.inverseSpacing, vec2(0.0), field.last);
  vec2 i = min(floor(u), field.last - 1.0);
  vec2 f = u - i;
  vec4 g = textureGather(heights, (i + 1.0) * field.inverseSize);
  float h00 = g.w, h10 = g.z, h01 = g.x, h11 = g.y;
  float h0 = h00 + f.x * (h10 - h00);
  float h1 = h01 + f.x * (h11 - h01);
  float gx0 = h10 - h00, gx1 = h11 - h01;
  return vec3(h0 + f.y * (h1 - h0), (gx0 + f.y * (gx1 - gx0)) * field.inverseSpacing.x,
              (h1 - h0) * field.inverseSpacing.y);
}

#endif
