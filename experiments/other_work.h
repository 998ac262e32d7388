#pragma once

#include <optional>
#include <string>

namespace skitter::experiments {

// CPU time since the machine started, in seconds of all cores.
struct CpuTimes {
  double busy = 0, all = 0;
};
// The first line of Linux's /proc/stat (proc(5)); nothing if it is not that.
std::optional<CpuTimes> parseCpuTimes(const std::string& stat, double ticksASecond);

// How much of the machine others used while something was measured.
class OtherWork {
 public:
  OtherWork();
  // Share of all CPU time since then that was neither idle nor this process'; nothing where the system does
  // not tell.
  std::optional<double> share() const;

 private:
  std::optional<CpuTimes> began_;
  double own_;
};

// From this share on, times are warned of.
inline constexpr double kBusy = 0.05;

}  // namespace skitter::experiments
