#include "crowd/state_file.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <fstream>
#include <utility>
#include <vector>

#include "assets/files/file.h"
#include "assets/files/json.h"
#include "skitter/error.h"

namespace skitter {
namespace crowd {
namespace {

constexpr std::array<char, 8> kMagic = {'s', 'k', 'i', 't', 't', 'e', 'r', '\x1a'};
constexpr uint32_t kVersion = 1;
constexpr uint64_t kAlignment = 8;  // of the first chunk

struct Header {
  std::array<char, 8> magic = kMagic;
  uint32_t version = kVersion;
  uint32_t sum = 0;  // of what follows, to the end of the head
  uint64_t headBytes = 0;
};
static_assert(sizeof(Header) == 24 && std::endian::native == std::endian::little);

template <class T>
std::span<const std::byte> bytesOf(const T& value) {
  return std::as_bytes(std::span(&value, 1));
}

}  // namespace

uint32_t checksum(std::span<const std::byte> bytes, uint32_t before) {
  if (bytes.empty()) return before;  // zlib begins anew where there is no buffer
  return static_cast<uint32_t>(crc32_z(before, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

StateWriter::StateWriter(const StateHead& head, StateSink sink) : sink_(std::move(sink)) {
  std::string text = jsonOf(head).dump();
  text.resize((sizeof(Header) + text.size() + kAlignment - 1) / kAlignment * kAlignment - sizeof(Header),
              ' ');
  Header header{.headBytes = text.size()};
  header.sum = sum_ = checksum(std::as_bytes(std::span(text)), checksum(bytesOf(header.headBytes)));
  sink_(bytesOf(header));
  sink_(std::as_bytes(std::span(text)));
  write(std::as_bytes(std::span(head.terrain.heights)));
  endChunk();
}

void StateWriter::write(std::span<const std::byte> bytes) {
  sum_ = checksum(bytes, sum_);
  sink_(bytes);
}

void StateWriter::endChunk() { sink_(bytesOf(sum_)); }

namespace {

// Header and head.
void readHead(State::Source& source) {
  Header header;
  const auto fail = [&](const std::string& fault) {
    throw inputError(fmt::format("{}: {}", source.name, fault));
  };
  if (source.bytes < sizeof header) fail("is no state of a crowd");
  source.read(0, std::as_writable_bytes(std::span(&header, 1)));
  if (header.magic != kMagic) fail("is no state of a crowd");
  if (header.version != kVersion)
    fail(fmt::format("is a state of version {}, expected {}", header.version, kVersion));
  if (header.headBytes > source.bytes - sizeof header)
    fail(fmt::format("has {} bytes, its head alone should have {}: it is damaged or not whole", source.bytes,
                     header.headBytes));
  std::string text(header.headBytes, ' ');
  source.read(sizeof header, std::as_writable_bytes(std::span(text)));
  source.sum = checksum(std::as_bytes(std::span(std::as_const(text))), checksum(bytesOf(header.headBytes)));
  if (source.sum != header.sum) fail("its head is damaged: the checksum differs");
  source.head = headOf(parseJson(text, source.name), source.name);
  source.chunks = sizeof header + header.headBytes;
}

uint64_t heightsIn(const Heightfield& terrain) { return uint64_t{terrain.columns} * terrain.rows; }

// That the file ends where its head says.
void checkBytes(const State::Source& source) {
  uint64_t expected = source.chunks + bytesOfChunk(heightsIn(source.head.terrain) * sizeof(float));
  for (const StateKind& kind : source.head.kinds)
    for (const StateChunk& chunk : kind.chunks) {
      if (chunk.bytes > source.bytes)
        throw inputError(fmt::format("{}: record {} has {} bytes, the state {}", source.name, chunk.name,
                                     chunk.bytes, source.bytes));
      expected += bytesOfChunk(chunk.bytes);
    }
  if (source.bytes != expected)
    throw inputError(
        fmt::format("{}: has {} bytes, expected {}: it is not whole", source.name, source.bytes, expected));
}

}  // namespace

State openState(std::shared_ptr<State::Source> source) {
  readHead(*source);
  checkBytes(*source);
  State state = source->head;
  state.terrain.heights.resize(heightsIn(state.terrain));
  StateReader reader(*source);
  reader.read(std::as_writable_bytes(std::span(state.terrain.heights)));
  reader.endChunk("its terrain");
  source->chunks = reader.at_;
  source->sum = reader.sum_;
  state.source = std::move(source);
  return state;
}

void StateReader::read(std::span<std::byte> bytes) {
  source_.read(at_, bytes);
  at_ += bytes.size();
  sum_ = checksum(bytes, sum_);
}

void StateReader::skip(uint64_t bytes) {
  constexpr uint64_t most = 1 << 20;
  for (std::vector<std::byte> some(std::min(bytes, most)); bytes > 0; bytes -= some.size()) {
    some.resize(std::min(bytes, most));
    read(some);
  }
}

void StateReader::endChunk(const std::string& name) {
  uint32_t expected = 0;
  source_.read(at_, std::as_writable_bytes(std::span(&expected, 1)));
  at_ += sizeof expected;
  if (sum_ != expected)
    throw inputError(fmt::format("{}: {} is damaged: the checksum differs", source_.name, name));
}

}  // namespace crowd

State loadState(const std::filesystem::path& file) {
  const auto stream = std::make_shared<FileStream>(file);
  auto source = std::make_shared<State::Source>();
  source->name = file.string();
  source->bytes = stream->size();
  source->read = [stream](uint64_t at, std::span<std::byte> to) {
    stream->seek(at);
    stream->read(to.data(), to.size());
  };
  return crowd::openState(std::move(source));
}

State parseState(std::vector<std::byte> bytes, const std::string& name) {
  auto source = std::make_shared<State::Source>();
  source->name = name;
  source->bytes = bytes.size();
  source->read = [bytes = std::move(bytes)](uint64_t at, std::span<std::byte> to) {
    std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(at), to.size(), to.begin());
  };
  return crowd::openState(std::move(source));
}

bool isState(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::array<char, crowd::kMagic.size()> begin{};
  return in.read(begin.data(), begin.size()) && begin == crowd::kMagic;
}

}  // namespace skitter
