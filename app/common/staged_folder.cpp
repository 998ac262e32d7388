#include "app/common/staged_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "assets/files/partial_file.h"
#include "skitter/error.h"

namespace skitter::app {

namespace fs = std::filesystem;

namespace {

constexpr const char* markHead =
    "# Written by skitter run, which replaces these files when it writes here again.";

// What a mark lists, without names that lead out of the folder.
std::set<std::string> listed(const fs::path& folder) {
  std::ifstream mark(folder / StagedFolder::markName);
  std::set<std::string> names;
  for (std::string line; std::getline(mark, line);) {
    const fs::path name = fs::path(line).lexically_normal();
    if (line.empty() || line.front() == '#' || name.is_absolute() || *name.begin() == "..") continue;
    names.insert(name.string());
  }
  return names;
}

void writeMark(const fs::path& folder, const std::set<std::string>& names) {
  std::string text = fmt::format("{}\n", markHead);
  for (const std::string& name : names) text += name + "\n";
  writeText(folder / StagedFolder::markName, text);
}

// Through a link at the place, which may lead to another disk.
void moveTo(const fs::path& from, const fs::path& place) {
  const fs::path target = followed(place);
  std::error_code error;
  fs::create_directories(target.parent_path(), error);
  fs::rename(from, target, error);
  if (error == std::errc::cross_device_link) {
    PartialFile copy(target);
    if (fs::copy_file(from, copy.part(), fs::copy_options::overwrite_existing, error)) copy.keep();
  }
  if (error) throw inputError(fmt::format("{}: cannot be written: {}", place.string(), error.message()));
}

}  // namespace

bool StagedFolder::isMarked(const fs::path& folder) {
  std::error_code error;
  return fs::is_regular_file(folder / markName, error);
}

bool StagedFolder::isEmpty(const fs::path& folder) {
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (entry.path().filename() != stagingName) return false;
  return true;
}

fs::path StagedFolder::foreignFile(const fs::path& folder,
                                   const std::function<bool(const fs::path& name)>& claims) {
  const std::set<std::string> own = listed(folder);
  for (auto entry = fs::recursive_directory_iterator(folder); entry != fs::recursive_directory_iterator();
       ++entry) {
    const fs::path name = entry->path().lexically_relative(folder);
    if (!claims(name))
      entry.disable_recursion_pending();
    else if (!entry->is_directory() && !own.contains(name.string()))
      return name;
  }
  return {};
}

StagedFolder::StagedFolder(fs::path folder) : folder_(std::move(folder)), staging_(folder_ / stagingName) {
  const auto fail = [&](const std::string& fault) {
    throw inputError(fmt::format("{}: cannot be written: {}", folder_.string(), fault));
  };
  std::error_code error;
  made_ = fs::create_directories(folder_, error);
  if (!error) fs::create_directory(staging_, error);
  if (error) fail(error.message());
  lock_ = open(staging_.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
  if (lock_ < 0) fail(std::strerror(errno));
  if (flock(lock_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    close(std::exchange(lock_, -1));
    fail("another run writes there at this moment");
  }
  for (const fs::directory_entry& stale : fs::directory_iterator(staging_))
    fs::remove_all(stale.path(), error);
}

StagedFolder::~StagedFolder() {
  std::error_code ignored;
  fs::remove_all(staging_, ignored);
  close(lock_);
  if (made_ && fs::is_empty(folder_, ignored)) fs::remove(folder_, ignored);
}

fs::path StagedFolder::add(const std::string& name) {
  names_.insert(name);
  const fs::path place = staging_ / name;
  fs::create_directories(place.parent_path());
  return place;
}

size_t StagedFolder::commit() {
  const std::set<std::string> old = listed(folder_);
  // Whatever ends the program from here on, the mark lists each file that is there.
  std::set<std::string> both = old;
  both.insert(names_.begin(), names_.end());
  writeMark(folder_, both);
  for (const std::string& name : names_) moveTo(staging_ / name, folder_ / name);
  for (const std::string& name : old) {
    if (names_.contains(name)) continue;
    std::error_code ignored;
    fs::remove(folder_ / name, ignored);
    // Folders that are empty now, up to this one; others cannot be removed.
    for (fs::path above = fs::path(name).parent_path(); !above.empty(); above = above.parent_path())
      fs::remove(folder_ / above, ignored);
  }
  writeMark(folder_, names_);
  return old.size();
}

}  // namespace skitter::app
