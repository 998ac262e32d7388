#include "render/child.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <system_error>
#include <utility>

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

// The process groups that run, where a signal handler finds them. Of more than these, the last ones are not
// there.
std::array<std::atomic<pid_t>, 8> running{};
static_assert(std::atomic<pid_t>::is_always_lock_free);

void exchangeRunning(pid_t from, pid_t to) {
  for (std::atomic<pid_t>& place : running) {
    pid_t expected = from;
    if (place.compare_exchange_strong(expected, to)) return;
  }
}

constexpr std::chrono::milliseconds look{20};  // how often one looks whether a child goes on

void closeOnce(int& file) {
  if (file >= 0) close(file);
  file = -1;
}

}  // namespace

void killChildren() noexcept {
  for (const std::atomic<pid_t>& group : running)
    if (const pid_t child = group; child > 0) kill(-child, SIGKILL);
}

Child::Child(const std::vector<std::string>& command, std::filesystem::path output,
             std::chrono::milliseconds patience)
    : output_(std::move(output)), patience_(patience), lastProgress_(std::chrono::steady_clock::now()) {
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
  exchangeRunning(0, process_);
  fcntl(input_, F_SETFL, O_NONBLOCK);
}

Child::~Child() {
  closeOnce(input_);
  if (process_ > 0) killGroup();
  closeOnce(words_);
}

void Child::killGroup() {
  kill(-process_, SIGKILL);
  while (waitpid(process_, nullptr, 0) == -1 && errno == EINTR) {
  }
  exchangeRunning(std::exchange(process_, -1), 0);
}

bool Child::progresses() {
  const auto now = std::chrono::steady_clock::now();
  std::error_code error;
  const auto written = std::filesystem::last_write_time(output_, error);
  if (!error && written != lastWrite_) {
    lastWrite_ = written;
    lastProgress_ = now;
  }
  return now - lastProgress_ < patience_;
}

bool Child::write(std::span<const std::byte> bytes) {
  const NoSigpipe guard;
  while (!bytes.empty()) {
    const ssize_t written = ::write(input_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0 && errno != EAGAIN) return false;
    if (written > 0) {
      lastProgress_ = std::chrono::steady_clock::now();
      bytes = bytes.subspan(size_t(written));
      continue;
    }
    pollfd room{input_, POLLOUT, 0};
    poll(&room, 1, int(look.count()));
    if (!progresses()) {
      hung_ = true;
      return false;
    }
  }
  // The time until the next call is the caller's.
  lastProgress_ = std::chrono::steady_clock::now();
  return true;
}

bool Child::finish() {
  closeOnce(input_);
  lastProgress_ = std::chrono::steady_clock::now();
  int status = -1;
  for (pid_t ended = 0; ended == 0;) {
    ended = hung_ ? 0 : waitpid(process_, &status, WNOHANG);
    if (ended < 0 && errno != EINTR) return false;
    if (ended > 0) break;
    ended = 0;
    if (hung_ || !progresses()) {
      hung_ = true;
      killGroup();
      return false;
    }
    poll(nullptr, 0, int(look.count()));
  }
  exchangeRunning(std::exchange(process_, -1), 0);
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
