#include <fmt/format.h>

#include <chrono>
#include <fstream>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "assets/files/partial_file.h"
#include "render/child.h"
#include "skitter/error.h"
#include "skitter/video.h"

namespace skitter {
namespace {

// A frame of 4K takes the encoder a few seconds where many programs share a core.
constexpr std::chrono::seconds patience{30};

constexpr double mostRate = 1000;  // frames a second

// Whether a file begins as MP4 files do.
bool isVideo(const std::filesystem::path& file) {
  char head[8] = {};
  std::ifstream(file, std::ios::binary).read(head, sizeof head);
  return std::string(head + 4, head + 8) == "ftyp";
}

std::vector<std::string> encoder(const std::filesystem::path& output, uint32_t width, uint32_t height,
                                 double framesPerSecond, double picturesPerSecond) {
  return {"ffmpeg", "-hide_banner", "-nostdin", "-loglevel", "error", "-y",
          // in: raw frames
          "-f", "rawvideo", "-pixel_format", "rgba", "-video_size", fmt::format("{}x{}", width, height),
          "-framerate", fmt::format("{:.9g}", picturesPerSecond), "-i", "pipe:0",
          // pictures that are left out or repeated; 4:2:0 halves both sides, so they must be even
          "-vf",
          fmt::format("fps={:.9g}:eof_action=pass,", framesPerSecond) +
              "pad=ceil(iw/2)*2:ceil(ih/2)*2,scale=out_color_matrix=bt709:out_range=tv,format=yuv420p",
          "-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "iec61966-2-1", "-c:v",
          "libx264", "-preset", "fast", "-crf", "18", "-movflags", "+faststart", "-f", "mp4",
          output.is_absolute() ? output.string() : "./" + output.string()};
}

}  // namespace

struct VideoWriter::Impl {
  PartialFile file;
  std::optional<render::Child> ffmpeg;
  size_t frameBytes;
  uint64_t frames = 0;

  Impl(const std::filesystem::path& name, uint32_t width, uint32_t height, double framesPerSecond,
       double picturesPerSecond)
      : file(name), frameBytes(size_t(width) * height * 4) {
    if (width == 0 || height == 0)
      throw failed(fmt::format("frames of {} x {} pixels, expected at least 1 x 1", width, height));
    if (!(framesPerSecond > 0 && framesPerSecond <= mostRate) ||
        !(picturesPerSecond >= 0 && picturesPerSecond <= mostRate))
      throw failed(
          fmt::format("{} frames of {} pictures a second, expected above 0 frames, none or more "
                      "pictures, and at most {} of both",
                      framesPerSecond, picturesPerSecond, mostRate));
    try {
      ffmpeg.emplace(encoder(file.part(), width, height, framesPerSecond,
                             picturesPerSecond > 0 ? picturesPerSecond : framesPerSecond),
                     file.part(), patience);
    } catch (const std::system_error& error) {
      if (error.code() == std::errc::no_such_file_or_directory)
        throw failed("there is no ffmpeg program; install it (Debian: apt install ffmpeg)");
      throw failed(std::string("ffmpeg does not start: ") + error.what());
    }
  }

  Error failed(const std::string& fault) const {
    return inputError(fmt::format("{}: cannot be written: {}", file.name().string(), fault));
  }
  Error ffmpegFailed() const {
    if (ffmpeg->hung())
      return failed(fmt::format("ffmpeg did nothing for {} s and was killed", patience.count()));
    const std::string words = ffmpeg->lastWords();
    return failed("ffmpeg failed: " + (words.empty() ? "it was ended" : words));
  }
};

VideoWriter::VideoWriter(const std::filesystem::path& file, uint32_t width, uint32_t height,
                         double framesPerSecond, double picturesPerSecond)
    : impl_(std::make_unique<Impl>(file, width, height, framesPerSecond, picturesPerSecond)) {}
VideoWriter::~VideoWriter() = default;
VideoWriter::VideoWriter(VideoWriter&&) noexcept = default;
VideoWriter& VideoWriter::operator=(VideoWriter&&) noexcept = default;

void VideoWriter::write(std::span<const uint8_t> rgba) {
  if (rgba.size() != impl_->frameBytes)
    throw impl_->failed(fmt::format("a frame of {} bytes, expected {}", rgba.size(), impl_->frameBytes));
  if (!impl_->ffmpeg->write(std::as_bytes(rgba))) {
    impl_->ffmpeg->finish();
    throw impl_->ffmpegFailed();
  }
  ++impl_->frames;
}

void VideoWriter::finish() {
  if (impl_->frames == 0) throw impl_->failed("there is no frame to write");
  if (!impl_->ffmpeg->finish()) throw impl_->ffmpegFailed();
  if (!isVideo(impl_->file.part()))
    throw impl_->failed("ffmpeg ended well but wrote no video; see what `ffmpeg -version` says");
  impl_->file.keep();
}

uint64_t VideoWriter::frames() const { return impl_->frames; }

}  // namespace skitter
