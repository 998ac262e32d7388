#include "bench/ik/machine.h"

#include <fmt/format.h>

#include <fstream>
#include <thread>

namespace skitter::bench {
namespace {

std::string processorName() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  }
  return "unknown";
}

std::string processor() {
  return fmt::format("{}, {} threads", processorName(), std::thread::hardware_concurrency());
}

std::string engineBuild() { return SKITTER_ENGINE_FLAGS ", " SKITTER_ENGINE_COMPILER; }

}  // namespace

nlohmann::ordered_json describeMachine(const DeviceReport& device) {
  return {{"device", device.name},
          {"deviceType", device.typeName()},
          {"driver", device.driver},
          {"loads", device.loads.path == LoadPath::texel ? "texel buffers" : "storage buffers"},
          {"cpu", processor()},
          {"engineBuild", engineBuild()}};
}

std::string machineLines(const DeviceReport& device, const std::string& opponentBuild) {
  return fmt::format("device        {} ({}), {}\ncpu           {}\nengine        {}\ncpu opponent  {}\n",
                     device.name, device.typeName(), device.driver, processor(), engineBuild(),
                     opponentBuild);
}

}  // namespace skitter::bench
