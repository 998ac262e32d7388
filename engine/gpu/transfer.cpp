#include "gpu/transfer.h"

#include "gpu/spares.h"
#include "gpu/submit.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace skitter::gpu {
namespace {

// Calls step(done, bytes) until `total` bytes are done.
template <class Step>
void inChunks(uint64_t total, uint64_t chunk, Step&& step) {
  assert(chunk > 0);
  for (uint64_t done = 0; done < total; done += chunk) step(done, std::min(chunk, total - done));
}

// Memory of the host for as long as a copy takes. After a failure it is not used again.
class Staging {
 public:
  Staging(const Context& context, uint64_t bytes, HostUse use)
      : context_(context), use_(use), buffer_(context.spares().staging(context, bytes, use)) {}
  vk::Buffer handle() const { return buffer_->handle(); }
  std::byte* data() const { return buffer_->bytes().data(); }
  void giveBack() { context_.spares().giveBack(std::move(buffer_), use_); }

 private:
  const Context& context_;
  HostUse use_;
  std::unique_ptr<HostBuffer> buffer_;
};

// A level of an image goes by whole rows, at least one a chunk.
struct Rows {
  uint32_t level, width, height;
  uint64_t bytes;     // of a row
  uint64_t perChunk;  // rows
};

Rows rowsOf(const Image& image, uint32_t level, uint64_t chunk) {
  const vk::Extent2D whole = image.extent();
  Rows rows{.level = level,
            .width = std::max(1u, whole.width >> level),
            .height = std::max(1u, whole.height >> level),
            .bytes = 0,
            .perChunk = 0};
  rows.bytes = uint64_t(rows.width) * vk::blockSize(image.format());
  rows.perChunk = std::clamp<uint64_t>(chunk / rows.bytes, 1, rows.height);
  return rows;
}

vk::BufferImageCopy regionOf(const Image& image, const Rows& rows, uint64_t firstRow, uint64_t count) {
  return {.imageSubresource = {image.aspect(), rows.level, 0, 1},
          .imageOffset = {0, int32_t(firstRow), 0},
          .imageExtent = {rows.width, uint32_t(count), 1}};
}

}  // namespace

void uploadBytes(const Context& context, const Buffer& buffer, std::span<const std::byte> data,
                 uint64_t offset, uint64_t chunk) {
  assert(offset <= buffer.size() && data.size() <= buffer.size() - offset);
  if (data.empty()) return;
  Staging staging(context, std::min<uint64_t>(chunk, data.size()), HostUse::upload);
  inChunks(data.size(), chunk, [&](uint64_t done, uint64_t bytes) {
    std::memcpy(staging.data(), data.data() + done, bytes);
    submitAndWait(context, [&](vk::CommandBuffer cmd) {
      allToAll(cmd);
      cmd.copyBuffer(staging.handle(), buffer.handle(),
                     vk::BufferCopy{.srcOffset = 0, .dstOffset = offset + done, .size = bytes});
      allToAll(cmd);
    });
  });
  staging.giveBack();
}

void downloadBytes(const Context& context, const Buffer& buffer, std::span<std::byte> data, uint64_t offset,
                   uint64_t chunk) {
  Downloads downloads(context, chunk);
  downloads.add(buffer, data, offset);
  downloads.run();
}

void Downloads::add(const Buffer& buffer, std::span<std::byte> data, uint64_t offset) {
  assert(offset <= buffer.size() && data.size() <= buffer.size() - offset);
  if (!data.empty()) pieces_.push_back({buffer.handle(), offset, data});
}

void Downloads::addPieces(const Buffer& buffer, std::span<std::byte> data, std::span<const uint64_t> offsets,
                          uint64_t bytes) {
  assert(bytes > 0 && data.size() == offsets.size() * bytes);
  pieces_.reserve(pieces_.size() + offsets.size());
  for (size_t i = 0; i < offsets.size(); ++i) add(buffer, data.subspan(i * bytes, bytes), offsets[i]);
}

void Downloads::run() {
  uint64_t total = 0;
  for (const Piece& piece : pieces_) total += piece.data.size();
  if (total == 0) return;
  assert(chunk_ > 0);
  const uint64_t room = std::min(chunk_, total);
  Staging staging(context_, room, HostUse::readback);
  std::vector<Piece> rest = std::exchange(pieces_, {});
  for (size_t first = 0; first < rest.size();) {
    // A submission takes whole pieces, and perhaps the beginning of one more.
    std::vector<Piece> taken;
    for (uint64_t used = 0; first < rest.size() && used < room;) {
      Piece& next = rest[first];
      const uint64_t bytes = std::min<uint64_t>(next.data.size(), room - used);
      taken.push_back({next.from, next.offset, next.data.first(bytes)});
      used += bytes;
      next = {next.from, next.offset + bytes, next.data.subspan(bytes)};
      if (next.data.empty()) ++first;
    }
    submitAndWait(context_, [&](vk::CommandBuffer cmd) {
      allToAll(cmd);
      uint64_t used = 0;
      std::vector<vk::BufferCopy> copies;
      for (size_t i = 0; i < taken.size(); ++i) {
        const Piece& piece = taken[i];
        copies.push_back({.srcOffset = piece.offset, .dstOffset = used, .size = piece.data.size()});
        used += piece.data.size();
        if (i + 1 < taken.size() && taken[i + 1].from == piece.from) continue;
        cmd.copyBuffer(piece.from, staging.handle(), copies);
        copies.clear();
      }
      transferToHost(cmd);
    });
    const std::byte* from = staging.data();
    for (const Piece& piece : taken) {
      std::memcpy(piece.data.data(), from, piece.data.size());
      from += piece.data.size();
    }
  }
  staging.giveBack();
}

void clear(const Context& context, const Buffer& buffer) {
  submitAndWait(context, [&](vk::CommandBuffer cmd) {
    allToAll(cmd);
    cmd.fillBuffer(buffer.handle(), 0, VK_WHOLE_SIZE, 0);
    allToAll(cmd);
  });
}

void uploadLevels(const Context& context, const Image& image,
                  std::span<const std::span<const std::byte>> levels, ImageState after, uint64_t chunk) {
  assert(levels.size() == image.info().levels);
  const Rows first = rowsOf(image, 0, chunk);
  Staging staging(context, first.bytes * first.perChunk, HostUse::upload);
  for (uint32_t level = 0; level < levels.size(); ++level) {
    const Rows rows = rowsOf(image, level, first.bytes * first.perChunk);
    assert(levels[level].size() == rows.bytes * rows.height);
    inChunks(rows.height, rows.perChunk, [&](uint64_t row, uint64_t count) {
      std::memcpy(staging.data(), levels[level].data() + row * rows.bytes, count * rows.bytes);
      submitAndWait(context, [&](vk::CommandBuffer cmd) {
        const bool begins = level == 0 && row == 0;
        const bool ends = level + 1 == levels.size() && row + count == rows.height;
        transition(cmd, image, begins ? ImageState::discard : ImageState::transferDst,
                   ImageState::transferDst);
        cmd.copyBufferToImage(staging.handle(), image.handle(), layoutOf(ImageState::transferDst),
                              regionOf(image, rows, row, count));
        if (ends) transition(cmd, image, ImageState::transferDst, after);
      });
    });
  }
  staging.giveBack();
}

void uploadImageBytes(const Context& context, const Image& image, std::span<const std::byte> data,
                      ImageState after, uint64_t chunk) {
  uploadLevels(context, image, {&data, 1}, after, chunk);
}

void downloadImageBytes(const Context& context, const Image& image, ImageState now, std::span<std::byte> data,
                        uint64_t chunk) {
  const Rows rows = rowsOf(image, 0, chunk);
  assert(data.size() == rows.bytes * rows.height);
  Staging staging(context, rows.bytes * rows.perChunk, HostUse::readback);
  inChunks(rows.height, rows.perChunk, [&](uint64_t row, uint64_t count) {
    submitAndWait(context, [&](vk::CommandBuffer cmd) {
      allToAll(cmd);
      transition(cmd, image, now, ImageState::transferSrc);
      cmd.copyImageToBuffer(image.handle(), layoutOf(ImageState::transferSrc), staging.handle(),
                            regionOf(image, rows, row, count));
      transition(cmd, image, ImageState::transferSrc, now);
      transferToHost(cmd);
    });
    std::memcpy(data.data() + row * rows.bytes, staging.data(), count * rows.bytes);
  });
  staging.giveBack();
}

}  // namespace skitter::gpu
