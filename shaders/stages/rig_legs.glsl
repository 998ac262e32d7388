// The part of the rig's leg records that is the same for every invocation, as specialization constants for
// stages over agents, which go through all legs. A uniform is seven instructions a number on lavapipe, a
// constant none.
#ifndef RIG_LEGS_GLSL
#define RIG_LEGS_GLSL

#define RIG_CONSTANT(leg, i) \
  layout(constant_id = CONSTANT_RIG_LEGS + 4 * RIG_LEG_STRIDE * leg + i) const float rig_##leg##_##i = 0.0;
#define RIG_CONSTANTS(leg)                                                                              \
  RIG_CONSTANT(leg, 0) RIG_CONSTANT(leg, 1) RIG_CONSTANT(leg, 2) RIG_CONSTANT(leg, 3)                   \
  RIG_CONSTANT(leg, 4) RIG_CONSTANT(leg, 5) RIG_CONSTANT(leg, 6) RIG_CONSTANT(leg, 7)                   \
  RIG_CONSTANT(leg, 8) RIG_CONSTANT(leg, 9) RIG_CONSTANT(leg, 10) RIG_CONSTANT(leg, 11)
#define RIG_VECTORS(leg)                                              \
  vec4(rig_##leg##_0, rig_##leg##_1, rig_##leg##_2, rig_##leg##_3),   \
      vec4(rig_##leg##_4, rig_##leg##_5, rig_##leg##_6, rig_##leg##_7), \
      vec4(rig_##leg##_8, rig_##leg##_9, rig_##leg##_10, rig_##leg##_11)

RIG_CONSTANTS(0) RIG_CONSTANTS(1) RIG_CONSTANTS(2) RIG_CONSTANTS(3)
RIG_CONSTANTS(4) RIG_CONSTANTS(5) RIG_CONSTANTS(6) RIG_CONSTANTS(7)
RIG_CONSTANTS(8) RIG_CONSTANTS(9) RIG_CONSTANTS(10) RIG_CONSTANTS(11)
RIG_CONSTANTS(12) RIG_CONSTANTS(13) RIG_CONSTANTS(14) RIG_CONSTANTS(15)
RIG_CONSTANTS(16) RIG_CONSTANTS(17) RIG_CONSTANTS(18) RIG_CONSTANTS(19)
RIG_CONSTANTS(20) RIG_CONSTANTS(21) RIG_CONSTANTS(22) RIG_CONSTANTS(23)

vec4 rigLegs[MOST_LEGS * RIG_LEG_STRIDE] = vec4[](
    RIG_VECTORS(0), RIG_VECTORS(1), RIG_VECTORS(2), RIG_VECTORS(3), RIG_VECTORS(4), RIG_VECTORS(5),
    RIG_VECTORS(6), RIG_VECTORS(7), RIG_VECTORS(8), RIG_VECTORS(9), RIG_VECTORS(10), RIG_VECTORS(11),
    RIG_VECTORS(12), RIG_VECTORS(13), RIG_VECTORS(14), RIG_VECTORS(15), RIG_VECTORS(16), RIG_VECTORS(17),
    RIG_VECTORS(18), RIG_VECTORS(19), RIG_VECTORS(20), RIG_VECTORS(21), RIG_VECTORS(22), RIG_VECTORS(23));
#define RIG_LEG(leg, i) rigLegs[(leg) * RIG_LEG_STRIDE + (i)]

#endif
