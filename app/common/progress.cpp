#include "app/common/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace skitter::app {
namespace {

constexpr auto redrawEvery = std::chrono::milliseconds(100);
constexpr auto lineEvery = std::chrono::seconds(10);
constexpr int barColumns = 30;

}  // namespace

Progress::Progress(std::string what, uint64_t total, bool quiet)
    : what_(std::move(what)),
      total_(total),
      quiet_(quiet || total == 0),
      terminal_(isatty(STDERR_FILENO) == 1),
      start_(Clock::now()),
      last_(start_) {}

Progress::Progress(std::string what, bool quiet) : Progress(std::move(what), 1, quiet) {}

Progress::~Progress() {
  if (drawn_) std::fputs("\r\x1b[K", stderr);
}

void Progress::update(uint64_t done) {
  if (isDue()) show(double(done) / double(total_), fmt::format("{} of {} {}", done, total_, what_));
}

void Progress::updateShare(double done) {
  if (isDue()) show(done, fmt::format("{}: {:.0f} %", what_, 100 * done));
}

bool Progress::isDue() {
  if (quiet_) return false;
  const auto now = Clock::now();
  if (now - last_ < (terminal_ ? Clock::duration(redrawEvery) : Clock::duration(lineEvery))) return false;
  last_ = now;
  return true;
}

void Progress::show(double share, const std::string& done) {
  const double seconds = std::chrono::duration<double>(last_ - start_).count();
  const double left = share > 0 ? seconds * (1 - share) / share : 0;
  const std::string figures = fmt::format("{}, {:.0f} s left", done, left);
  if (!terminal_) {
    std::fputs((figures + "\n").c_str(), stderr);
    return;
  }
  const int full = std::clamp(static_cast<int>(share * barColumns), 0, barColumns);
  const std::string bar =
      fmt::format("\r[{:=<{}}{: <{}}] {}\x1b[K", "", full, "", barColumns - full, figures);
  std::fputs(bar.c_str(), stderr);
  std::fflush(stderr);
  drawn_ = true;
}

}  // namespace skitter::app
