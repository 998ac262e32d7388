#pragma once

#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string>

namespace skitter::fuzz {

// The bytes as a file, for readers that take one: one per process, in memory where the system has such a
// place.
inline std::filesystem::path scratchFile(const uint8_t* data, size_t size, const std::string& extension) {
  const std::filesystem::path memory = "/dev/shm";
  const std::filesystem::path folder =
      std::filesystem::exists(memory) ? memory : std::filesystem::temp_directory_path();
  const std::filesystem::path file = folder / ("fuzz" + std::to_string(getpid()) + extension);
  if (std::FILE* out = std::fopen(file.c_str(), "wb")) {
    std::fwrite(data, 1, size, out);
    std::fclose(out);
  }
  return file;
}

}  // namespace skitter::fuzz
