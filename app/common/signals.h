#pragma once

#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>

namespace skitter::app {

inline constexpr int interruptedCode = 130;  // as shells have it: 128 and SIGINT, whichever signal it was

// A command that a signal ended, or its time limit: exit code stopCode(), with this message.
struct Interrupted : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// "interrupted after 3 of 300 ticks"; "timed out" where the time limit ended it.
std::string interruptedAfter(uint64_t done, uint64_t wanted, const char* what);

// From here on the first Ctrl-C (or SIGTERM, or SIGHUP unless it is ignored, as under nohup) only asks for an
// end; a second one kills, the children too. timeout(1), and a shell that is hung up, send theirs to the
// process and to its group: what comes within a tenth of a second of the first is the same one. A file beyond
// the limit of `ulimit -f` is an error of that write, as on a full disk.
void catchSignals();
bool stopRequested();
// After so many seconds the command stops as after a signal, a device that hangs included.
void stopAfter(double seconds);
bool timedOut();
int stopCode();  // interruptedCode, or 1 where the command timed out
// Ends here where a second signal is about to kill the process: what it has done to the children looks like
// an error of theirs until then.
void awaitKill();

// While it lives, a stop that is not followed within a second ends the process with stopCode(): what a
// device was given cannot be taken back, and may keep it for much longer. `leave` runs before, on another
// thread: it closes what is open and returns the message. It must not use what the work beside it changes.
class StopDeadline {
 public:
  using Leave = std::function<std::string()>;

  explicit StopDeadline(Leave leave = nothingWritten);
  ~StopDeadline();
  StopDeadline(const StopDeadline&) = delete;
  StopDeadline& operator=(const StopDeadline&) = delete;

  static std::string nothingWritten();  // the message of a command that leaves nothing

 private:
  Leave leave_;
};

}  // namespace skitter::app
