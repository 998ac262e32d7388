#pragma once

#include <filesystem>
#include <string>

namespace skitter::test {

// How a file is taken: it loads, loads with notes of what is odd, or is refused.
struct Verdict {
  std::string word;   // loads, notes or refused
  std::string fault;  // the refusal, or the notes
};

// A model (.gltf, .glb, anything else) or, of a .png, heights.
Verdict verdictOf(const std::filesystem::path& file);

// Reads the file soon, to the verdict's word, and to one line that holds its fault and, of a refusal, the
// file's name.
void expectVerdict(const std::filesystem::path& file, const Verdict& expected);

}  // namespace skitter::test
