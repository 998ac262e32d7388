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
#include "skitter/rig_setup.h"

namespace skitter {
namespace {

namespace fs = std::filesystem;

const fs::path kData = SKITTER_SHARED_DATA;

struct Verdict {
  std::string word;   // loads, notes or refused
  std::string fault;  // what the refusal, or one of the notes, says
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

// The verdict, and the message of a refusal or all notes.
template <typename Read>
Verdict verdictOf(const Read& read) {
  try {
    return read();
  } catch (const Error& refusal) {
    EXPECT_EQ(refusal.kind(), Error::Kind::input);
    return {"refused", refusal.what()};
  }
}

Verdict readModel(const fs::path& file) {
  return verdictOf([&]() -> Verdict {
    const Model model = loadModel(file);
    proposeRig(model);
    std::string notes;
    for (const std::string& note : model.notes) notes += (notes.empty() ? "" : "; ") + note;
    return {notes.empty() ? "loads" : "notes", notes};
  });
}

Verdict readHeights(const fs::path& file) {
  return verdictOf([&] {
    loadHeightfield(file);
    return Verdict{"loads", ""};
  });
}

TEST(BrokenFiles, EachGetsItsVerdict) {
  if (!fs::exists(kData / "bad_gltf")) GTEST_SKIP() << kData << " is absent";
  for (const auto& [path, expected] : verdicts()) {
    SCOPED_TRACE(path);
    const auto start = std::chrono::steady_clock::now();
    const fs::path file = kData / path;
    const Verdict got = file.extension() == ".png" ? readHeights(file) : readModel(file);
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5)) << "hangs";
    EXPECT_EQ(got.word, expected.word) << got.fault;
    EXPECT_NE(got.fault.find(expected.fault), std::string::npos) << got.fault;
    EXPECT_EQ(got.fault.find('\n'), std::string::npos) << got.fault;
    if (got.word != "refused") continue;
    EXPECT_NE(got.fault.find(fs::path(path).filename().string()), std::string::npos) << got.fault;
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

TEST(BrokenFiles, WhatIsNoModelIsRefused) {
  if (!fs::exists(kData / "bad_gltf")) GTEST_SKIP() << kData << " is absent";
  const std::set<std::string> kinds = {".gltf", ".glb"};
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(kData / "bad_gltf")) {
    if (!entry.is_regular_file() || kinds.contains(entry.path().extension().string())) continue;
    SCOPED_TRACE(entry.path());
    const Verdict got = readModel(entry.path());
    EXPECT_EQ(got.word, "refused");
    EXPECT_NE(got.fault.find(entry.path().filename().string()), std::string::npos) << got.fault;
  }
}

}  // namespace
}  // namespace skitter
