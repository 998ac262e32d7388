#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace skitter {

// The whole file. Throws Error(input) where it is missing, a directory, empty, over 2 GiB or unreadable.
std::vector<uint8_t> readFile(const std::filesystem::path& file);

}  // namespace skitter
