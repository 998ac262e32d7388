#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
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

// The frames of a run on their way to disk, encoded on a thread of their own. Nothing has its name until all
// is whole; then a folder's frames take the place of an earlier run's, so that two runs never mix.
class Pictures {
 public:
  // So many of the pictures last a second of the video.
  Pictures(const OutTarget& target, uint32_t width, uint32_t height, double framesPerSecond,
           double picturesPerSecond);
  ~Pictures();

  // Tightly packed RGBA8 rows, top row first, which stay as they are until settle() says so. Throws the fault
  // of an earlier picture.
  void add(std::span<const uint8_t> pixels);
  // Waits until the first `count` pictures are encoded, or until it is known that they never will be. Throws
  // their fault.
  void settle(uint64_t count);
  uint64_t count() const;  // of those that were added
  // Waits for all, and returns what was written, for people to read. Without this call nothing remains.
  std::vector<std::string> finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace skitter::app
