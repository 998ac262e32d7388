#pragma once

#include <array>
#include <glm/glm.hpp>

namespace skitter {

// Where the host's axes point, as seen by a creature in Skitter's own, which are right-handed: it faces +Z,
// its left is +X, up is +Y. Those that are left-handed mirror.
//
//              host's x, y, z     a creature faces, its left is
//   rightYUp   x, y, z            +Z, +X    glTF, OpenGL, Godot
//   leftYUp    -x, y, z           +Z, -X    Unity
//   rightZUp   x, -z, y           -Y, +X    Blender
//   leftZUp    z, -x, y           +X, -Y    Unreal
enum class Axes { rightYUp, leftYUp, rightZUp, leftZUp };
inline constexpr std::array allAxes = {Axes::rightYUp, Axes::leftYUp, Axes::rightZUp, Axes::leftZUp};

// The space that the host draws in. Its origin is the point of the world that the host names, so that numbers
// stay small where the host's camera is.
struct HostSpace {
  Axes axes = Axes::rightYUp;
  float metresPerUnit = 1;  // 0.01: the host counts centimetres

  bool isMirrored() const { return axes == Axes::leftYUp || axes == Axes::leftZUp; }
  // Takes a direction or a difference of positions (Skitter's axes, metres) to the host's, without its unit.
  glm::dmat3 turned() const {
    switch (axes) {
      case Axes::rightYUp:
        break;
      case Axes::leftYUp:
        return {-1, 0, 0, 0, 1, 0, 0, 0, 1};
      case Axes::rightZUp:
        return {1, 0, 0, 0, 0, 1, 0, -1, 0};
      case Axes::leftZUp:
        return {0, -1, 0, 0, 0, 1, 1, 0, 0};
    }
    return glm::dmat3(1);
  }
  // A difference of positions in metres, in the host's axes and unit.
  glm::dvec3 from(const glm::dvec3& metres) const { return turned() * metres / double{metresPerUnit}; }
};

}  // namespace skitter
