// The rig's bone records that ik's first dispatch reads, as specialization constants of rigs with few legs. A
// leg's constants are chosen from those of all legs, which takes less than loading them.
#ifndef RIG_BONES_GLSL
#define RIG_BONES_GLSL
#include "stages/rig_legs.glsl"

#define BONE_CONSTANT(bone, i, leg) \
  layout(constant_id = CONSTANT_RIG_BONES + (4 * bone + i) * CHOSEN_LEGS + leg) const float bone_##bone##_##i##_##leg = 0.0;
#define BONE_NUMBER(bone, i)                                                                                  \
  BONE_CONSTANT(bone, i, 0) BONE_CONSTANT(bone, i, 1) BONE_CONSTANT(bone, i, 2) BONE_CONSTANT(bone, i, 3)     \
  BONE_CONSTANT(bone, i, 4) BONE_CONSTANT(bone, i, 5) BONE_CONSTANT(bone, i, 6) BONE_CONSTANT(bone, i, 7)
#define BONE_NUMBERS(bone) BONE_NUMBER(bone, 0) BONE_NUMBER(bone, 1) BONE_NUMBER(bone, 2) BONE_NUMBER(bone, 3)
BONE_NUMBERS(0) BONE_NUMBERS(1) BONE_NUMBERS(2) BONE_NUMBERS(3)
BONE_NUMBERS(4) BONE_NUMBERS(5) BONE_NUMBERS(6) BONE_NUMBERS(7)

struct LegBits {
  bool one, two, four;
};
LegBits bitsOfLeg(int leg) { return LegBits((leg & 1) != 0, (leg & 2) != 0, (leg & 4) != 0); }

float chosen(LegBits leg, float a, float b, float c, float d, float e, float f, float g, float h) {
  float ab = leg.one ? b : a, cd = leg.one ? d : c, ef = leg.one ? f : e, gh = leg.one ? h : g;
  float abcd = leg.two ? cd : ab, efgh = leg.two ? gh : ef;
  return leg.four ? efgh : abcd;
}
vec4 chosen(LegBits leg, vec4 a, vec4 b, vec4 c, vec4 d, vec4 e, vec4 f, vec4 g, vec4 h) {
  return vec4(chosen(leg, a.x, b.x, c.x, d.x, e.x, f.x, g.x, h.x), chosen(leg, a.y, b.y, c.y, d.y, e.y, f.y, g.y, h.y),
              chosen(leg, a.z, b.z, c.z, d.z, e.z, f.z, g.z, h.z), chosen(leg, a.w, b.w, c.w, d.w, e.w, f.w, g.w, h.w));
}

#define BONE_CHOSEN(bits, bone, i)                                                                      \
  chosen(bits, bone_##bone##_##i##_0, bone_##bone##_##i##_1, bone_##bone##_##i##_2, bone_##bone##_##i##_3, \
         bone_##bone##_##i##_4, bone_##bone##_##i##_5, bone_##bone##_##i##_6, bone_##bone##_##i##_7)
#define BONE(bits, bone) \
  vec4(BONE_CHOSEN(bits, bone, 0), BONE_CHOSEN(bits, bone, 1), BONE_CHOSEN(bits, bone, 2), BONE_CHOSEN(bits, bone, 3))

vec4 chosenBone(LegBits leg, int bone) {
  switch (bone) {
    case 0: return BONE(leg, 0);
    case 1: return BONE(leg, 1);
    case 2: return BONE(leg, 2);
    case 3: return BONE(leg, 3);
    case 4: return BONE(leg, 4);
    case 5: return BONE(leg, 5);
    case 6: return BONE(leg, 6);
    default: return BONE(leg, 7);
  }
}

vec4 chosenRoot(LegBits leg) {
  return chosen(leg, RIG_LEG(0, 0), RIG_LEG(1, 0), RIG_LEG(2, 0), RIG_LEG(3, 0), RIG_LEG(4, 0), RIG_LEG(5, 0), RIG_LEG(6, 0),
                RIG_LEG(7, 0));
}

#endif
