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

// Throws Error(input) for a kind of file that is not written.
OutTarget parseOut(const std::string& text);

// Whether a run may write a file of this name into a folder.
bool isPicture(const std::filesystem::path& name);

// About what so many frames take on disk.
double pictureBytes(const OutTarget& target, uint32_t width, uint32_t height, uint64_t frames);

// The frames of a run on their way to disk. Nothing has its name until all is whole; then a folder's frames
// take the place of an earlier run's, so that two runs never mix.
class Pictures {
 public:
  // So many of the pictures last a second of the video.
  Pictures(const OutTarget& target, uint32_t width, uint32_t height, double framesPerSecond,
           double picturesPerSecond);
  ~Pictures();

  // Tightly packed RGBA8 rows, top row first.
  void add(const std::vector<uint8_t>& pixels);
  // Returns what was written, for people to read. Without this call nothing remains.
  std::vector<std::string> finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace skitter::app
