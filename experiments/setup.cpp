#include "experiments/setup.h"

#include <fmt/format.h>

#include <ctime>

#include "bench/ik/machine.h"
#include "experiments/other_work.h"

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

}  // namespace

Setup describeSetup(const DeviceReport& device, const Settings& settings, const std::string& command,
                    std::optional<double> otherWork) {
  const nlohmann::ordered_json machine = bench::describeMachine(device);
  const auto at = [&](const char* key) { return machine.at(key).get<std::string>(); };
  Setup setup;
  setup.facts = {
      {"device",
       fmt::format("{} ({}), records loaded through {}", at("device"), at("deviceType"), at("loads"))},
      {"driver", at("driver")},
      {"CPU", at("cpu")},
      {"other work",
       otherWork ? fmt::format("{:.1f} % of the machine's CPU time", 100 * *otherWork) : "unknown"},
      {"build", fmt::format("{}: {}", SKITTER_BUILD_TYPE, at("engineBuild"))},
      {"date", now()},
      {"seed", fmt::format("{}", settings.seed)},
      {"tick", fmt::format("{:.6g} s", settings.dt)},
      {"creature", "the built-in spider: eight legs of four bones, leg length 1 m"},
      {"extent", settings.extent},
      {"command", command}};
  if (otherWork.value_or(0) >= kBusy)
    setup.warning = fmt::format(
        "The machine did other work meanwhile, {:.0f} % of its CPU time: times are too long, most of all by "
        "the wall "
        "clock. Measure again on a quiet machine.",
        100 * *otherWork);
  return setup;
}

}  // namespace skitter::experiments
