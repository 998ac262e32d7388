#include <fmt/format.h>

#include <cassert>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "render/child.h"
#include "render/partial_file.h"
#include "skitter/error.h"
#include "skitter/video.h"

namespace skitter {
namespace {

std::vector<std::string> encoder(const std::filesystem::path& output, uint32_t width, uint32_t height,
                                 uint32_t framesPerSecond) {
  return {"ffmpeg", "-hide_banner", "-nostdin", "-loglevel", "error", "-y",
          // in: raw frames
          "-f", "rawvideo", "-pixel_format", "rgba", "-video_size", fmt::format("{}x{}", width, height),
          "-framerate", std::to_string(framesPerSecond), "-i", "pipe:0",
          // 4:2:0 halves both sides, so they must be even
          "-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2,scale=out_color_matrix=bt709:out_range=tv,format=yuv420p",
          "-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "iec61966-2-1", "-c:v",
          "libx264", "-preset", "fast", "-crf", "18", "-movflags", "+faststart", "-f", "mp4",
          output.is_absolute() ? output.string() : "./" + output.string()};
}

}  // namespace

struct VideoWriter::Impl {
  render::PartialFile file;
  std::optional<render::Child> ffmpeg;
  size_t frameBytes;
  uint64_t frames = 0;

  Impl(const std::filesystem::path& name, uint32_t width, uint32_t height, uint32_t framesPerSecond)
      : file(name), frameBytes(size_t(width) * height * 4) {
    assert(width > 0 && height > 0 && framesPerSecond > 0);
    // ffmpeg opens its output only at the first frame; a user should not wait that long for "no such folder".
    FILE* probe = std::fopen(file.part().c_str(), "wb");
    if (!probe) throw failed(std::strerror(errno));
    std::fclose(probe);
    try {
      ffmpeg.emplace(encoder(file.part(), width, height, framesPerSecond));
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
    const std::string words = ffmpeg->lastWords();
    return failed("ffmpeg failed: " + (words.empty() ? "it was ended" : words));
  }
};

VideoWriter::VideoWriter(const std::filesystem::path& file, uint32_t width, uint32_t height,
                         uint32_t framesPerSecond)
    : impl_(std::make_unique<Impl>(file, width, height, framesPerSecond)) {}
VideoWriter::~VideoWriter() = default;
VideoWriter::VideoWriter(VideoWriter&&) noexcept = default;
VideoWriter& VideoWriter::operator=(VideoWriter&&) noexcept = default;

void VideoWriter::write(std::span<const uint8_t> rgba) {
  assert(rgba.size() == impl_->frameBytes);
  if (!impl_->ffmpeg->write(std::as_bytes(rgba))) {
    impl_->ffmpeg->finish();
    throw impl_->ffmpegFailed();
  }
  ++impl_->frames;
}

void VideoWriter::finish() {
  if (impl_->frames == 0) throw impl_->failed("there is no frame to write");
  if (!impl_->ffmpeg->finish()) throw impl_->ffmpegFailed();
  impl_->file.keep();
}

uint64_t VideoWriter::frames() const { return impl_->frames; }

}  // namespace skitter
