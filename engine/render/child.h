#pragma once

#include <sys/types.h>

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace skitter::render {

// A child process that reads from us: no shell, a process group of its own (the terminal's Ctrl-C passes it
// by), and what it says kept for error messages.
class Child {
 public:
  // Throws std::system_error when the program cannot be started.
  explicit Child(const std::vector<std::string>& command);
  // Kills it if it still runs.
  ~Child();
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  // False when it no longer reads. Raises no SIGPIPE.
  bool write(std::span<const std::byte>);
  // Closes its input and waits for it; true when it exits with 0.
  bool finish();
  // The last line of its error output.
  std::string lastWords() const;

 private:
  pid_t process_ = -1;
  int input_ = -1, words_ = -1;
};

}  // namespace skitter::render
