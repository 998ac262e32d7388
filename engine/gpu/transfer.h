#pragma once

#include "gpu/barrier.h"
#include "gpu/buffer.h"
#include "gpu/image.h"

#include <cassert>
#include <span>
#include <vector>

// Copies between host and device for tools and set-up: each is submitted and waited for on the spot, through
// staging memory of at most `chunk` bytes. Never in the frame loop. Earlier submissions are waited for, and
// later ones see the result.
namespace skitter::gpu {

constexpr uint64_t kStagingChunk = 64ull << 20;

void uploadBytes(const Context&, const Buffer&, std::span<const std::byte>, uint64_t offset = 0,
                 uint64_t chunk = kStagingChunk);
void downloadBytes(const Context&, const Buffer&, std::span<std::byte>, uint64_t offset = 0,
                   uint64_t chunk = kStagingChunk);
// Several downloads, with one submission for each chunk of what they give together.
class Downloads {
 public:
  explicit Downloads(const Context& context, uint64_t chunk = kStagingChunk)
      : context_(context), chunk_(chunk) {}
  // The buffer and the memory of `data` must stay until run().
  void add(const Buffer&, std::span<std::byte> data, uint64_t offset = 0);
  // Pieces of `bytes` that begin at `offsets`, one close after another, which is as long as `data`.
  void addPieces(const Buffer&, std::span<std::byte> data, std::span<const uint64_t> offsets, uint64_t bytes);
  // Afterwards there are none.
  void run();

 private:
  struct Piece {
    vk::Buffer from;
    uint64_t offset;
    std::span<std::byte> data;
  };
  const Context& context_;
  uint64_t chunk_;
  std::vector<Piece> pieces_;
};

// Fills it with zero bytes.
void clear(const Context&, const Buffer&);

// `data` may be shorter than the buffer.
template <class T, size_t N>
void upload(const Context& context, const Buffer& buffer, std::span<T, N> data,
            uint64_t chunk = kStagingChunk) {
  static_assert(std::is_trivially_copyable_v<T>);
  uploadBytes(context, buffer, std::as_bytes(data), 0, chunk);
}
template <class T>
void upload(const Context& context, const Buffer& buffer, const std::vector<T>& data,
            uint64_t chunk = kStagingChunk) {
  upload(context, buffer, std::span(data), chunk);
}

// The buffer as whole T; what is left over at the end is dropped.
template <class T>
std::vector<T> download(const Context& context, const Buffer& buffer, uint64_t chunk = kStagingChunk) {
  static_assert(std::is_trivially_copyable_v<T>);
  std::vector<T> data(size_t(buffer.size() / sizeof(T)));
  downloadBytes(context, buffer, std::as_writable_bytes(std::span(data)), 0, chunk);
  return data;
}

// Tightly packed rows of the first layer, level by level. What the image held before is lost; it ends in
// state `after`.
void uploadLevels(const Context&, const Image&, std::span<const std::span<const std::byte>> levels,
                  ImageState after = ImageState::sampled, uint64_t chunk = kStagingChunk);
// The same of an image of one level.
void uploadImageBytes(const Context&, const Image&, std::span<const std::byte>,
                      ImageState after = ImageState::sampled, uint64_t chunk = kStagingChunk);
// The image is in state `now`, and is so afterwards.
void downloadImageBytes(const Context&, const Image&, ImageState now, std::span<std::byte>,
                        uint64_t chunk = kStagingChunk);

template <class T, size_t N>
void uploadImage(const Context& context, const Image& image, std::span<T, N> texels,
                 ImageState after = ImageState::sampled, uint64_t chunk = kStagingChunk) {
  uploadImageBytes(context, image, std::as_bytes(texels), after, chunk);
}
template <class T>
void uploadImage(const Context& context, const Image& image, const std::vector<T>& texels,
                 ImageState after = ImageState::sampled, uint64_t chunk = kStagingChunk) {
  uploadImage(context, image, std::span(texels), after, chunk);
}

// T is a texel, or a component of one.
template <class T>
std::vector<T> downloadImage(const Context& context, const Image& image, ImageState now,
                             uint64_t chunk = kStagingChunk) {
  const uint64_t bytes =
      uint64_t(image.extent().width) * image.extent().height * vk::blockSize(image.format());
  assert(bytes % sizeof(T) == 0);
  std::vector<T> texels(size_t(bytes / sizeof(T)));
  downloadImageBytes(context, image, now, std::as_writable_bytes(std::span(texels)), chunk);
  return texels;
}

}  // namespace skitter::gpu
