#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace skitter::app {

// Letters as lines, for pictures that are drawn in software. Units: capitals are 7 high, and y goes up from
// the line that they stand on.
struct Glyph {
  std::vector<std::vector<glm::vec2>> strokes;  // one of a single point is a dot
  float width = 0;
};
constexpr float glyphHeight = 7, glyphSpace = 1.8f;

// Printable ASCII has glyphs; any other character is a box.
Glyph glyphOf(char character);

}  // namespace skitter::app
