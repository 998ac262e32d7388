#ifndef RARELY_GLSL
#define RARELY_GLSL

// RARELY(c) statement: an `if` for what few invocations need. A device that masks lanes runs the body of an `if`
// whether or not a lane of the subgroup needs it, but skips a loop that none enters. `break` leaves it.
#define RARELY(condition) for (bool rarely_ = (condition); rarely_; rarely_ = false)

#endif
