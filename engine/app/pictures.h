#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace skitter::app {

// What --out names.
struct OutTarget {
  enum class Kind {
    none,
    folder,   // frame_00000.png, frame_00001.png, ... and skitter.mp4
    video,    // FILE.mp4
    picture,  // FILE.png, of the last frame
  } kind = Kind::none;
  std::filesystem::path path;

  bool isEveryFrame() const { return kind == Kind::folder || kind == Kind::video; }
};

// Throws Error(input) for what cannot be written, before anything is.
OutTarget parseOut(const std::string& text);

// The frames of a run on their way to disk. Files are named .part until they are whole.
class Pictures {
 public:
  // A folder's frames of an earlier run are removed, so that two runs never mix.
  Pictures(const OutTarget& target, uint32_t width, uint32_t height, double framesPerSecond);
  ~Pictures();

  // Tightly packed RGBA8 rows, top row first.
  void add(const std::vector<uint8_t>& pixels);
  // What was written, for people. Without it no video remains.
  std::vector<std::string> finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace skitter::app
