#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "skitter/device.h"
#include "skitter/heightfield.h"
#include "skitter/scene.h"

namespace skitter::app {

extern const char* const version;  // "0.1.0"

// The origin of a file's figures, so that they can be made again (docs/json.md). A value that a command does
// not have, or had not yet when it was interrupted, is null.
struct Manifest {
  const Scene* scene = nullptr;
  const Heightfield* terrain = nullptr;  // with the scene
  std::optional<double> dt = {};
  std::optional<uint64_t> seed = {};  // of what is no scene
  std::string device = {}, driver = {};
  std::string sceneHashBefore = {};  // of the run that this one goes on from; empty: of scene and terrain

  // One more where there are several.
  void add(const DeviceReport& report);
  // Beside that: version, commit and build of the program, and the command as a shell reads it.
  nlohmann::ordered_json json() const;
  // "# manifest: {...}\n": the first line of a CSV file.
  std::string csvComment() const;
};

// "rolling, 513 x 513 samples, 256 x 256 m".
std::string describe(const Heightfield& terrain);

// The object and, as "manifest", its manifest, to a file at once. Throws Error(input).
void writeJson(const std::filesystem::path& file, nlohmann::ordered_json object, const Manifest& manifest);

}  // namespace skitter::app
