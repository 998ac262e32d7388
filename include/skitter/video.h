#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include "skitter/export.h"

namespace skitter {

// An H.264 video (.mp4), encoded by the `ffmpeg` program. It is written as NAME.part and gets its name in
// finish(); a writer that is destroyed before leaves nothing, and where ffmpeg fails, hangs or writes no
// video, an earlier file of the name stays. ffmpeg does not hear a Ctrl-C at the terminal, so that finish()
// still makes a playable file of the frames so far.
class SKITTER_API VideoWriter {
 public:
  // `picturesPerSecond` of those given to write() last a second of the video; 0: as many as it has frames.
  // If there are more frames than the video shows, some are left out; if there are fewer, some are repeated.
  // Both rates at most 1000, and framesPerSecond above 0. Odd sizes are padded to even ones. Throws
  // Error(input) for a size or a rate that cannot be, when the file cannot be written or there is no ffmpeg.
  VideoWriter(const std::filesystem::path& file, uint32_t width, uint32_t height, double framesPerSecond,
              double picturesPerSecond = 0);
  ~VideoWriter();
  VideoWriter(VideoWriter&&) noexcept;
  VideoWriter& operator=(VideoWriter&&) noexcept;

  // Tightly packed RGBA8 sRGB rows, top row first. Throws Error(input) for a picture of another size, and
  // with what ffmpeg said when it has failed.
  void write(std::span<const uint8_t> rgba);
  // Throws Error(input) when ffmpeg failed, or there was no frame.
  void finish();

  uint64_t frames() const;

 private:
  struct SKITTER_LOCAL Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace skitter
