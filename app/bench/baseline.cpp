#include "app/bench/baseline.h"

#include <fmt/format.h>

#include <fstream>

#include "skitter/error.h"

namespace skitter::app {

using nlohmann::json;

Baseline::Baseline(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) throw inputError(fmt::format("--baseline {}: cannot be read", file.string()));
  try {
    devices_ = json::parse(in).at("devices");
    for (const json& device : devices_)
      for (const json& match : device.at("matches"))
        for (const char* clock : {"cpuMilliseconds", "wallMilliseconds"})
          if (!(match.at("results").at(0).at(clock).at("median").get<double>() > 0))
            throw inputError(fmt::format("--baseline {}: a tick of {} agents took no time", file.string(),
                                         match.at("agents").dump()));
  } catch (const json::exception& error) {
    throw inputError(fmt::format("--baseline {}: expected a file that skitter bench --json wrote, {}",
                                 file.string(), error.what()));
  }
}

std::optional<Baseline::Slowdown> Baseline::slowdown(const std::string& device, Controller controller,
                                                     bool poses, const bench::Match& match, bool cpu) const {
  const bench::Result& now = match.results.front();
  const bench::Spread& spread = cpu ? now.cpu : now.wall;
  for (const json& made : devices_)
    for (const json& earlier : made.at("matches"))
      if (made.value("device", "") == device && earlier.value("controller", "") == nameOf(controller) &&
          earlier.value("agents", uint64_t{0}) == match.agents && earlier.value("poses", poses) == poses) {
        const json& result = earlier.at("results").at(0);
        const double then = result.at(cpu ? "cpuMilliseconds" : "wallMilliseconds").at("median");
        return Slowdown{spread.median / then - 1, spread.low / then - 1};
      }
  return {};
}

}  // namespace skitter::app
