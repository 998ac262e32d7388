#ifndef LIMB_GLSL
#define LIMB_GLSL
// Rig and chain records to and from a Limb and a Pose. Macros, because GLSL cannot pass a storage buffer to a
// function.

// `at`: the first bone's record. Stiffness is left to those that pull bones to rest.
#ifdef ONLY_CONES
// `a` is the record's last vec4.
void setBone(inout Limb limb, int i, vec4 a) {
  limb.carry[i] = swungFrame(noTurn(), a.xy, 2.0 / (1.0 + dot(a.xy, a.xy)));
  limb.bone[i] = a.z;
  limb.cosine[i] = a.w;
}

#define LOAD_LIMB(limb, rig, at)                                            \
  for (int i_ = 0; i_ < BONES; ++i_) {                                      \
    setBone(limb, i_, LOAD4(rig, (at) + RIG_BONE_STRIDE * i_ + 7));         \
    limb.edge[i_] = LOAD4(rig, (at) + RIG_BONE_STRIDE * i_ + 6).w;          \
  }
#else
#define LOAD_LIMB(limb, rig, at)                                            \
  for (int i_ = 0; i_ < BONES; ++i_) {                                      \
    int bone_ = (at) + RIG_BONE_STRIDE * i_;                                \
    vec4 a_ = LOAD4(rig, bone_), b_ = LOAD4(rig, bone_ + 1);                \
    vec4 c_ = LOAD4(rig, bone_ + 5), d_ = LOAD4(rig, bone_ + 6);            \
    limb.rest[i_] = Frame(a_.xyz, cross(b_.xyz, a_.xyz), b_.xyz);           \
    limb.carry[i_] = Frame(c_.xyz, cross(d_.xyz, c_.xyz), d_.xyz);          \
    limb.bone[i_] = c_.w;                                                   \
    limb.edge[i_] = d_.w;                                                   \
    if (hasEnds(i_)) limb.ends[i_] = LOAD4(rig, bone_ + 3);                  \
    if (isKind(i_, LIMIT_TWIST)) limb.twists[i_] = LOAD4(rig, bone_ + 4).yz; \
  }
#endif

#define LOAD_SWINGS(swing, chains, at)                                      \
  for (int i_ = 0; i_ < BONES; i_ += 2) {                                   \
    vec4 a_ = LOAD4(chains, (at) + i_ / 2);                                 \
    swing[i_] = vec2(isKind(i_, LIMIT_HINGE) ? 0.0 : a_.x, a_.y);           \
    if (i_ + 1 < BONES)                                                     \
      swing[min(i_ + 1, BONES - 1)] = vec2(isKind(i_ + 1, LIMIT_HINGE) ? 0.0 : a_.z, a_.w); \
  }

// `even`: whether `at` is known to be.
#define STORE_SWINGS(chains, at, swing, even)                               \
  for (int i_ = 0; i_ < BONES; i_ += 4) {                                   \
    vec4 a_ = vec4(swing[i_], i_ + 1 < BONES ? swing[min(i_ + 1, BONES - 1)] : vec2(0.0)); \
    vec4 b_ = vec4(swing[min(i_ + 2, BONES - 1)], i_ + 3 < BONES ? swing[min(i_ + 3, BONES - 1)] : vec2(0.0)); \
    if ((even) && i_ + 2 < BONES) {                                         \
      STORE4_TWO(chains, (at) + i_ / 2, a_, b_);                            \
    } else {                                                                \
      STORE4(chains, (at) + i_ / 2, a_);                                    \
      if (i_ + 2 < BONES) STORE4(chains, (at) + i_ / 2 + 1, b_);            \
    }                                                                       \
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
