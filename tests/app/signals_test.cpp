#include "app/common/signals.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <stdexcept>
#include <string>
#include <vector>

namespace skitter::app {
namespace {

constexpr int kFollowed = 7;

// Work that looks at nothing for longer than a deadline lasts.
[[noreturn]] void workOn(int seconds = 5) {
  for (int slept = 0; slept < seconds; ++slept) sleep(1);
  _exit(stopRequested() ? kFollowed : 0);
}

[[noreturn]] void stopDuring(int signal) {
  catchSignals();
  const StopDeadline deadline;
  raise(signal);
  workOn();
}

[[noreturn]] void stopBefore() {
  catchSignals();
  raise(SIGINT);
  const StopDeadline deadline;
  workOn();
}

[[noreturn]] void stopAfter() {
  catchSignals();
  { const StopDeadline deadline; }
  raise(SIGINT);
  workOn(2);
}

[[noreturn]] void followStop() {
  catchSignals();
  {
    const StopDeadline deadline;
    raise(SIGINT);
  }
  workOn(2);
}

[[noreturn]] void stopTwiceAtOnce(int signal) {
  catchSignals();
  raise(signal);
  raise(signal);
  _exit(stopRequested() ? kFollowed : 0);
}

[[noreturn]] void stopAgain(int signal) {
  catchSignals();
  raise(signal);
  sleep(1);
  raise(signal);
  _exit(kFollowed);
}

[[noreturn]] void hangUpUnderNohup() {
  std::signal(SIGHUP, SIG_IGN);
  catchSignals();
  raise(SIGHUP);
  _exit(stopRequested() ? kFollowed : 0);
}

// A file that grows beyond the limit of its size.
[[noreturn]] void writeTooMuch(const char* file) {
  catchSignals();
  rlimit limit{};
  getrlimit(RLIMIT_FSIZE, &limit);
  limit.rlim_cur = 1000;
  setrlimit(RLIMIT_FSIZE, &limit);
  const int out = open(file, O_WRONLY | O_CREAT | O_TRUNC, 0600);
  const std::vector<char> much(1001);
  const bool first = write(out, much.data(), much.size()) == 1000, second = write(out, much.data(), 1) < 0;
  _exit(first && second && errno == EFBIG ? kFollowed : 1);
}

[[noreturn]] void leaveWithMessage() {
  catchSignals();
  const StopDeadline deadline([] { return std::string("closed what was open"); });
  raise(SIGINT);
  workOn();
}

[[noreturn]] void failToLeave() {
  catchSignals();
  const StopDeadline deadline([]() -> std::string { throw std::runtime_error("the disk is full"); });
  raise(SIGINT);
  workOn();
}

// The work that holds a deadline ends and another begins after the stop, as a summary does after the last
// tick.
[[noreturn]] void leaveOnlyWhatTakesLong() {
  catchSignals();
  raise(SIGINT);
  sleep(1);
  { const StopDeadline quick; }
  _exit(kFollowed);
}

using testing::ExitedWithCode;

TEST(StopDeadline, EndsWhatDoesNotStop) {
  const char* said = "^skitter: interrupted; nothing is written\n$";
  EXPECT_EXIT(stopDuring(SIGINT), ExitedWithCode(interruptedCode), said);
  EXPECT_EXIT(stopDuring(SIGTERM), ExitedWithCode(interruptedCode), said);
  EXPECT_EXIT(stopDuring(SIGHUP), ExitedWithCode(interruptedCode), said);
  EXPECT_EXIT(stopBefore(), ExitedWithCode(interruptedCode), said);
}

TEST(StopDeadline, LeavesInItsOwnWay) {
  EXPECT_EXIT(leaveWithMessage(), ExitedWithCode(interruptedCode), "^skitter: closed what was open\n$");
  EXPECT_EXIT(failToLeave(), ExitedWithCode(2), "^skitter: the disk is full\n$");
  EXPECT_EXIT(leaveOnlyWhatTakesLong(), ExitedWithCode(kFollowed), "^$");
}

TEST(Signals, AFileTooLargeIsAnErrorOfTheWrite) {
  const std::string file = testing::TempDir() + "skitter-too-large";
  EXPECT_EXIT(writeTooMuch(file.c_str()), ExitedWithCode(kFollowed), "^$");
  unlink(file.c_str());
}

TEST(Signals, TwoAtOnceAreOne) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP})
    EXPECT_EXIT(stopTwiceAtOnce(signal), ExitedWithCode(kFollowed), "^$");
}

TEST(Signals, ASecondOneKills) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP})
    EXPECT_EXIT(stopAgain(signal), testing::KilledBySignal(signal), "^$");
}

TEST(Signals, AnIgnoredHangUpStaysIgnored) { EXPECT_EXIT(hangUpUnderNohup(), ExitedWithCode(0), "^$"); }

TEST(StopDeadline, LeavesAloneWhatIsOutsideOfIt) {
  EXPECT_EXIT(stopAfter(), ExitedWithCode(kFollowed), "^$");
  EXPECT_EXIT(followStop(), ExitedWithCode(kFollowed), "^$");
}

}  // namespace
}  // namespace skitter::app
