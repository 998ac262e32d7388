#include <fmt/format.h>

#include "app/ik/machine.h"
#include "skitter/device.h"
#include "skitter/error.h"

namespace skitter::app {
namespace {

// Bytes of the records and of their copies on the way to and from the host. 1.16 KB were measured for a chain
// of 15 bones.
uint64_t bytesFor(const ik::Chain& chain, uint32_t chains) {
  return uint64_t{chains} * 16 * (5 * chain.bones.size() + 8);
}

Device makeDevice(const std::optional<std::string>& wanted, const ik::Chain& chain, uint32_t chains) {
  Device device = Device::create({.device = wanted});
  const uint64_t needed = bytesFor(chain, chains), available = device.report().limits.availableBytes;
  if (needed <= available) return device;
  throw inputError(fmt::format("--chains {}: they need about {} MiB of memory, {} has {} MiB free", chains,
                               needed >> 20, device.report().name, available >> 20));
}

class DeviceMachine : public IkMachine {
 public:
  DeviceMachine(const std::optional<std::string>& wanted, const ik::Chain& chain, uint32_t chains,
                const ik::Options& options)
      : device_(makeDevice(wanted, chain, chains)),
        batch_(device_, chain, chains, options),
        rotations_(options.rotations) {}

  std::string name() const override { return device_.report().name; }
  std::string driver() const override { return device_.report().driver; }
  // Pipelines are compiled on the way.
  void warmUp(std::span<const glm::vec3> targets) override {
    batch_.setTargets(targets);
    batch_.solve();
    batch_.reset();
  }

  IkLot solve(std::span<const glm::vec3> targets) override {
    batch_.setTargets(targets);
    IkLot lot;
    lot.spent = base::timed([&] { batch_.solve(); });
    lot.joints = batch_.downloadJoints();
    if (rotations_) lot.rotations = batch_.downloadRotations();
    lot.reports = batch_.downloadReports();
    return lot;
  }

 private:
  Device device_;
  ik::Batch batch_;
  bool rotations_;
};

}  // namespace

std::unique_ptr<IkMachine> makeDeviceMachine(const std::optional<std::string>& device, const ik::Chain& chain,
                                             uint32_t chains, const ik::Options& options) {
  return std::make_unique<DeviceMachine>(device, chain, chains, options);
}

}  // namespace skitter::app
