// A segment from its records.
LOAD4_BUFFER(SPLINE_KEY, keys);
LOAD4_BUFFER(SPLINE_TANGENT, tangents);

// `time` is how long it takes.
Cubic segmentAt(int spline, int i, out float time, out float begins) {
  int first = spline * KEYS, k = first + i, end = CLOSED && i == SEGMENTS - 1 ? first : k + 1;
  vec4 from = LOAD4(keys, k);
  begins = from.w;
  time = LOAD4(keys, k + 1).w - from.w;
  return cubicOf(from.xyz, time * LOAD4(tangents, TANGENT_STRIDE * k + 1).xyz, LOAD4(keys, end).xyz,
                 time * LOAD4(tangents, TANGENT_STRIDE * (k + 1)).xyz);
}
