#include "experiments/setup.h"

#include <fmt/format.h>

#include <cstdlib>
#include <ctime>

#include "bench/ik/machine.h"

namespace skitter::experiments {
namespace {

std::string now() {
  const std::time_t time = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&time, &utc);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%d %H:%M UTC", &utc);
  return text;
}

std::string load() {
  double one = 0;
  return getloadavg(&one, 1) == 1 ? fmt::format("{:.1f} (mean of the last minute, as measuring ended)", one)
                                  : "unknown";
}

}  // namespace

Setup describeSetup(const DeviceReport& device, const Settings& settings, const std::string& command) {
  const nlohmann::ordered_json machine = bench::describeMachine(device);
  const auto at = [&](const char* key) { return machine.at(key).get<std::string>(); };
  return {{"device",
           fmt::format("{} ({}), records loaded through {}", at("device"), at("deviceType"), at("loads"))},
          {"driver", at("driver")},
          {"CPU", at("cpu")},
          {"load", load()},
          {"build", fmt::format("{}: {}", SKITTER_BUILD_TYPE, at("engineBuild"))},
          {"date", now()},
          {"seed", fmt::format("{}", settings.seed)},
          {"tick", fmt::format("{:.6g} s", settings.dt)},
          {"creature", "the built-in spider: eight legs of four bones, leg length 1 m"},
          {"extent", settings.extent},
          {"command", command}};
}

}  // namespace skitter::experiments
