#include "assets/models/reading_notes.h"

#include <algorithm>
#include <mutex>

namespace skitter {
namespace {

constexpr size_t mostLines = 1000;  // a program may read files for ever

struct Noted {
  std::mutex mutex;
  std::vector<std::string> lines;
};
Noted& noted() {
  static Noted all;
  return all;
}

}  // namespace

void noteReading(const std::string& name, const std::vector<std::string>& notes) {
  const std::lock_guard lock(noted().mutex);
  std::vector<std::string>& lines = noted().lines;
  for (const std::string& note : notes) {
    std::string line = name + ": " + note;
    std::replace_if(
        line.begin(), line.end(), [](char c) { return static_cast<unsigned char>(c) < ' '; }, ' ');
    if (lines.size() < mostLines && std::ranges::find(lines, line) == lines.end())
      lines.push_back(std::move(line));
  }
}

std::vector<std::string> readingNotes() {
  const std::lock_guard lock(noted().mutex);
  return noted().lines;
}

}  // namespace skitter
