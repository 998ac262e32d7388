// What stage avoid hands to stage body (docs/stages/avoid.md).
#ifndef SKITTER_AVOID_H
#define SKITTER_AVOID_H

#ifdef __cplusplus
namespace skitter::shared {
inline constexpr int CONSTANT_AVOIDS = 30;  // whether the herd avoids, so that steer is avoid's record
}  // namespace skitter::shared
#else
const int CONSTANT_AVOIDS = 30;
const float AVOID_PUSH_SPEED = 0.3;  // leg lengths a second, of who parts from others and steps aside
#endif

#endif
