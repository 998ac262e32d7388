#pragma once

#include <string>

namespace skitter::crowd {

// How a herd moves; the names are those of a scene's `controller`.
enum class Controller { clip, planted, pose, loop, adaptive };
// Throws Error(input) where it is unknown.
Controller controllerNamed(const std::string& name);
constexpr bool playsClips(Controller c) { return c == Controller::clip || c == Controller::planted; }
// Played, or sampled for key poses.
constexpr bool needsClips(Controller c) { return playsClips(c) || c == Controller::pose; }

// Whether feet go by steps that foothold aims.
constexpr bool aimsSteps(Controller c) { return c == Controller::adaptive; }
// Whether ik tells which planted feet miss their targets.
constexpr bool tellsMisses(Controller c) { return c == Controller::adaptive || c == Controller::loop; }

}  // namespace skitter::crowd
