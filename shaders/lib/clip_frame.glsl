#ifndef CLIP_FRAME_GLSL
#define CLIP_FRAME_GLSL
layout(constant_id = CONSTANT_SEARCH_STEPS) const int SEARCH_STEPS = 1;

// Reads the buffer `frames`, which the entry point declares. The frame of a clip at a time, and the fraction to the
// next frame.
vec2 frameAt(vec4 clip, float time) {
  int first = int(clip.x), f = 0;
  for (int k = SEARCH_STEPS - 1; k >= 0; --k) {
    int next = f + (1 << k);
    bool later = next < int(clip.y) && LOAD4(frames, first + min(next, int(clip.y) - 1)).x <= time;
    f = later ? next : f;
  }
  vec4 frame = LOAD4(frames, first + f);
  return vec2(float(first + f), clamp((time - frame.x) * frame.y, 0.0, 1.0));
}

#endif
