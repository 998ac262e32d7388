#ifndef ABSENT_GLSL
#define ABSENT_GLSL
// Whether nobody is in an agent's place, as the host says: only where the herd has a reserve. Reads the buffer `bodies`,
// which the entry point declares.
layout(constant_id = CONSTANT_RESERVE) const bool RESERVE = false;

bool absent(int agent) { return RESERVE && LOAD4(bodies, agent * BODY_STRIDE + 1).w != 0.0; }

#endif
