#include "progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace skitter::app {
namespace {

constexpr auto redrawEvery = std::chrono::milliseconds(100);
constexpr auto lineEvery = std::chrono::seconds(10);
constexpr uint64_t barColumns = 30;

}  // namespace

Progress::Progress(std::string what, uint64_t total, bool quiet)
    : what_(std::move(what)),
      total_(total),
      quiet_(quiet || total == 0),
      terminal_(isatty(STDERR_FILENO) == 1),
      start_(Clock::now()),
      last_(start_) {}

Progress::~Progress() {
  if (drawn_) fmt::print(stderr, "\r\x1b[K");
}

void Progress::update(uint64_t done) {
  if (quiet_) return;
  const auto now = Clock::now();
  if (now - last_ < (terminal_ ? Clock::duration(redrawEvery) : Clock::duration(lineEvery))) return;
  last_ = now;
  const double seconds = std::chrono::duration<double>(now - start_).count();
  const double left =
      done == 0 ? 0 : seconds * static_cast<double>(total_ - done) / static_cast<double>(done);
  const std::string figures = fmt::format("{} of {} {}, {:.0f} s left", done, total_, what_, left);
  if (!terminal_) {
    fmt::print(stderr, "{}\n", figures);
    return;
  }
  const uint64_t full = std::min(barColumns, done * barColumns / total_);
  fmt::print(stderr, "\r[{:=<{}}{: <{}}] {}\x1b[K", "", full, "", barColumns - full, figures);
  std::fflush(stderr);
  drawn_ = true;
}

}  // namespace skitter::app
