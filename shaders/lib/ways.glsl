#ifndef WAYS_GLSL
#define WAYS_GLSL

// Closer to a stop than so many cells agents go straight.
const float WAY_STRAIGHT = 1.25;

// Desired velocity down the times of the four middles around an agent, (i, j), (i + 1, j), (i, j + 1) and
// (i + 1, j + 1), of which it has gone `f` (docs/ways.md).
vec2 downhill(Parameters q, vec2 manner, vec4 times, vec2 f) {
  vec2 x = times.yw - times.xz, z = times.zw - times.xy;
  vec2 slope = vec2(mix(x.x, x.y, f.y), mix(z.x, z.y, f.x));
  vec2 rows = mix(times.xz, times.yw, f.x);
  float time = mix(rows.x, rows.y, f.y);
  float speed = time < manner.y ? 0.0 : manner.x * min(1.0, time / q.slowRadius);
  return slope * (-speed / max(sqrt(dot(slope, slope)), 1e-6));
}

#endif
