#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace skitter::render {

// A child process that reads from us: no shell, a process group of its own (the terminal's Ctrl-C passes it
// by), and what it says kept for error messages.
class Child {
 public:
  // `output` is the file that it writes. While it neither reads nor writes for as long as `patience`, it
  // counts as hung and is killed. Throws std::system_error when the program cannot be started.
  Child(const std::vector<std::string>& command, std::filesystem::path output,
        std::chrono::milliseconds patience);
  // Kills it, and whatever it has started in its group, if it still runs.
  ~Child();
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  // False when it no longer reads. Raises no SIGPIPE.
  bool write(std::span<const std::byte>);
  // Closes its input and waits for it; true when it exits with 0.
  bool finish();
  // The last line of its error output.
  std::string lastWords() const;
  bool hung() const { return hung_; }

 private:
  // Whether something happened lately, as far as one can see from here.
  bool progresses();
  void killGroup();

  std::filesystem::path output_;
  std::chrono::milliseconds patience_;
  std::chrono::steady_clock::time_point lastProgress_;
  std::filesystem::file_time_type lastWrite_;
  bool hung_ = false;
  pid_t process_ = -1;
  int input_ = -1, words_ = -1;
};

// Kills every child that runs, and its group. For a signal handler that is about to end the program.
void killChildren() noexcept;

}  // namespace skitter::render
