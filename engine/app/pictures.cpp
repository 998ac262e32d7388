#include "pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "part_file.h"
#include "skitter/error.h"
#include "skitter/image.h"
#include "skitter/video.h"

namespace skitter::app {
namespace {

namespace fs = std::filesystem;

// "frame_" and at least five digits: what a run leaves behind, and nothing of the user's.
bool isFrame(const fs::path& file) {
  const std::string stem = file.stem().string();
  return file.extension() == ".png" && stem.size() >= 11 && stem.starts_with("frame_") &&
         stem.find_first_not_of("0123456789", 6) == std::string::npos;
}

void removeFrames(const fs::path& folder) {
  std::vector<fs::path> frames;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.is_regular_file() && isFrame(entry.path())) frames.push_back(entry.path());
  }
  for (const fs::path& frame : frames) fs::remove(frame);
}

}  // namespace

OutTarget parseOut(const std::string& text) {
  if (text.empty()) return {};
  const fs::path path = text;
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension == ".mp4" || extension == ".png") {
    checkFileTarget("--out", path);
    return {extension == ".mp4" ? OutTarget::Kind::video : OutTarget::Kind::picture, path};
  }
  for (const char* other : {".avi", ".mov", ".mkv", ".webm", ".gif", ".jpg", ".jpeg", ".bmp", ".json"}) {
    if (extension == other) {
      throw inputError(fmt::format("--out {}: {} is not written, expected a directory, FILE.mp4 or FILE.png",
                                   text, extension));
    }
  }
  checkFolderTarget("--out", path);
  return {OutTarget::Kind::folder, path};
}

struct Pictures::Impl {
  OutTarget target;
  uint32_t width, height;
  uint64_t frames = 0;
  fs::path videoFile;
  std::optional<VideoWriter> video;

  fs::path frameFile(uint64_t frame) const { return target.path / fmt::format("frame_{:05}.png", frame); }
};

Pictures::Pictures(const OutTarget& target, uint32_t width, uint32_t height, double framesPerSecond)
    : impl_(std::make_unique<Impl>(Impl{target, width, height, 0, {}, {}})) {
  if (target.kind == OutTarget::Kind::folder) {
    fs::create_directories(target.path);
    removeFrames(target.path);
  }
  if (!target.isEveryFrame()) return;
  impl_->videoFile = target.kind == OutTarget::Kind::folder ? target.path / "skitter.mp4" : target.path;
  impl_->video.emplace(impl_->videoFile, width, height,
                       static_cast<uint32_t>(std::max(1L, std::lround(framesPerSecond))));
}

Pictures::~Pictures() = default;

void Pictures::add(const std::vector<uint8_t>& pixels) {
  if (impl_->target.kind == OutTarget::Kind::folder) {
    writePng(impl_->frameFile(impl_->frames), impl_->width, impl_->height, pixels);
  } else if (impl_->target.kind == OutTarget::Kind::picture) {
    writePng(impl_->target.path, impl_->width, impl_->height, pixels);
  }
  if (impl_->video) impl_->video->write(pixels);
  ++impl_->frames;
}

std::vector<std::string> Pictures::finish() {
  if (impl_->frames == 0) return {};
  std::vector<std::string> files;
  if (impl_->target.kind == OutTarget::Kind::folder) {
    files.push_back(fmt::format("{} to {}", impl_->frameFile(0).string(),
                                impl_->frameFile(impl_->frames - 1).filename().string()));
  }
  if (impl_->target.kind == OutTarget::Kind::picture) files.push_back(impl_->target.path.string());
  if (impl_->video) {
    impl_->video->finish();
    files.push_back(impl_->videoFile.string());
  }
  return files;
}

}  // namespace skitter::app
