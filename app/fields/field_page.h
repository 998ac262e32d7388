#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

namespace skitter::app {

// A picture of a page, and what is known about what it shows.
struct PageFigure {
  std::string heading, picture, alternative, caption;
  std::vector<std::pair<std::string, std::string>> facts;  // name and value
};

// An HTML page that shows pictures which lie beside it.
std::string fieldPage(const std::string& title, const std::string& subtitle,
                      std::span<const PageFigure> figures);

}  // namespace skitter::app
