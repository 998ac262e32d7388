#ifndef SUM64_GLSL
#define SUM64_GLSL

// Adds to a number of 64 bits in two words of a buffer, the lower one first. It is a macro because GLSL cannot
// pass a buffer to a function.
#define ADD64(words, at, value)                                        \
  {                                                                    \
    uint before_ = atomicAdd(words[at], value);                        \
    if (before_ + (value) < before_) atomicAdd(words[(at) + 1], 1u);   \
  }

#endif
