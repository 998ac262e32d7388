#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace skitter::app {

// The files that a command reads and writes. A command declares all of them, with what they will take, and
// checks them before any work: that none is written twice or both read and written, under whatever names,
// that each can be written, and that the disks have room for all of them. An empty path stands for an option
// that was not given. Every fault throws Error(input) that begins with the option.
class Files {
 public:
  // Whether a name within a folder is one that the command may write there.
  using Claims = std::function<bool(const std::filesystem::path& name)>;

  void reads(const std::string& option, const std::filesystem::path& file);
  void writes(const std::string& option, const std::filesystem::path& file);
  // The same of a file that may be the one that `input` names: it has been read when it is replaced.
  void replaces(const std::string& option, const std::filesystem::path& file,
                const std::filesystem::path& input);
  // A folder that is not empty must be one that an earlier run wrote (staged_folder.h), unless `force`.
  void fills(const std::string& option, const std::filesystem::path& folder, Claims claims, bool force);
  // The outputs of an option will take this much room, as far as it is known beforehand.
  void expect(const std::string& option, double bytes);

  // Counts the files that were read up to now as inputs, too.
  void check() const;

 private:
  enum class Kind { input, file, folder };
  struct Use {
    Kind kind;
    std::string option;
    std::filesystem::path path;
    Claims claims;
    bool force = false;
    double bytes = 64 << 10;
    std::filesystem::path replaced = {};
  };

  static void checkFile(const Use& use);
  static void checkFolder(const Use& use);
  static void checkPair(const Use& output, const Use& other);
  void checkRoom() const;

  std::vector<Use> uses_;
};

}  // namespace skitter::app
