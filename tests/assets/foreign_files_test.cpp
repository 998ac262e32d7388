// Files with one fault each, made by others to break readers: each has its verdict in foreign_files.txt. They
// are no part of the project; broken_files_test.cpp makes its own.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <map>

#include "verdict.h"

namespace skitter {
namespace {

namespace fs = std::filesystem;
using test::Verdict;

class ForeignFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    const char* named = std::getenv("SKITTER_FOREIGN_DATA");
    folder_ = named ? fs::path(named) : fs::path(SKITTER_ROOT) / "../shared/data";
    if (fs::exists(folder_ / "bad_gltf") && fs::exists(folder_ / "bad_png")) return;
    GTEST_SKIP() << "Needs a folder, named by SKITTER_FOREIGN_DATA, with bad_gltf (the folder `test` of the "
                    "repository "
                    "KhronosGroup/glTF-Validator) and bad_png (of PngSuite, http://www.schaik.com/pngsuite, "
                    "the files x*.png "
                    "as corrupt_*.png and *16.png as 16bit_*.png).";
  }
  fs::path folder_;
};

std::map<std::string, Verdict> verdicts() {
  std::map<std::string, Verdict> list;
  std::ifstream table(fs::path(SKITTER_ROOT) / "tests/assets/foreign_files.txt");
  for (std::string line; std::getline(table, line);) {
    if (line.empty() || line[0] == '#') continue;
    const size_t first = line.find('|'), second = line.find('|', first + 1);
    list[line.substr(0, first)] = {line.substr(first + 1, second - first - 1), line.substr(second + 1)};
  }
  return list;
}

TEST_F(ForeignFiles, EachGetsItsVerdict) {
  const std::map<std::string, Verdict> list = verdicts();
  EXPECT_GT(list.size(), 100u);
  for (const auto& [path, expected] : list) test::expectVerdict(folder_ / path, expected);
}

// Later files of the same origins may be there too.
TEST_F(ForeignFiles, AnyOtherIsReadOrRefusedInOneLine) {
  const std::map<std::string, Verdict> list = verdicts();
  for (const char* origin : {"bad_gltf", "bad_png"}) {
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder_ / origin)) {
      if (!entry.is_regular_file() || list.contains(fs::relative(entry.path(), folder_).string())) continue;
      const std::string kind = entry.path().extension().string();
      const bool known = kind == ".gltf" || kind == ".glb" || kind == ".png";
      test::expectVerdict(entry.path(), {known ? test::verdictOf(entry.path()).word : "refused", ""});
    }
  }
}

}  // namespace
}  // namespace skitter
