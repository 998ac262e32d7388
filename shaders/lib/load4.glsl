#ifndef SKITTER_LOAD4
#define SKITTER_LOAD4
#include "shared/load4.h"
#if LOAD4_TEXEL
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#endif

// Records of vec4, read by LOAD4 and written by STORE4. Reads go through an RGBA32F texel buffer or a storage
// buffer, as LOAD4_TEXEL says, whichever a device is measured to be quicker at (engine/gpu/record_access.h); on
// some devices texel buffers are too small. A device that is quicker by texels reaches storage buffers lane by
// lane and number by number, so there a vec4 is written as two numbers of 64 bits, if that is measured to be
// quicker too. Nothing else differs, so all variants compute the same bits.
//
//   LOAD4_BUFFER(0, legs)           declares; set 0, binding 0
//   vec4 a = LOAD4(legs, i);
//   STORE4_BUFFER(1, joints)
//   STORE4(joints, i, a);
//   STORE4_TWO(joints, i, a, b);    a and b at i and i + 1, i even: dearer apart on such a device
// Records of vec2 are written by STORE2.
//
// One VkBuffer may be bound both ways in a dispatch if each record is read only by the invocation that writes
// it, and before it does.
#if !defined(LOAD4_TEXEL)
#error "LOAD4_TEXEL is set by skitter_add_shaders(... LOAD_VARIANTS)"
#endif

#if LOAD4_TEXEL
#define LOAD4_BUFFER(bindingNumber, name) layout(set = 0, binding = bindingNumber) uniform samplerBuffer name;
#define LOAD4(name, i) texelFetch(name, int(i))
layout(constant_id = CONSTANT_WIDE_STORES) const bool WIDE_STORES = true;
uint64_t bitsOf(vec2 v) { return packUint2x32(floatBitsToUint(v)); }
u64vec2 bitsOf(vec4 v) { return u64vec2(bitsOf(v.xy), bitsOf(v.zw)); }
#define STORE4_BUFFER(bindingNumber, name)                                                                         \
  layout(set = 0, binding = bindingNumber, std430) writeonly buffer name##Store4 { vec4 record[]; } name;          \
  layout(set = 0, binding = bindingNumber, std430) writeonly buffer name##Wide4 { u64vec2 record[]; } name##Wide;  \
  layout(set = 0, binding = bindingNumber, std430) writeonly buffer name##Wide8 { u64vec4 record[]; } name##WideTwo;
#define STORE4(name, i, value)                          \
  {                                                     \
    if (WIDE_STORES) name##Wide.record[i] = bitsOf(value); \
    else name.record[i] = (value);                      \
  }
#define STORE4_TWO(name, i, a, b)                                                              \
  {                                                                                            \
    if (WIDE_STORES) name##WideTwo.record[uint(i) / 2u] = u64vec4(bitsOf(a), bitsOf(b));       \
    else name.record[i] = (a), name.record[(i) + 1] = (b);                                     \
  }
#else
#define LOAD4_BUFFER(bindingNumber, name) \
  layout(set = 0, binding = bindingNumber, std430) readonly buffer name##Load4 { vec4 record[]; } name;
#define LOAD4(name, i) (name.record[i])
#define STORE4_BUFFER(bindingNumber, name) \
  layout(set = 0, binding = bindingNumber, std430) writeonly buffer name##Store4 { vec4 record[]; } name;
#define STORE4(name, i, value) name.record[i] = (value)
#define STORE4_TWO(name, i, a, b) STORE4(name, i, a), STORE4(name, (i) + 1, b)
#endif

#define STORE2_BUFFER(bindingNumber, name) \
  layout(set = 0, binding = bindingNumber, std430) writeonly buffer name##Store2 { vec2 record[]; } name;
#define STORE2(name, i, value) name.record[i] = (value)

#endif
