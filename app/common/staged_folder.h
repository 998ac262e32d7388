#pragma once

#include <filesystem>
#include <functional>
#include <set>
#include <string>

namespace skitter::app {

// A folder whose files are replaced together. They are written into a folder of their own within it, and take
// their places only when all of them are whole; until then an earlier run's stay. A mark lists the files that
// a run wrote, so that a later one removes those and nothing else.
class StagedFolder {
 public:
  static constexpr const char* stagingName = ".skitter.part";
  static constexpr const char* markName = ".skitter-files";

  static bool isMarked(const std::filesystem::path& folder);
  // Whether there is nothing in it but what a killed run left.
  static bool isEmpty(const std::filesystem::path& folder);
  // A file of a claimed name that the mark does not list; empty where there is none.
  static std::filesystem::path foreignFile(
      const std::filesystem::path& folder,
      const std::function<bool(const std::filesystem::path& name)>& claims);

  // Makes the folder where it is missing. Throws Error(input).
  explicit StagedFolder(std::filesystem::path folder);
  // What was not committed goes, and the folder with it where it was made here and is empty.
  ~StagedFolder();
  StagedFolder(const StagedFolder&) = delete;
  StagedFolder& operator=(const StagedFolder&) = delete;

  // Where to write the file NAME, whose folders are made.
  std::filesystem::path add(const std::string& name);
  // The files take their places; returns how many of an earlier run went.
  size_t commit();

 private:
  std::filesystem::path folder_, staging_;
  std::set<std::string> names_;
  bool made_ = false;
  int lock_ = -1;
};

}  // namespace skitter::app
