#pragma once

#include <string>
#include <vector>

namespace skitter {

// Notes on what this process left out or mended as it read models and their clips, so that a program can tell
// its user: lines that begin with the file's name, in the order in which they came, each once.
void noteReading(const std::string& name, const std::vector<std::string>& notes);
std::vector<std::string> readingNotes();

}  // namespace skitter
