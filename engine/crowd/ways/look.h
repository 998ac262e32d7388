#pragma once

#include <optional>
#include <vector>

#include "crowd/herd.h"

// The host looks at agents a few times per second: where those are that are threats or are followed, for
// herds with ways (docs/ways.md), and who carries food (docs/foraging.md).
namespace skitter::crowd {

bool isTimeToLook(const Crowd::Impl& crowd);

// Those that the kind's agents keep off: the caller's, and agents of other kinds.
std::vector<Threat> threatsTo(const Crowd::Impl& crowd, const Kind& kind);

// Whether threats are others than in the tick before the next one. Where it looks, it waits for the device.
bool threatsHaveMoved(Crowd::Impl& crowd);

// The agent or the middle of the herd that the goal follows; none where nobody is there. Waits for the
// device.
std::optional<glm::vec2> leaderOf(const Crowd::Impl& crowd, const Goal& goal);

// Gives foragers what they carry now, and takes it from those who have brought it home. Where it looks, it
// waits for the device.
void loadForagers(Crowd::Impl& crowd);

// World x, z of a body record.
glm::vec2 placeOf(const float* body);

}  // namespace skitter::crowd
