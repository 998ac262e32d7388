#ifndef WAYS_GLSL
#define WAYS_GLSL

// Closer to a stop than so many cells agents go straight.
const float WAY_STRAIGHT = 1.25;

// An agent in a series goes on from a place when the time to it is less than so many arrival radii.
const float WAY_PASSED = 4.0;
// The choices of an agent: x' = a x + c modulo 2^24 (docs/ways.md).
const uint WAY_DRAW_FACTOR = 1140671485u, WAY_DRAW_STEP = 12820163u;

// The number of the next one of `choices` that follow each other from `first` on, and the draw that chose it.
vec2 drawnNext(float draw, float first, float choices) {
  uint drawn = (uint(draw) * WAY_DRAW_FACTOR + WAY_DRAW_STEP) & 0xffffffu;
  return vec2(first + float((drawn * uint(choices)) >> 24), float(drawn));
}

// Desired velocity down the times of the four middles around an agent, (i, j), (i + 1, j), (i, j + 1) and
// (i + 1, j + 1), of which it has gone `f` (docs/ways.md).
vec2 downhill(Parameters q, vec2 manner, vec4 times, vec2 f, out float time) {
  vec2 x = times.yw - times.xz, z = times.zw - times.xy;
  vec2 slope = vec2(mix(x.x, x.y, f.y), mix(z.x, z.y, f.x));
  vec2 rows = mix(times.xz, times.yw, f.x);
  time = mix(rows.x, rows.y, f.y);
  float speed = time < manner.y ? 0.0 : manner.x * min(1.0, time / q.slowRadius);
  return slope * (-speed / max(sqrt(dot(slope, slope)), 1e-6));
}

#endif
