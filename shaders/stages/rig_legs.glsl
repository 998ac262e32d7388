// Of the rig's record of a leg what is the same for every invocation: for stages over agents, which go through all legs.
#ifndef RIG_LEGS_GLSL
#define RIG_LEGS_GLSL

vec4 rigLegs[LEGS * RIG_LEG_STRIDE];
#define RIG_LEG(leg, i) rigLegs[(leg) * RIG_LEG_STRIDE + (i)]

// To be called before any branch, as `parameters` are read.
void loadRigLegs() {
  [[unroll]] for (int i = 0; i < LEGS * RIG_LEG_STRIDE; ++i) rigLegs[i] = uniformLegs[i];
}

#endif
