#include "render/child.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

extern char** environ;

namespace skitter::render {
namespace {

// A write to a pipe that nobody reads raises SIGPIPE, which ends the program. It is held back for the thread
// while it writes, and taken away if it came; one that was pending before is left alone.
class NoSigpipe {
 public:
  NoSigpipe() {
    sigemptyset(&pipe_);
    sigaddset(&pipe_, SIGPIPE);
    sigset_t pending;
    sigpending(&pending);
    before_ = sigismember(&pending, SIGPIPE) == 1;
    pthread_sigmask(SIG_BLOCK, &pipe_, &mask_);
  }
  ~NoSigpipe() {
    const int error = errno;
    const timespec now{0, 0};
    if (!before_)
      while (sigtimedwait(&pipe_, nullptr, &now) == -1 && errno == EINTR) {
      }
    pthread_sigmask(SIG_SETMASK, &mask_, nullptr);
    errno = error;
  }
  NoSigpipe(const NoSigpipe&) = delete;
  NoSigpipe& operator=(const NoSigpipe&) = delete;

 private:
  sigset_t pipe_, mask_;
  bool before_ = false;
};

void check(int result, const char* doing) {
  if (result != 0) throw std::system_error(result, std::generic_category(), doing);
}

struct SpawnOptions {
  posix_spawn_file_actions_t files;
  posix_spawnattr_t attributes;

  SpawnOptions(int input, int words) {
    check(posix_spawn_file_actions_init(&files), "starting a process");
    check(posix_spawnattr_init(&attributes), "starting a process");
    posix_spawn_file_actions_adddup2(&files, input, STDIN_FILENO);
    posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_adddup2(&files, words, STDERR_FILENO);
    sigset_t none, standard;
    sigemptyset(&none);
    sigemptyset(&standard);
    sigaddset(&standard, SIGPIPE);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setsigdefault(&attributes, &standard);
    posix_spawnattr_setpgroup(&attributes, 0);
    posix_spawnattr_setflags(&attributes,
                             POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  }
  ~SpawnOptions() {
    posix_spawn_file_actions_destroy(&files);
    posix_spawnattr_destroy(&attributes);
  }
  SpawnOptions(const SpawnOptions&) = delete;
  SpawnOptions& operator=(const SpawnOptions&) = delete;
};

void closeOnce(int& file) {
  if (file >= 0) close(file);
  file = -1;
}

}  // namespace

Child::Child(const std::vector<std::string>& command) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category(), "making a pipe");
  input_ = ends[1];
  words_ = memfd_create("child", MFD_CLOEXEC);
  std::vector<char*> arguments;
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  int failure = 0;
  {
    const SpawnOptions options(ends[0], words_);
    failure =
        posix_spawnp(&process_, arguments[0], &options.files, &options.attributes, arguments.data(), environ);
  }
  close(ends[0]);
  if (failure != 0) {
    process_ = -1;
    closeOnce(input_);
    closeOnce(words_);
    throw std::system_error(failure, std::generic_category(), command.front());
  }
}

Child::~Child() {
  closeOnce(input_);
  if (process_ > 0) {
    kill(process_, SIGKILL);
    while (waitpid(process_, nullptr, 0) == -1 && errno == EINTR) {
    }
  }
  closeOnce(words_);
}

bool Child::write(std::span<const std::byte> bytes) {
  const NoSigpipe guard;
  while (!bytes.empty()) {
    const ssize_t written = ::write(input_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    bytes = bytes.subspan(size_t(written));
  }
  return true;
}

bool Child::finish() {
  closeOnce(input_);
  int status = -1;
  while (waitpid(process_, &status, 0) == -1)
    if (errno != EINTR) return false;
  process_ = -1;
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

std::string Child::lastWords() const {
  std::string text(4096, '\0');
  const off_t size = lseek(words_, 0, SEEK_END);
  const ssize_t got = pread(words_, text.data(), text.size(), std::max<off_t>(0, size - off_t(text.size())));
  text.resize(size_t(std::max<ssize_t>(0, got)));
  while (!text.empty() && text.back() == '\n') text.pop_back();
  const size_t line = text.rfind('\n');
  return line == std::string::npos ? text : text.substr(line + 1);
}

}  // namespace skitter::render
