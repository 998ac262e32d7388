#ifndef FADE_GLSL
#define FADE_GLSL
// From one drawing of an agent to another, pixel by pixel in an ordered dither (Bayer 1973): while the agent's radius
// shrinks by FADE_SHARE below a limit, one pixel of FADE_STEPS after another goes over.

const float FADE_SHARE = 0.1;
const float FADE_STEPS = 16.0;
const uint FADED = 16u;
// Where the steps of an instance of a fading list lie, above the agent's number: a crowd has at most 2^24.
const int FADE_SHIFT = 24;

// Where an instance's steps are handed on, after all else that vertex shaders hand on.
const int FADE_LOCATION = 7;

// How many of the steps are done at a radius of so many pixels.
uint fadeOf(float pixels, float limit) {
  return uint(clamp((limit - pixels) / (FADE_SHARE * limit), 0.0, 1.0) * FADE_STEPS);
}

// Whether a pixel has gone over.
bool isFaded(uvec2 pixel, uint fade) {
  uint x = (pixel.x ^ pixel.y) & 3u, y = pixel.y & 3u;
  return ((x & 1u) << 3 | (y & 1u) << 2 | (x & 2u) | y >> 1) < fade;
}

#endif
