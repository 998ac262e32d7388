// Files with one fault each, made by others to break readers: each has its verdict in broken_files.txt.
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>

#include "skitter/error.h"
#include "skitter/heightfield.h"
#include "skitter/model.h"

namespace skitter {
namespace {

namespace fs = std::filesystem;

const fs::path kData = SKITTER_SHARED_DATA;

struct Verdict {
  std::string word;   // loads, notes or refused
  std::string fault;  // what the refusal says
};

std::map<std::string, Verdict> verdicts() {
  std::map<std::string, Verdict> list;
  std::ifstream table(fs::path(SKITTER_ROOT) / "tests/assets/broken_files.txt");
  for (std::string line; std::getline(table, line);) {
    if (line.empty() || line[0] == '#') continue;
    const size_t first = line.find('|'), second = line.find('|', first + 1);
    list[line.substr(0, first)] = {line.substr(first + 1, second - first - 1), line.substr(second + 1)};
  }
  return list;
}

// The verdict, and the message of a refusal.
Verdict read(const fs::path& file) {
  try {
    if (file.extension() == ".png") return loadHeightfield(file), Verdict{"loads", ""};
    return {loadModel(file).notes.empty() ? "loads" : "notes", ""};
  } catch (const Error& refusal) {
    EXPECT_EQ(refusal.kind(), Error::Kind::input);
    return {"refused", refusal.what()};
  }
}

TEST(BrokenFiles, EachGetsItsVerdict) {
  if (!fs::exists(kData / "bad_gltf")) GTEST_SKIP() << kData << " is absent";
  for (const auto& [path, expected] : verdicts()) {
    SCOPED_TRACE(path);
    const auto start = std::chrono::steady_clock::now();
    const Verdict got = read(kData / path);
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5)) << "hangs";
    EXPECT_EQ(got.word, expected.word) << got.fault;
    if (got.word != "refused") continue;
    EXPECT_NE(got.fault.find(expected.fault), std::string::npos) << got.fault;
    EXPECT_NE(got.fault.find(fs::path(path).filename().string()), std::string::npos) << got.fault;
    EXPECT_EQ(got.fault.find('\n'), std::string::npos) << got.fault;
  }
}

TEST(BrokenFiles, NoneIsWithoutVerdict) {
  if (!fs::exists(kData / "bad_gltf")) GTEST_SKIP() << kData << " is absent";
  const std::map<std::string, Verdict> list = verdicts();
  const std::set<std::string> kinds = {".gltf", ".glb", ".png"};
  for (const char* folder : {"bad_gltf", "bad_png"})
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(kData / folder))
      if (kinds.contains(entry.path().extension().string())) {
        EXPECT_TRUE(list.contains(fs::relative(entry.path(), kData).string())) << entry.path();
      }
}

}  // namespace
}  // namespace skitter
