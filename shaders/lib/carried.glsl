#ifndef CARRIED_GLSL
#define CARRIED_GLSL
// The record `carried` says what an agent carries (docs/loads.md): where, and how many times its own mass.

// This leads from the body's centre of mass to that of body and load, in model space.
vec3 centreShift(Parameters q, vec4 load) { return load.w / (1.0 + load.w) * q.legLength * load.xyz; }

#endif
