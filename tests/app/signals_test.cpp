#include "app/signals.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>

namespace skitter::app {
namespace {

constexpr int kFollowed = 7;

// Work that looks at nothing for longer than a deadline lasts.
[[noreturn]] void workOn() {
  for (int seconds = 0; seconds < 5; ++seconds) sleep(1);
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
  workOn();
}

[[noreturn]] void followStop() {
  catchSignals();
  {
    const StopDeadline deadline;
    raise(SIGINT);
  }
  workOn();
}

using testing::ExitedWithCode;

TEST(StopDeadline, EndsWhatDoesNotStop) {
  const char* said = "^skitter: interrupted; nothing is written\n$";
  EXPECT_EXIT(stopDuring(SIGINT), ExitedWithCode(1), said);
  EXPECT_EXIT(stopDuring(SIGTERM), ExitedWithCode(1), said);
  EXPECT_EXIT(stopBefore(), ExitedWithCode(1), said);
}

TEST(StopDeadline, LeavesAloneWhatIsOutsideOfIt) {
  EXPECT_EXIT(stopAfter(), ExitedWithCode(kFollowed), "^$");
  EXPECT_EXIT(followStop(), ExitedWithCode(kFollowed), "^$");
}

}  // namespace
}  // namespace skitter::app
