#pragma once

#include "gpu/context.h"
#include "skitter/device.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace skitter::test {

// The device under test is the best one, or the one that SKITTER_TEST_DEVICE names (NAME or INDEX).
inline DeviceRequest validatedRequest(std::optional<LoadPath> loads = {}) {
  DeviceRequest request{.validation = true, .loads = loads};
  if (const char* selector = std::getenv("SKITTER_TEST_DEVICE")) request.device = selector;
  return request;
}

// Where there is none, what is for it alone and what compares both paths is skipped.
inline bool hasTexelPath() {
  static const bool has = [] {
    DeviceRequest request = validatedRequest();
    request.validation = false;
    for (const DeviceReport& device : listDevices(request))
      if (device.chosen) return device.limits.texelRgba32f && device.features.shaderInt64;
    return true;  // no device: making one tells why
  }();
  return has;
}

// Every way in which a device that has them all reads and writes records: the same bits.
inline std::vector<DeviceRequest> everyRecordPath() {
  std::vector<DeviceRequest> all(3, validatedRequest());
  all[0].loads = all[1].loads = LoadPath::texel;
  all[0].stores = StoreWidth::bits32;
  all[1].stores = StoreWidth::bits64;
  all[2].loads = LoadPath::storage;
  return all;
}

inline void failOnMessages(const ValidationLog& log) {
  for (const ValidationMessage& message : log.messages()) {
    ADD_FAILURE() << "validation, " << message.count << " times: " << message.text;
  }
}

// The devices that the tests of a process share, for a device keeps its pipelines, and to make them anew is
// half of what a crowd's test takes. With validation and synchronization validation. Messages about their end
// fail the process.
class TestDevices : public ::testing::Environment {
 public:
  Device& of(std::optional<LoadPath> loads) {
    auto device = devices_.find(loads);
    if (device == devices_.end()) {
      auto made = std::make_unique<Device>(Device::create(validatedRequest(loads)));
      device = devices_.emplace(loads, std::move(made)).first;
    }
    return *device->second;
  }

  void TearDown() override {
    for (auto& [loads, device] : devices_) {
      const std::shared_ptr<ValidationLog> log = device->validationLog();
      device.reset();
      failOnMessages(*log);
    }
    devices_.clear();
  }

 private:
  std::map<std::optional<LoadPath>, std::unique_ptr<Device>> devices_;
};
inline TestDevices& testDevices =
    *static_cast<TestDevices*>(::testing::AddGlobalTestEnvironment(new TestDevices));

// A device with validation. There must be one: without, the test fails, it is never skipped. Any validation
// message fails it too; so what is made on the device lives in the test's body, or is released before
// GpuTest::TearDown().
class GpuTest : public ::testing::Test {
 protected:
  explicit GpuTest(std::optional<LoadPath> loads = {}) : loads_(loads) {}

  void SetUp() override {
    if (loads_ == LoadPath::texel && !hasTexelPath()) GTEST_SKIP() << "the device has one load path only";
    device_ = &testDevices.of(loads_);
  }

  void TearDown() override {
    if (!device_) return;
    failOnMessages(log());
    log().clear();
  }

  Device& device() { return *device_; }
  gpu::Context& context() { return device_->context(); }
  ValidationLog& log() { return *device_->validationLog(); }

 private:
  std::optional<LoadPath> loads_;
  Device* device_ = nullptr;
};

// The same test body on both load paths: TEST_P with INSTANTIATE_TEST_SUITE_P(..., bothLoadPaths(),
// loadPathName).
class GpuLoadTest : public GpuTest, public ::testing::WithParamInterface<LoadPath> {
 protected:
  GpuLoadTest() : GpuTest(GetParam()) {}
};

inline auto bothLoadPaths() { return ::testing::Values(LoadPath::texel, LoadPath::storage); }
inline std::string loadPathName(const ::testing::TestParamInfo<LoadPath>& info) {
  return info.param == LoadPath::texel ? "texel" : "storage";
}

}  // namespace skitter::test
