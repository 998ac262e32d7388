#ifndef ASIDE_GLSL
#define ASIDE_GLSL

// Leg lengths a second, of who parts from others and steps aside (docs/stages/avoid.md).
const float AVOID_PUSH_SPEED = 0.3;

#endif
