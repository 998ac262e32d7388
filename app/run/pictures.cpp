#include "app/run/pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>

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
  std::optional<StagedFolder> folder;
  std::optional<VideoWriter> video;

  std::mutex mutex;
  std::condition_variable changed;
  // All below is the mutex's.
  std::deque<std::span<const uint8_t>> waiting;
  uint64_t added = 0, encoded = 0;
  std::exception_ptr fault;
  bool ends = false;
  std::thread thread;

  static std::string frameName(uint64_t frame) { return fmt::format("frame_{:05}.png", frame); }

  ~Impl() { end(); }
  void end();
  void encodeAll();
  void encode(std::span<const uint8_t> pixels, uint64_t frame);
};

// What waits is left out.
void Pictures::Impl::end() {
  {
    const std::lock_guard lock(mutex);
    ends = true;
    waiting.clear();
  }
  changed.notify_all();
  if (thread.joinable()) thread.join();
}

void Pictures::Impl::encodeAll() {
  std::unique_lock lock(mutex);
  for (;;) {
    changed.wait(lock, [&] { return ends || !waiting.empty(); });
    if (waiting.empty()) return;
    const std::span<const uint8_t> pixels = waiting.front();
    waiting.pop_front();
    const uint64_t frame = encoded;
    lock.unlock();
    std::exception_ptr failed;
    try {
      encode(pixels, frame);
    } catch (...) {
      failed = std::current_exception();
    }
    lock.lock();
    if (failed) {
      fault = failed;
      waiting.clear();
    } else {
      ++encoded;
    }
    changed.notify_all();
    if (fault) return;
  }
}

void Pictures::Impl::encode(std::span<const uint8_t> pixels, uint64_t frame) {
  if (folder) {
    writePng(folder->add(frameName(frame)), width, height, pixels);
  } else if (target.kind == OutTarget::Kind::picture) {
    writePng(target.path, width, height, pixels);
  }
  if (video) video->write(pixels);
}

Pictures::Pictures(const OutTarget& target, uint32_t width, uint32_t height, double framesPerSecond,
                   double picturesPerSecond)
    : impl_(std::make_unique<Impl>()) {
  impl_->target = target;
  impl_->width = width;
  impl_->height = height;
  if (target.kind == OutTarget::Kind::folder) impl_->folder.emplace(target.path);
  if (target.isEveryFrame())
    impl_->video.emplace(impl_->folder ? impl_->folder->add(videoName) : target.path, width, height,
                         framesPerSecond, picturesPerSecond);
  impl_->thread = std::thread([impl = impl_.get()] { impl->encodeAll(); });
}

Pictures::~Pictures() = default;

void Pictures::add(std::span<const uint8_t> pixels) {
  {
    const std::lock_guard lock(impl_->mutex);
    if (impl_->fault) std::rethrow_exception(impl_->fault);
    impl_->waiting.push_back(pixels);
    ++impl_->added;
  }
  impl_->changed.notify_all();
}

void Pictures::settle(uint64_t count) {
  std::unique_lock lock(impl_->mutex);
  impl_->changed.wait(lock, [&] { return impl_->encoded >= count || impl_->fault; });
  if (impl_->fault) std::rethrow_exception(impl_->fault);
}

uint64_t Pictures::count() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->added;
}

std::vector<std::string> Pictures::finish() {
  const uint64_t frames = count();
  if (frames == 0) return {};
  settle(frames);
  if (impl_->video) impl_->video->finish();
  const fs::path& path = impl_->target.path;
  if (!impl_->folder) return {path.string()};
  const size_t replaced = impl_->folder->commit();
  return {fmt::format("{} to {}{}", (path / Impl::frameName(0)).string(), Impl::frameName(frames - 1),
                      replaced > 0 ? fmt::format(", in place of an earlier run's {} files", replaced) : ""),
          (path / videoName).string()};
}

}  // namespace skitter::app
