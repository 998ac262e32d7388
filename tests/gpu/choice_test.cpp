#include "support/environment.h"
#include "support/gpu_fixture.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cctype>

namespace skitter {
namespace {

using test::Environment;
using ::testing::AllOf;
using ::testing::HasSubstr;

template <class Call>
std::string deviceErrorOf(Call&& call) {
  try {
    call();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::device);
    return error.what();
  }
  ADD_FAILURE() << "nothing was thrown";
  return {};
}

TEST(DeviceChoice, ListsDevicesAndMarksOne) {
  const auto devices = listDevices();
  ASSERT_FALSE(devices.empty());
  EXPECT_EQ(std::count_if(devices.begin(), devices.end(), [](const auto& d) { return d.chosen; }), 1);
  for (const DeviceReport& device : devices) {
    EXPECT_FALSE(device.name.empty());
    EXPECT_EQ(device.suitable, device.refusals.empty());
    EXPECT_EQ(device.chosen, device.whyNot.empty()) << device.name;
    if (!device.suitable) continue;
    EXPECT_GE(device.limits.maxStorageBufferRange, 1u << 27);
    EXPECT_GE(device.limits.subgroupSize, 1u);
    EXPECT_GT(device.limits.availableBytes, 0u);
    EXPECT_TRUE(device.limits.sampledR32f);
  }
}

TEST(DeviceChoice, CreatesWhatTheListMarks) {
  const auto devices = listDevices();
  const auto marked = std::find_if(devices.begin(), devices.end(), [](const auto& d) { return d.chosen; });
  ASSERT_NE(marked, devices.end());
  const Device device = Device::create();
  EXPECT_EQ(device.report().name, marked->name);
  EXPECT_EQ(device.report().index, marked->index);
  EXPECT_TRUE(device.report().chosen);
}

TEST(DeviceChoice, TakesIndexAndPartOfNameInAnyCase) {
  const auto devices = listDevices();
  for (const DeviceReport& wanted : devices) {
    if (!wanted.suitable) continue;
    EXPECT_EQ(Device::create({.device = std::to_string(wanted.index)}).report().index, wanted.index);
    std::string name = wanted.name.substr(1);
    for (char& c : name) c = char(std::toupper(static_cast<unsigned char>(c)));
    EXPECT_EQ(Device::create({.device = name}).report().name, wanted.name);
  }
}

TEST(DeviceChoice, UnknownNameListsThosePresent) {
  const auto present = listDevices().front().name;
  const auto message = deviceErrorOf([] { Device::create({.device = "no such device"}); });
  EXPECT_THAT(message, AllOf(HasSubstr("no such device"), HasSubstr(present)));
}

TEST(DeviceChoice, UnknownIndexListsThosePresent) {
  const auto present = listDevices().front().name;
  const auto message = deviceErrorOf([] { Device::create({.device = "4711"}); });
  EXPECT_THAT(message, AllOf(HasSubstr("4711"), HasSubstr(present)));
}

TEST(DeviceChoice, OthersSayWhyNot) {
  for (const DeviceReport& device : listDevices({.device = "no such device"})) {
    EXPECT_FALSE(device.chosen);
    EXPECT_THAT(device.whyNot, HasSubstr("no such device"));
  }
}

TEST(DeviceChoice, WhatADeviceLacksIsNamed) {
  for (const DeviceReport& device : listDevices()) {
    const auto lacks = [&](const std::string& what) {
      return std::any_of(device.lacks.begin(), device.lacks.end(),
                         [&](const std::string& lack) { return lack.find(what) == 0; });
    };
    EXPECT_EQ(lacks("drawIndirectCount"), !device.features.drawIndirectCount);
    EXPECT_EQ(lacks("shaderDrawParameters"), !device.features.shaderDrawParameters);
    EXPECT_EQ(lacks("windows"), !device.features.presentation);
    EXPECT_EQ(lacks("timestamps"), device.limits.timestampBits == 0);
    EXPECT_EQ(lacks("texel buffers beyond " + std::to_string(device.limits.maxTexelBufferElements)),
              device.limits.texelRgba32f && device.limits.maxTexelBufferElements < 1u << 24);
  }
}

TEST(DeviceChoice, NoDriverSaysWhatToInstall) {
  const Environment drivers("VK_DRIVER_FILES", "/nowhere/no_icd.json");
  const Environment older("VK_ICD_FILENAMES", "/nowhere/no_icd.json");
  for (const std::string& message :
       {deviceErrorOf([] { Device::create(); }), deviceErrorOf([] { listDevices(); })}) {
    EXPECT_THAT(message, HasSubstr("mesa-vulkan-drivers"));
    EXPECT_EQ(message.find('\n'), std::string::npos);
  }
}

TEST(DeviceChoice, MissingWindowExtensionIsNamed) {
  const auto message = deviceErrorOf(
      [] { Device::create({.presentation = true, .instanceExtensions = {"VK_KHR_no_such_surface"}}); });
  EXPECT_THAT(message, HasSubstr("VK_KHR_no_such_surface"));
}

}  // namespace
}  // namespace skitter
