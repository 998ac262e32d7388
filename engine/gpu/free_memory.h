#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace skitter::gpu {

struct FreeMemory {
  uint64_t bytes = 0;
  std::string of;  // "machine", or "cgroup " and the group's folder
};

// RAM that the process can still have: the least of the machine's and of what the limits of its control
// groups (v1 and v2) leave, from its own group up to the root. Nothing where the system tells neither. `root`
// stands for /.
std::optional<FreeMemory> freeMemory(const std::filesystem::path& root = "/");

}  // namespace skitter::gpu
