#pragma once

#include <vector>

#include "crowd/herd.h"

// Where agents of herds with ways keep off (docs/ways.md).
namespace skitter::crowd {

// Those that the kind's agents keep off: the caller's, and agents of other kinds.
std::vector<Threat> threatsTo(const Crowd::Impl& crowd, const Kind& kind);

// Whether threats are others than in the tick before the next one. A few times a second it looks where agents
// are that are threats: it then waits for the device.
bool threatsHaveMoved(Crowd::Impl& crowd);

// World x, z of a body record.
glm::vec2 placeOf(const float* body);

}  // namespace skitter::crowd
