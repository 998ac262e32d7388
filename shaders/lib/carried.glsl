#ifndef CARRIED_GLSL
#define CARRIED_GLSL
// What an agent carries (docs/loads.md), of its record `carried`: how many times its own mass, and where.

// From the body's centre to that of body and load, model space.
vec3 centreShift(Parameters q, vec4 load) { return load.w / (1.0 + load.w) * q.legLength * load.xyz; }

#endif
