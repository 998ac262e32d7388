// What shaders/lib/load4.glsl is specialised by, beside what each shader is.
#ifndef SKITTER_LOAD4_H
#define SKITTER_LOAD4_H

#ifdef __cplusplus
namespace skitter::shared {
inline constexpr int CONSTANT_WIDE_STORES = 99;
}  // namespace skitter::shared
#else
const int CONSTANT_WIDE_STORES = 99;
#endif

#endif
