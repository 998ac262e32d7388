#version 460
#extension GL_GOOGLE_include_directive : require
// Arc lengths from the first key to every key, and whether the spline may be (docs/spline.md).
#include "spline/batch.glsl"
#include "spline/segment.glsl"

STORE4_BUFFER(SPLINE_LENGTH_OUT, lengthsOut);
STORE4_BUFFER(SPLINE_SUMMARY_OUT, summariesOut);

void main() {
  int spline = int(gl_GlobalInvocationID.x);
  if (spline >= int(constants.count)) return;
  float travelled = 0.0, faults = LOAD4(tangents, TANGENT_STRIDE * spline * KEYS).w;
  for (int i = 0; i < SEGMENTS; ++i) {
    float time, begins;
    travelled += cubicLength(segmentAt(spline, i, time, begins), 1.0);
    faults = max(faults, LOAD4(tangents, TANGENT_STRIDE * (spline * KEYS + i + 1)).w);
    STORE4(lengthsOut, spline * KEYS + i + 1, vec4(travelled, 0.0, 0.0, 0.0));
  }
  STORE4(lengthsOut, spline * KEYS, vec4(0.0));
  float first = LOAD4(keys, spline * KEYS).w, last = LOAD4(keys, spline * KEYS + SEGMENTS).w;
  STORE4(summariesOut, spline, vec4(travelled, first, last - first, travelled <= LARGEST_LENGTH ? faults : 1.0));
}
