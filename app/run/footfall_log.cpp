#include "app/run/footfall_log.h"

#include <fmt/format.h>

namespace skitter::app {
namespace {

constexpr double lineBytes = 60, stepsASecond = 2;  // of a leg that walks at its ease

}  // namespace

double footfallBytes(const Crowd& crowd, double dt, uint64_t ticks) {
  double legs = 0;
  for (uint32_t h = 0; h < crowd.herdCount(); ++h)
    if (const uint32_t agents = crowd.agentCount(h); agents > 0)
      legs += double{1} * agents * crowd.rig(h).legCount();
  return lineBytes * stepsASecond * legs * dt * static_cast<double>(ticks);
}

FootfallLog::FootfallLog(const std::filesystem::path& file, const Manifest& manifest) : file_(file) {
  file_.write(manifest.csvComment() + std::string("herd,agent,leg,tick,seconds,x,y,z,speed\n"));
}

void FootfallLog::append(const Crowd& crowd) {
  std::string lines;
  for (uint32_t herd = 0; herd < crowd.herdCount(); ++herd) {
    for (const Footfall& f : crowd.footfalls(herd)) {
      lines += fmt::format("{},{},{},{},{:.6g},{:.4f},{:.4f},{:.4f},{:.4g}\n", herd, f.agent, f.leg, f.tick,
                           f.seconds, f.place.x, f.place.y, f.place.z, f.speed);
      ++count_;
    }
  }
  file_.write(lines);
}

}  // namespace skitter::app
