#pragma once

#include <string>

namespace skitter::crowd {

// How a herd moves; the names are those of a scene's `controller`.
enum class Controller { clip, planted, loop, adaptive };
// Throws Error(input) where it is unknown.
Controller controllerNamed(const std::string& name);
constexpr bool playsClips(Controller c) { return c == Controller::clip || c == Controller::planted; }

}  // namespace skitter::crowd
