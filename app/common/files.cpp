#include "app/common/files.h"

#include <fmt/format.h>
#include <limits.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <map>
#include <tuple>

#include "app/common/staged_folder.h"
#include "assets/files/file.h"
#include "assets/files/partial_file.h"
#include "skitter/error.h"

namespace skitter::app {

namespace fs = std::filesystem;

namespace {

// A path as far as it is there.
fs::path existingPartOf(const fs::path& path) {
  std::error_code error;
  fs::path existing = fs::absolute(path);
  while (!fs::exists(existing, error) && existing.has_relative_path()) existing = existing.parent_path();
  return existing;
}

// The one path to a file or folder, which need not exist: without links, "." and "..".
fs::path placeOf(const fs::path& path) { return fs::weakly_canonical(fs::absolute(followed(path))); }

// Equal for two names of one file: hard links and mounts have one inode under several paths.
using Identity = std::tuple<dev_t, ino_t, fs::path>;
Identity identityOf(const fs::path& path) {
  const fs::path place = placeOf(path), existing = existingPartOf(place);
  struct stat status {};
  if (stat(existing.c_str(), &status) != 0) return {0, 0, place};
  return {status.st_dev, status.st_ino, existing == place ? "" : place.lexically_relative(existing)};
}

// A name of `path` within `folder`; empty where it lies elsewhere.
fs::path nameWithin(const fs::path& folder, const fs::path& path) {
  const fs::path name = placeOf(path).lexically_relative(placeOf(folder));
  return name == "." || name.string().starts_with("..") ? fs::path() : name;
}

bool isStandardOutput(const fs::path& path) {
  struct stat out {
  }, file{};
  return fstat(STDOUT_FILENO, &out) == 0 && S_ISREG(out.st_mode) && stat(path.c_str(), &file) == 0 &&
         out.st_dev == file.st_dev && out.st_ino == file.st_ino;
}

// The first fault of a path's own, before any of what it leads to.
void checkName(const std::string& option, const fs::path& path) {
  const auto refuse = [&](int error) {
    throw inputError(fmt::format("{} {}: {}", option, path.string(), std::strerror(error)));
  };
  for (const fs::path& part : path)
    if (part.native().size() > NAME_MAX) refuse(ENAMETOOLONG);
  struct stat status {};
  if (stat(path.c_str(), &status) != 0 && errno != ENOENT && errno != ENOTDIR) refuse(errno);
}

// Makes what is missing of a folder and takes it away again.
void probeFolder(const std::string& option, const fs::path& folder) {
  const fs::path existing = existingPartOf(folder), missing = placeOf(folder).lexically_relative(existing);
  const fs::path probe =
      existing / (missing == "." || missing.empty() ? StagedFolder::stagingName : *missing.begin());
  if (mkdir(probe.c_str(), 0777) == 0)
    rmdir(probe.c_str());
  else if (errno != EEXIST)
    throw inputError(fmt::format("{} {}: {} is not writable: {}", option, folder.string(), existing.string(),
                                 std::strerror(errno)));
}

}  // namespace

void Files::reads(const std::string& option, const fs::path& file) {
  if (!file.empty()) uses_.push_back({Kind::input, option, file, {}});
}

void Files::writes(const std::string& option, const fs::path& file) {
  if (!file.empty()) uses_.push_back({Kind::file, option, file, {}});
}

void Files::replaces(const std::string& option, const fs::path& file, const fs::path& input) {
  writes(option, file);
  if (!file.empty()) uses_.back().replaced = input;
}

void Files::fills(const std::string& option, const fs::path& folder, Claims claims, bool force) {
  if (!folder.empty()) uses_.push_back({Kind::folder, option, folder, std::move(claims), force});
}

void Files::expect(const std::string& option, double bytes) {
  for (Use& use : uses_)
    if (use.option == option && use.kind != Kind::input) use.bytes = bytes;
}

void Files::checkFile(const Use& use) {
  const std::string what = fmt::format("{} {}", use.option, use.path.string());
  checkName(use.option, use.path);
  std::error_code error;
  if (use.path.filename().empty() || fs::is_directory(use.path, error))
    throw inputError(fmt::format("{}: is a directory, expected a file", what));
  // The finished file takes the name over: a device of that name would be gone.
  if (fs::exists(use.path, error) && !fs::is_regular_file(use.path, error))
    throw inputError(fmt::format("{}: is no regular file, which is all that can be written", what));
  const fs::path target = followed(use.path);
  const fs::path folder = target.parent_path().empty() ? fs::path(".") : target.parent_path();
  if (!fs::is_directory(folder, error))
    throw inputError(fmt::format("{}: there is no directory {}", what, folder.string()));
  if (access(target.c_str(), W_OK) != 0 && errno != ENOENT)
    throw inputError(fmt::format("{}: is not writable: {}", what, std::strerror(errno)));
  if (isStandardOutput(target))
    throw inputError(
        fmt::format("{}: is where standard output goes, and would replace it; give it another name", what));
  try {
    checkPart(use.path);
  } catch (const Error& fault) {
    throw inputError(fmt::format("{} {}", use.option, fault.what()));
  }
}

void Files::checkFolder(const Use& use) {
  checkName(use.option, use.path);
  const fs::path existing = existingPartOf(use.path);
  std::error_code error;
  if (!fs::is_directory(existing, error))
    throw inputError(fmt::format("{} {}: {} is a file, expected a directory", use.option, use.path.string(),
                                 existing.string()));
  probeFolder(use.option, use.path);
  if (use.force || !fs::is_directory(use.path, error) || StagedFolder::isEmpty(use.path)) return;
  if (!StagedFolder::isMarked(use.path))
    throw inputError(fmt::format(
        "{} {}: is not empty, and what is there is not known to be an earlier run's; --force writes "
        "among it, over files of the same names",
        use.option, use.path.string()));
  const fs::path foreign = StagedFolder::foreignFile(use.path, use.claims);
  if (!foreign.empty())
    throw inputError(fmt::format("{} {}: {} is none of the earlier run's files; --force may overwrite it",
                                 use.option, use.path.string(), foreign.string()));
}

void Files::checkPair(const Use& output, const Use& other) {
  const std::string one = fmt::format("{} {}", output.option, output.path.string()),
                    two = fmt::format("{} {}", other.option, other.path.string());
  if (identityOf(output.path) == identityOf(other.path)) {
    if (other.kind == Kind::input && !output.replaced.empty() &&
        identityOf(output.replaced) == identityOf(other.path))
      return;
    if (other.kind == Kind::input)
      throw inputError(fmt::format("{}: is the file that {} reads; give it another name", one, two));
    throw inputError(fmt::format("{} and {} name the same {}; give each its own", one, two,
                                 output.kind == Kind::folder ? "folder" : "file"));
  }
  if (output.kind == Kind::file && identityOf(partOf(followed(output.path))) == identityOf(other.path))
    throw inputError(
        fmt::format("{}: is the name that {} has while it is written; give it another name", two, one));
  if (output.kind != Kind::folder) return;
  const fs::path name = nameWithin(output.path, other.path);
  if (!name.empty() && output.claims(name))
    throw inputError(fmt::format("{}: is a file that {} may write; give it another name", two, one));
}

void Files::checkRoom() const {
  struct Disk {
    std::string what;
    fs::space_info space;
    double bytes = 0;
  };
  std::map<dev_t, Disk> disks;
  for (const Use& use : uses_) {
    if (use.kind == Kind::input) continue;
    const fs::path existing = existingPartOf(placeOf(use.path).parent_path());
    struct stat status {};
    std::error_code error;
    const fs::space_info space = fs::space(existing, error);
    // Some file systems tell nothing.
    if (error || space.capacity == 0 || stat(existing.c_str(), &status) != 0) continue;
    Disk& disk = disks[status.st_dev];
    disk.what += fmt::format("{}{} {}", disk.what.empty() ? "" : " and ", use.option, use.path.string());
    disk.space = space;
    disk.bytes += use.bytes;
  }
  for (const auto& [device, disk] : disks)
    if (disk.bytes > static_cast<double>(disk.space.available))
      throw inputError(fmt::format("{}: would take {:.0f} MiB, the disk has {} MiB free", disk.what,
                                   disk.bytes / (1 << 20), disk.space.available >> 20));
}

void Files::check() const {
  std::vector<Use> inputs;
  for (const fs::path& file : filesRead()) inputs.push_back({Kind::input, "this run", file, {}});
  for (const Use& use : uses_) {
    if (use.kind == Kind::input) continue;
    use.kind == Kind::file ? checkFile(use) : checkFolder(use);
    for (const Use& other : uses_)
      if (&other != &use) checkPair(use, other);
    for (const Use& input : inputs) checkPair(use, input);
  }
  checkRoom();
}

}  // namespace skitter::app
