#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "crowd/state_head.h"
#include "skitter/state.h"

// The format of a state (docs/state.md): a header, a head in JSON, and chunks of bytes, each with a checksum.
namespace skitter {

struct State::Source {
  std::string name;
  uint64_t bytes = 0;
  std::function<void(uint64_t at, std::span<std::byte> to)> read;  // throws Error(input)
  crowd::StateHead head;                                           // its terrain has no heights
  uint64_t chunks = 0;  // where those that follow the terrain begin
  uint32_t sum = 0;     // the checksum up to there
};

namespace crowd {

using StateSink = std::function<void(std::span<const std::byte>)>;

class StateWriter {
 public:
  // Writes all up to the first chunk of a kind. The head says how many bytes each chunk has.
  StateWriter(const StateHead& head, StateSink sink);

  void write(std::span<const std::byte> bytes);  // the next ones of the chunk
  void endChunk();

 private:
  StateSink sink_;
  uint32_t sum_ = 0;
};

// The chunks of the kinds, from the first to the last.
class StateReader {
 public:
  explicit StateReader(State::Source& source) : source_(source), at_(source.chunks), sum_(source.sum) {}

  void read(std::span<std::byte> bytes);  // the next ones of the chunk
  void skip(uint64_t bytes);              // checks them, too
  // Throws Error(input) where the chunk, which messages call by that name, is damaged.
  void endChunk(const std::string& name);

 private:
  friend State openState(std::shared_ptr<State::Source>);
  State::Source& source_;
  uint64_t at_;
  uint32_t sum_;
};

uint32_t checksum(std::span<const std::byte> bytes, uint32_t before = 0);  // CRC-32

// What chunks take of a file, with their checksums.
constexpr uint64_t bytesOfChunk(uint64_t bytes) { return bytes + sizeof(uint32_t); }

}  // namespace crowd
}  // namespace skitter
