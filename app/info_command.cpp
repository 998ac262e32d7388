#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/commands.h"
#include "app/common/files.h"
#include "app/common/manifest.h"
#include "app/common/signals.h"
#include "skitter/device.h"
#include "skitter/error.h"

namespace skitter::app {
namespace {

struct InfoOptions {
  std::optional<std::string> device;
  std::string json;
};

std::string version(uint32_t api) {
  return fmt::format("{}.{}.{}", VK_API_VERSION_MAJOR(api), VK_API_VERSION_MINOR(api),
                     VK_API_VERSION_PATCH(api));
}

const char* loadsName(LoadPath loads) {
  return loads == LoadPath::texel ? "texel buffers" : "storage buffers";
}

int bitsOf(StoreWidth width) { return width == StoreWidth::bits64 ? 64 : 32; }

std::string amount(uint64_t bytes) {
  return bytes < 10ull << 30 ? fmt::format("{:.1f} MiB", static_cast<double>(bytes) / (1 << 20))
                             : fmt::format("{:.1f} GiB", static_cast<double>(bytes) / (1ull << 30));
}

// How records are read and written, as an open device knows it.
struct Choices {
  LoadChoice loads;
  StoreChoice stores;
};

void printDevice(const DeviceReport& report, const std::optional<Choices>& choices) {
  const DeviceLimits& limits = report.limits;
  const DeviceFeatures& features = report.features;
  const auto row = [](const char* name, const std::string& value) {
    fmt::print("    {:<26}{}\n", name, value);
  };
  const auto yes = [](bool value) { return std::string(value ? "yes" : "no"); };
  fmt::print("{} {}: {} ({})\n", report.chosen ? "*" : " ", report.index, report.name, report.typeName());
  row("driver", report.driver);
  row("Vulkan", version(report.apiVersion));
  if (choices) {
    const auto& [loads, stores] = *choices;
    row("records are read by", fmt::format("{}: {}", loadsName(loads.path), loads.why));
    if (loads.cost)
      row("reading a vec4",
          fmt::format("texel {:.3g} ns, storage {:.3g} ns", loads.cost->texel, loads.cost->storage));
    row("records are written by", fmt::format("{} bits: {}", bitsOf(stores.width), stores.why));
    if (stores.cost)
      row("writing a vec4",
          fmt::format("by 32 bits {:.3g} ns, by 64 {:.3g} ns", stores.cost->bits32, stores.cost->bits64));
  }
  row("subgroup", fmt::format("{} invocations", limits.subgroupSize));
  row("work group, at most", fmt::format("{} invocations", limits.maxComputeWorkGroupInvocations));
  row("storage buffer, at most", amount(limits.maxStorageBufferRange));
  row("texel buffer, at most", fmt::format("{} vec4", limits.maxTexelBufferElements));
  row("allocation, at most", amount(limits.maxAllocationBytes));
  row("memory", fmt::format("{}, {} free ({})", amount(limits.heapBytes), amount(limits.availableBytes),
                            limits.availableOf));
  row("image, at most", fmt::format("{0} x {0}", limits.maxImageDimension2D));
  row("timestamps", limits.timestampBits > 0 ? fmt::format("{} ns", limits.timestampPeriod) : "no");
  row("indirect draws",
      fmt::format("multi {}, count {}", yes(features.multiDrawIndirect), yes(features.drawIndirectCount)));
  row("window", yes(features.presentation));
  row("lacks", report.lacks.empty() ? "nothing" : fmt::format("{}", fmt::join(report.lacks, ", ")));
  if (report.chosen) row("chosen", "yes");
  if (!report.chosen) row("not chosen", report.whyNot);
  for (const std::string& refusal : report.refusals) row("unsuitable", refusal);
}

// Nothing where the device cannot be opened.
std::optional<Choices> choicesOf(DeviceReport& report) {
  if (!report.suitable) return {};
  try {
    const Device device = Device::create({.device = fmt::format("{}", report.index)});
    return Choices{device.report().loads, device.report().stores};
  } catch (const Error& error) {
    if (error.kind() != Error::Kind::device) throw;
    report.refusals.emplace_back(error.what());
    return {};
  }
}

nlohmann::ordered_json describe(const LoadChoice& loads) {
  nlohmann::ordered_json made = {{"path", loads.path == LoadPath::texel ? "texel" : "storage"},
                                 {"why", loads.why}};
  if (loads.cost) made["nanoseconds"] = {{"texel", loads.cost->texel}, {"storage", loads.cost->storage}};
  return made;
}

nlohmann::ordered_json describe(const StoreChoice& stores) {
  nlohmann::ordered_json made = {{"bits", bitsOf(stores.width)}, {"why", stores.why}};
  if (stores.cost) made["nanoseconds"] = {{"32", stores.cost->bits32}, {"64", stores.cost->bits64}};
  return made;
}

nlohmann::ordered_json describe(const DeviceReport& report, const std::optional<Choices>& choices) {
  const DeviceLimits& limits = report.limits;
  const DeviceFeatures& features = report.features;
  return {{"index", report.index},
          {"name", report.name},
          {"type", report.typeName()},
          {"driver", report.driver},
          {"apiVersion", version(report.apiVersion)},
          {"loads", choices ? describe(choices->loads) : nlohmann::ordered_json()},
          {"stores", choices ? describe(choices->stores) : nlohmann::ordered_json()},
          {"limits",
           {{"subgroupSize", limits.subgroupSize},
            {"maxStorageBufferRange", limits.maxStorageBufferRange},
            {"maxTexelBufferElements", limits.maxTexelBufferElements},
            {"minTexelBufferOffsetAlignment", limits.minTexelBufferOffsetAlignment},
            {"minStorageBufferOffsetAlignment", limits.minStorageBufferOffsetAlignment},
            {"minUniformBufferOffsetAlignment", limits.minUniformBufferOffsetAlignment},
            {"maxAllocationBytes", limits.maxAllocationBytes},
            {"maxImageDimension2D", limits.maxImageDimension2D},
            {"maxComputeWorkGroupInvocations", limits.maxComputeWorkGroupInvocations},
            {"maxComputeWorkGroupCountX", limits.maxComputeWorkGroupCountX},
            {"maxPushConstantsSize", limits.maxPushConstantsSize},
            {"heapBytes", limits.heapBytes},
            {"availableBytes", limits.availableBytes},
            {"availableOf", limits.availableOf},
            {"timestampPeriod", limits.timestampPeriod},
            {"timestampBits", limits.timestampBits},
            {"texelRgba32f", limits.texelRgba32f},
            {"sampledR32f", limits.sampledR32f}}},
          {"features",
           {{"drawIndirectCount", features.drawIndirectCount},
            {"multiDrawIndirect", features.multiDrawIndirect},
            {"drawIndirectFirstInstance", features.drawIndirectFirstInstance},
            {"shaderDrawParameters", features.shaderDrawParameters},
            {"fillModeNonSolid", features.fillModeNonSolid},
            {"samplerAnisotropy", features.samplerAnisotropy},
            {"shaderInt64", features.shaderInt64},
            {"presentation", features.presentation}}},
          {"lacks", report.lacks},
          {"suitable", report.suitable},
          {"refusals", report.refusals},
          {"chosen", report.chosen},
          {"whyNot", report.whyNot}};
}

int info(const InfoOptions& options) {
  Files files;
  files.writes("--json", options.json);
  files.check();
  std::optional<StopDeadline> deadline(std::in_place);
  std::vector<DeviceReport> reports = listDevices({.device = options.device});

  nlohmann::ordered_json devices = nlohmann::ordered_json::array(), chosen = nullptr;
  Manifest manifest;
  for (DeviceReport& report : reports) {
    const std::optional<Choices> choices = choicesOf(report);
    printDevice(report, choices);
    devices.push_back(describe(report, choices));
    if (!report.chosen) continue;
    chosen = report.index;
    manifest.add(report);
  }
  deadline.reset();
  if (stopRequested()) throw Interrupted(StopDeadline::nothingWritten());
  if (!options.json.empty()) {
    writeJson(options.json, {{"devices", devices}, {"chosen", chosen}}, manifest);
  }
  if (chosen.is_null()) throw deviceError("none of these devices will do");
  return 0;
}

}  // namespace

void addInfo(CLI::App& app, Command& chosen) {
  auto options = std::make_shared<InfoOptions>();
  CLI::App* command =
      app.add_subcommand("info", "Vulkan devices, which one is used (*) and why not the others");
  command
      ->add_option_function<std::string>(
          "--device", [options](const std::string& text) { options->device = text; },
          "show the choice that this --device would make")
      ->type_name("NAME|INDEX");
  command->add_option("--json", options->json, "write all of it to a file")->type_name("FILE");
  command->footer("Examples:\n  skitter info\n  skitter info --json devices.json");
  command->callback([options, &chosen] { chosen = [options] { return info(*options); }; });
}

}  // namespace skitter::app
