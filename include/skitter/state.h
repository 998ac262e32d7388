#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "skitter/crowd.h"
#include "skitter/heightfield.h"
#include "skitter/scene.h"

namespace skitter {

// A crowd as it was after a tick, in a file or in memory, with all that it needs to go on as if it had never
// stopped: Crowd::save writes one, and Crowd(device, state) makes a crowd of it. docs/state.md has the file's
// format. The checksums of a state find damage, not malice: whoever hands you one can crash your device.
struct State {
  uint64_t tick = 0;    // the last one made
  float dt = 0;         // seconds per tick; 0: no tick was made
  Scene scene;          // the crowd's herds, also those that have come; with absolute file names
  Heightfield terrain;  // as edited
  // Options of the crowd that was saved; pageAgents, timestamps, shaders and rigs are the defaults, for they
  // are the device's matter and the program's. A program may change any but `measure` and `watchEvery`, also
  // `sleep`, for the crowd that is made of the state.
  CrowdOptions options;
  std::string note;  // of the program that saved it, JSON; may be empty

  // Where the records are read from when a crowd is made: the open file, or the bytes. Shared by all copies,
  // which one thread at a time may use. Without it, making a crowd throws Error(input).
  struct Source;
  std::shared_ptr<Source> source;
};

// Each throws Error(input) that names the file and what is wrong with it: it is no state, of another version,
// not whole or damaged. What follows the terrain is checked as a crowd is made of it. The file may be
// replaced in the meantime, but not be changed in place.
SKITTER_API State loadState(const std::filesystem::path& file);
SKITTER_API State parseState(std::vector<std::byte> bytes, const std::string& name);

// Whether the file begins as states do. A file that cannot be read does not.
SKITTER_API bool isState(const std::filesystem::path& file);

}  // namespace skitter
