#include "app/common/warnings.h"

#include <fmt/format.h>

#include <cstdio>
#include <set>
#include <string>

namespace skitter::app {

void warnOfImages(const Renderer& renderer) {
  static std::set<std::string> said;
  for (const std::string& note : renderer.notes())
    if (said.insert(note).second) fmt::print(stderr, "warning: {}\n", note);
}

}  // namespace skitter::app
