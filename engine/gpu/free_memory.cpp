#include "gpu/free_memory.h"

#include <algorithm>
#include <fstream>
#include <sstream>

namespace skitter::gpu {
namespace {

namespace fs = std::filesystem;

struct Hierarchy {
  const char *limit, *usage, *cache;  // two files, and a key of memory.stat
};
constexpr Hierarchy v1{"memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file"};
constexpr Hierarchy v2{"memory.max", "memory.current", "inactive_file"};

// Nothing where there is no such file or no number in it, as in memory.max without a limit.
std::optional<uint64_t> numberIn(const fs::path& file) {
  std::ifstream stream(file);
  uint64_t number = 0;
  if (!(stream >> number)) return {};
  return number;
}

// Lines are "KEY NUMBER ...".
std::optional<uint64_t> numberOf(const std::string& wanted, const fs::path& file) {
  std::ifstream stream(file);
  std::string key;
  for (uint64_t number = 0; stream >> key >> number; stream.ignore(256, '\n')) {
    if (key == wanted) return number;
  }
  return {};
}

// The process's group in the hierarchy of all controllers (v2), or in that of memory (v1); /proc/self/cgroup
// has lines "ID:CONTROLLERS:PATH".
std::optional<fs::path> groupOf(const Hierarchy& hierarchy, const fs::path& root) {
  const std::string wanted = &hierarchy == &v2 ? ",," : ",memory,";
  std::ifstream stream(root / "proc/self/cgroup");
  for (std::string line; std::getline(stream, line);) {
    const size_t first = line.find(':'), second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = "," + line.substr(first + 1, second - first - 1) + ",";
    if (controllers.find(wanted) != std::string::npos) return line.substr(second + 1);
  }
  return {};
}

// A group's usage counts the files that it has read. Like MemAvailable, this counts those not in use as free.
void narrow(std::optional<FreeMemory>& free, const Hierarchy& hierarchy, const fs::path& root,
            const fs::path& group) {
  const fs::path folder = root / group.relative_path();
  const auto limit = numberIn(folder / hierarchy.limit), usage = numberIn(folder / hierarchy.usage);
  if (!limit || !usage) return;
  const uint64_t cache = numberOf(hierarchy.cache, folder / "memory.stat").value_or(0);
  const uint64_t used = *usage - std::min(*usage, cache);
  const uint64_t left = *limit - std::min(*limit, used);
  if (!free || left < free->bytes) free = {.bytes = left, .of = "cgroup " + group.string()};
}

}  // namespace

std::optional<FreeMemory> freeMemory(const fs::path& root) {
  std::optional<FreeMemory> free;
  if (const auto kibibytes = numberOf("MemAvailable:", root / "proc/meminfo"))
    free = {.bytes = *kibibytes * 1024, .of = "machine"};

  // Lines "ID PARENT DEVICE ROOT MOUNTPOINT OPTIONS ... - TYPE SOURCE OPTIONS". A container may see only a
  // part of the hierarchy, from the group ROOT downward. Controllers other than memory have no such files.
  std::ifstream mounts(root / "proc/self/mountinfo");
  for (std::string line; std::getline(mounts, line);) {
    const size_t dash = line.find(" - ");
    if (dash == std::string::npos) continue;
    std::string ignored, mountRoot, mountPoint, type;
    std::istringstream(line) >> ignored >> ignored >> ignored >> mountRoot >> mountPoint;
    std::istringstream(line.substr(dash + 3)) >> type;
    if (type != "cgroup" && type != "cgroup2") continue;
    const Hierarchy& hierarchy = type == "cgroup2" ? v2 : v1;
    const auto group = groupOf(hierarchy, root);
    if (!group) continue;
    fs::path level = group->lexically_relative(mountRoot);
    if (level == ".") level.clear();
    for (; !level.empty(); level = level.parent_path()) narrow(free, hierarchy, root, mountPoint / level);
    narrow(free, hierarchy, root, mountPoint);
  }
  return free;
}

}  // namespace skitter::gpu
