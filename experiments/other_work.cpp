#include "experiments/other_work.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <sstream>

#include "base/clock.h"

namespace skitter::experiments {
namespace {

std::optional<CpuTimes> cpuTimes() {
  std::ifstream file("/proc/stat");
  std::string line;
  if (!std::getline(file, line)) return {};
  return parseCpuTimes(line, static_cast<double>(sysconf(_SC_CLK_TCK)));
}

}  // namespace

std::optional<CpuTimes> parseCpuTimes(const std::string& stat, double ticksASecond) {
  std::istringstream words(stat);
  std::string name;
  // user, nice, system, idle, iowait, irq, softirq, steal; guests' time is in user's.
  std::array<double, 8> ticks{};
  words >> name;
  for (double& each : ticks) words >> each;
  if (!words || name != "cpu") return {};
  CpuTimes times;
  for (size_t i = 0; i < ticks.size(); ++i) {
    times.all += ticks[i] / ticksASecond;
    if (i != 3 && i != 4) times.busy += ticks[i] / ticksASecond;
  }
  return times;
}

OtherWork::OtherWork() : began_(cpuTimes()), own_(base::processSeconds()) {}

std::optional<double> OtherWork::share() const {
  const std::optional<CpuTimes> now = cpuTimes();
  if (!began_ || !now || now->all <= began_->all) return {};
  const double others = now->busy - began_->busy - (base::processSeconds() - own_);
  return std::clamp(others / (now->all - began_->all), 0.0, 1.0);
}

}  // namespace skitter::experiments
