#include "app/common/warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <set>
#include <string>
#include <vector>

#include "assets/models/reading_notes.h"

namespace skitter::app {
namespace {

void warn(const std::string& note) {
  static std::set<std::string> said;
  if (said.insert(note).second) fmt::print(stderr, "warning: {}\n", note);
}

}  // namespace

void warnOfImages(const Renderer& renderer) {
  for (const std::string& note : renderer.notes()) warn(note);
}

ModelWarnings::~ModelWarnings() {
  const std::vector<std::string> notes = readingNotes();
  constexpr size_t most = 10;  // a file may be odd in each of a thousand meshes
  for (size_t i = 0; i < std::min(notes.size(), most); ++i) warn(notes[i]);
  if (notes.size() > most) warn(fmt::format("and {} more: skitter inspect lists them", notes.size() - most));
}

}  // namespace skitter::app
