#include "app/run/pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "app/common/staged_folder.h"
#include "skitter/error.h"
#include "skitter/image.h"
#include "skitter/video.h"

namespace skitter::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* videoName = "skitter.mp4";

// Bytes a pixel, as measured of 1,000 spiders on the built-in ground at 1280 x 720.
constexpr double pictureBytesAPixel = 1.6, videoBytesAPixel = 0.036;

bool isFrame(const fs::path& file) {
  const std::string stem = file.stem().string();
  return file.extension() == ".png" && stem.size() >= 11 && stem.starts_with("frame_") &&
         stem.find_first_not_of("0123456789", 6) == std::string::npos;
}

}  // namespace

OutTarget parseOut(const std::string& text) {
  if (text.empty()) return {};
  const fs::path path = text;
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension == ".mp4" || extension == ".png") {
    return {extension == ".mp4" ? OutTarget::Kind::video : OutTarget::Kind::picture, path};
  }
  for (const char* other : {".avi", ".mov", ".mkv", ".webm", ".gif", ".jpg", ".jpeg", ".bmp", ".json"}) {
    if (extension == other) {
      throw inputError(fmt::format("--out {}: {} is not written, expected a directory, FILE.mp4 or FILE.png",
                                   text, extension));
    }
  }
  return {OutTarget::Kind::folder, path};
}

bool isPicture(const fs::path& name) { return isFrame(name) || name == videoName; }

double pictureBytes(const OutTarget& target, uint32_t width, uint32_t height, uint64_t frames) {
  const double pixels = double{1} * width * height, all = pixels * static_cast<double>(frames);
  switch (target.kind) {
    case OutTarget::Kind::folder:
      return all * (pictureBytesAPixel + videoBytesAPixel);
    case OutTarget::Kind::video:
      return all * videoBytesAPixel;
    case OutTarget::Kind::picture:
      return pixels * pictureBytesAPixel;
    default:
      return 0;
  }
}

struct Pictures::Impl {
  OutTarget target;
  uint32_t width, height;
  uint64_t frames = 0;
  std::optional<StagedFolder> folder;
  std::optional<VideoWriter> video;

  static std::string frameName(uint64_t frame) { return fmt::format("frame_{:05}.png", frame); }
};

Pictures::Pictures(const OutTarget& target, uint32_t width, uint32_t height, double framesPerSecond,
                   double picturesPerSecond)
    : impl_(std::make_unique<Impl>()) {
  impl_->target = target;
  impl_->width = width;
  impl_->height = height;
  if (target.kind == OutTarget::Kind::folder) impl_->folder.emplace(target.path);
  if (!target.isEveryFrame()) return;
  impl_->video.emplace(impl_->folder ? impl_->folder->add(videoName) : target.path, width, height,
                       framesPerSecond, picturesPerSecond);
}

Pictures::~Pictures() = default;

void Pictures::add(const std::vector<uint8_t>& pixels) {
  if (impl_->folder) {
    writePng(impl_->folder->add(Impl::frameName(impl_->frames)), impl_->width, impl_->height, pixels);
  } else if (impl_->target.kind == OutTarget::Kind::picture) {
    writePng(impl_->target.path, impl_->width, impl_->height, pixels);
  }
  if (impl_->video) impl_->video->write(pixels);
  ++impl_->frames;
}

std::vector<std::string> Pictures::finish() {
  if (impl_->frames == 0) return {};
  if (impl_->video) impl_->video->finish();
  const fs::path& path = impl_->target.path;
  if (!impl_->folder) return {path.string()};
  const size_t replaced = impl_->folder->commit();
  return {fmt::format("{} to {}{}", (path / Impl::frameName(0)).string(), Impl::frameName(impl_->frames - 1),
                      replaced > 0 ? fmt::format(", in place of an earlier run's {} files", replaced) : ""),
          (path / videoName).string()};
}

}  // namespace skitter::app
