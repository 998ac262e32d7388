#include "gpu/submit.h"
#include "gpu/transfer.h"
#include "support/gpu_fixture.h"

#include <gmock/gmock.h>

#include <numeric>

namespace skitter::gpu {
namespace {

class BufferTest : public test::GpuTest {};

std::vector<uint8_t> pattern(size_t bytes) {
  std::vector<uint8_t> data(bytes);
  for (size_t i = 0; i < bytes; ++i) data[i] = uint8_t(i * 2654435761u >> 13);
  return data;
}

TEST_F(BufferTest, RoundTripsAnySize) {
  for (const size_t bytes : {0u, 1u, 3u, 15u, 16u, 17u, 4097u, 1234567u}) {
    const Buffer buffer(context(), bytes, "round trip");
    EXPECT_EQ(buffer.size(), bytes);
    const auto data = pattern(bytes);
    upload(context(), buffer, data);
    EXPECT_EQ(download<uint8_t>(context(), buffer), data) << bytes << " bytes";
  }
}

TEST_F(BufferTest, RoundTripsInChunks) {
  const auto data = pattern(1000);
  const Buffer buffer(context(), data.size(), "chunks");
  for (const uint64_t chunk : {1u, 7u, 64u, 999u, 1000u, 1001u}) {
    clear(context(), buffer);
    upload(context(), buffer, data, chunk);
    EXPECT_EQ(download<uint8_t>(context(), buffer, chunk), data) << "chunks of " << chunk;
  }
}

TEST_F(BufferTest, DownloadsTogetherWhatIsAskedFor) {
  const auto data = pattern(1000);
  std::vector<uint8_t> reversed(data.rbegin(), data.rend());
  const Buffer one(context(), data.size(), "one"), other(context(), data.size(), "other");
  upload(context(), one, data);
  upload(context(), other, reversed);
  const std::vector<uint64_t> offsets = {990, 0, 500, 493};
  std::vector<uint8_t> pieces;  // of seven bytes
  for (const uint64_t offset : offsets) pieces.insert(pieces.end(), &data[offset], &data[offset + 7]);
  for (const uint64_t chunk : {uint64_t(1), uint64_t(7), uint64_t(64), uint64_t(1000), kStagingChunk}) {
    Downloads downloads(context(), chunk);
    downloads.run();
    std::vector<uint8_t> whole(1000), none, part(17), seen(4 * 7);
    downloads.add(one, std::as_writable_bytes(std::span(whole)));
    downloads.add(one, std::as_writable_bytes(std::span(none)), 1000);
    downloads.add(other, std::as_writable_bytes(std::span(part)), 983);
    downloads.addPieces(one, std::as_writable_bytes(std::span(seen)), offsets, 7);
    downloads.run();
    EXPECT_EQ(whole, data) << "chunks of " << chunk;
    EXPECT_EQ(part, std::vector<uint8_t>(reversed.end() - 17, reversed.end())) << "chunks of " << chunk;
    EXPECT_EQ(seen, pieces) << "chunks of " << chunk;
    std::fill(whole.begin(), whole.end(), uint8_t{0});
    downloads.add(other, std::as_writable_bytes(std::span(part)), 0);
    downloads.run();
    EXPECT_EQ(whole, std::vector<uint8_t>(1000)) << "what was downloaded before was downloaded again";
    EXPECT_EQ(part, std::vector<uint8_t>(reversed.begin(), reversed.begin() + 17)) << "chunks of " << chunk;
  }
}

TEST_F(BufferTest, RoundTripsOneByteMoreThanTheDefaultChunk) {
  const auto data = pattern(kStagingChunk + 1);
  const Buffer buffer(context(), data.size(), "64 MiB and 1");
  upload(context(), buffer, data);
  EXPECT_TRUE(download<uint8_t>(context(), buffer) == data);
}

TEST_F(BufferTest, UploadTouchesOnlyItsRange) {
  const Buffer buffer(context(), 10, "range");
  upload(context(), buffer, std::vector<uint8_t>(10, 1));
  const auto data = pattern(3);
  uploadBytes(context(), buffer, std::as_bytes(std::span(data)), 4);
  auto expected = std::vector<uint8_t>(10, 1);
  std::copy(data.begin(), data.end(), expected.begin() + 4);
  EXPECT_EQ(download<uint8_t>(context(), buffer), expected);
}

TEST_F(BufferTest, ClearReachesTheLastByte) {
  const Buffer buffer(context(), 37, "clear");
  upload(context(), buffer, std::vector<uint8_t>(37, 0xff));
  clear(context(), buffer);
  EXPECT_EQ(download<uint8_t>(context(), buffer), std::vector<uint8_t>(37, 0));
}

TEST_F(BufferTest, TooLargeSaysHowMuchForWhat) {
  try {
    const Buffer buffer(context(), 1ull << 50, "the whole world");
    FAIL() << "a pebibyte was allocated";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::device);
    EXPECT_THAT(error.what(), ::testing::HasSubstr("the whole world"));
    EXPECT_THAT(error.what(), ::testing::HasSubstr("1073741824.0 MiB"));
  }
}

TEST_F(BufferTest, HostBufferIsMappedBothWays) {
  const HostBuffer up(context(), 64, HostUse::upload, "up");
  const HostBuffer down(context(), 64, HostUse::readback, "down");
  const auto source = up.as<uint32_t>();
  ASSERT_EQ(source.size(), 16u);
  std::iota(source.begin(), source.end(), 7u);
  submitAndWait(context(), [&](vk::CommandBuffer cmd) {
    cmd.copyBuffer(up.handle(), down.handle(), vk::BufferCopy{.size = 64});
    transferToHost(cmd);
  });
  EXPECT_THAT(down.as<uint32_t>(), ::testing::ElementsAreArray(source));
}

}  // namespace
}  // namespace skitter::gpu
