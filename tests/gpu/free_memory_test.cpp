#include "gpu/free_memory.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

// Folders that stand for / on a bare machine and in containers of either kind.
namespace skitter::gpu {
namespace {

constexpr uint64_t gib = uint64_t{1} << 30;

class FreeMemoryOf : public ::testing::Test {
 protected:
  FreeMemoryOf() {
    std::string pattern = (std::filesystem::temp_directory_path() / "skitter_root_XXXXXX").string();
    if (!mkdtemp(pattern.data())) throw std::runtime_error("no temporary folder");
    root_ = pattern;
    write("proc/meminfo",
          "MemTotal:       24000000 kB\nMemFree:         1 kB\nMemAvailable:   20971520 kB\n");
  }
  ~FreeMemoryOf() override { std::filesystem::remove_all(root_); }

  void write(const std::string& file, const std::string& text) const {
    std::filesystem::create_directories((root_ / file).parent_path());
    std::ofstream(root_ / file) << text;
  }
  void mountV2(const std::string& groupRoot = "/") const {
    write("proc/self/mountinfo", "22 1 0:20 / /proc rw,nosuid - proc proc rw\n31 22 0:29 " + groupRoot +
                                     " /sys/fs/cgroup rw,nosuid shared:9 - cgroup2 cgroup2 rw,nsdelegate\n");
  }
  void groupV2(const std::string& group, const std::string& limit, uint64_t used, uint64_t cache = 0) const {
    const std::string folder = "sys/fs/cgroup" + group + "/";
    write(folder + "memory.max", limit + "\n");
    write(folder + "memory.current", std::to_string(used) + "\n");
    write(folder + "memory.stat", "anon 1\nfile 2\ninactive_file " + std::to_string(cache) + "\n");
  }
  void expect(uint64_t bytes, const std::string& of) const {
    const auto free = freeMemory(root_);
    ASSERT_TRUE(free.has_value());
    EXPECT_EQ(free->bytes, bytes);
    EXPECT_EQ(free->of, of);
  }

  std::filesystem::path root_;
};

TEST_F(FreeMemoryOf, TheMachineWithoutGroups) { expect(20 * gib, "machine"); }

TEST_F(FreeMemoryOf, NobodyWhereNothingIsTold) {
  std::filesystem::remove(root_ / "proc/meminfo");
  EXPECT_FALSE(freeMemory(root_).has_value());
}

TEST_F(FreeMemoryOf, TheMachineWhereGroupsHaveNoLimit) {
  mountV2();
  write("proc/self/cgroup", "0::/user.slice/a.scope\n");
  groupV2("/user.slice", "max", 3 * gib);
  groupV2("/user.slice/a.scope", "max", gib);
  expect(20 * gib, "machine");
}

TEST_F(FreeMemoryOf, AContainersOwnGroup) {
  mountV2();
  write("proc/self/cgroup", "0::/\n");
  groupV2("", std::to_string(gib), gib / 4);
  expect(gib - gib / 4, "cgroup /sys/fs/cgroup");
}

TEST_F(FreeMemoryOf, TheTightestOfNestedGroups) {
  mountV2();
  write("proc/self/cgroup", "0::/outer/middle/inner\n");
  groupV2("/outer", std::to_string(9 * gib), 2 * gib);
  groupV2("/outer/middle", std::to_string(4 * gib), gib);
  groupV2("/outer/middle/inner", std::to_string(8 * gib), gib);
  expect(3 * gib, "cgroup /sys/fs/cgroup/outer/middle");
  groupV2("/outer", std::to_string(3 * gib), 2 * gib);
  expect(gib, "cgroup /sys/fs/cgroup/outer");
}

TEST_F(FreeMemoryOf, FilesThatWereReadCountAsFree) {
  mountV2();
  write("proc/self/cgroup", "0::/a\n");
  groupV2("/a", std::to_string(4 * gib), 3 * gib, 2 * gib);
  expect(3 * gib, "cgroup /sys/fs/cgroup/a");
}

TEST_F(FreeMemoryOf, NothingIsFreeInAGroupOverItsLimit) {
  mountV2();
  write("proc/self/cgroup", "0::/a\n");
  groupV2("/a", std::to_string(gib), 2 * gib);
  expect(0, "cgroup /sys/fs/cgroup/a");
}

// The host's path in /proc/self/cgroup, and the group itself mounted, as containers without a namespace of
// groups have it.
TEST_F(FreeMemoryOf, AGroupThatIsMountedWithoutItsParents) {
  mountV2("/docker/4f");
  write("proc/self/cgroup", "0::/docker/4f/worker\n");
  groupV2("", std::to_string(2 * gib), 0);
  groupV2("/worker", std::to_string(gib), 0);
  expect(gib, "cgroup /sys/fs/cgroup/worker");
  // A process that was moved out of what is mounted.
  write("proc/self/cgroup", "0::/../elsewhere\n");
  expect(2 * gib, "cgroup /sys/fs/cgroup");
}

TEST_F(FreeMemoryOf, AGroupOfTheFirstVersion) {
  write("proc/self/mountinfo",
        "31 22 0:29 / /sys/fs/cgroup rw - tmpfs tmpfs rw,mode=755\n"
        "32 31 0:30 / /sys/fs/cgroup/cpu rw - cgroup cgroup rw,cpu\n"
        "35 31 0:32 /docker/4f /sys/fs/cgroup/memory rw - cgroup cgroup rw,memory\n"
        "41 31 0:38 / /sys/fs/cgroup/unified rw - cgroup2 cgroup2 rw\n");
  write("proc/self/cgroup", "5:cpu,cpuacct:/elsewhere\n4:memory:/docker/4f\n0::/\n");
  const std::string folder = "sys/fs/cgroup/memory/";
  write(folder + "memory.limit_in_bytes", "9223372036854771712\n");
  write(folder + "memory.usage_in_bytes", std::to_string(gib) + "\n");
  expect(20 * gib, "machine");
  write(folder + "memory.limit_in_bytes", std::to_string(4 * gib) + "\n");
  expect(3 * gib, "cgroup /sys/fs/cgroup/memory");
  write(folder + "memory.stat",
        "cache 1\ninactive_file 7\ntotal_inactive_file " + std::to_string(gib / 2) + "\n");
  expect(3 * gib + gib / 2, "cgroup /sys/fs/cgroup/memory");
}

}  // namespace
}  // namespace skitter::gpu
