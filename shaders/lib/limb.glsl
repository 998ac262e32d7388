#ifndef LIMB_GLSL
#define LIMB_GLSL
// Rig and chain records to and from a Limb and a Pose. Macros, because GLSL cannot pass a storage buffer to a
// function.

// `at`: the first bone's record.
#define LOAD_LIMB(limb, rig, at)                                            \
  for (int i_ = 0; i_ < BONES; ++i_) {                                      \
    int bone_ = (at) + RIG_BONE_STRIDE * i_;                                \
    vec4 a_ = LOAD4(rig, bone_), b_ = LOAD4(rig, bone_ + 1);                \
    limb.x[i_] = a_.xyz;                                                    \
    limb.bone[i_] = a_.w;                                                   \
    limb.z[i_] = b_.xyz;                                                    \
    limb.y[i_] = cross(b_.xyz, a_.xyz);                                     \
    float k_ = 1.0 / (1.0 + b_.w * b_.w);                                   \
    limb.cosLimit[i_] = (1.0 - b_.w * b_.w) * k_;                           \
    limb.sinLimit[i_] = 2.0 * b_.w * k_;                                    \
    limb.stiffness[i_] = LOAD4(rig, bone_ + 2).w;                           \
    if (mayBe(i_, LIMIT_ELLIPSE | LIMIT_HINGE)) limb.ends[i_] = LOAD4(rig, bone_ + 3); \
    if (!mustBe(i_, LIMIT_CONE) || mayBe(i_, LIMIT_TWIST)) limb.kind[i_] = LOAD4(rig, bone_ + 4); \
  }

#define LOAD_DIRECTIONS(d, chains, at)                                      \
  for (int i_ = 0; i_ < BONES; i_ += 2) {                                   \
    vec4 a_ = LOAD4(chains, (at) + i_ / 2);                                 \
    d[i_] = fromStereographic(a_.xy);                                       \
    if (i_ + 1 < BONES) d[min(i_ + 1, BONES - 1)] = fromStereographic(a_.zw); \
  }

#define STORE_DIRECTIONS(chains, at, d)                                     \
  for (int i_ = 0; i_ < BONES; i_ += 2) {                                   \
    vec2 second_ = i_ + 1 < BONES ? toStereographic(d[min(i_ + 1, BONES - 1)]) : vec2(0.0); \
    STORE4(chains, (at) + i_ / 2, vec4(toStereographic(d[i_]), second_));   \
  }

#define LOAD_TWISTS(twist, chains, at)                                      \
  for (int i_ = 0; i_ < BONES; ++i_) {                                      \
    vec4 a_ = TWISTS ? LOAD4(chains, (at) + i_ / 4) : vec4(0.0);            \
    twist[i_] = a_[i_ & 3];                                                 \
  }

#define STORE_TWISTS(chains, at, twist)                                     \
  for (int i_ = 0; TWISTS && i_ < BONES; i_ += 4) {                         \
    vec4 a_ = vec4(twist[i_], twist[min(i_ + 1, BONES - 1)], twist[min(i_ + 2, BONES - 1)], \
                   twist[min(i_ + 3, BONES - 1)]);                          \
    STORE4(chains, (at) + i_ / 4, a_);                                      \
  }

#endif
