#include "process.h"

namespace skitter::test {
namespace {

using Info = AppTest;

TEST_F(Info, TableAndJsonNameTheChosenDevice) {
  const Result result = skitter({"info", "--json", file("info.json")});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  EXPECT_EQ(files(), std::vector<std::string>{"info.json"});

  const nlohmann::json info = json("info.json");
  EXPECT_NE(result.out.find("lacks "), std::string::npos);
  int chosen = 0;
  for (const nlohmann::json& device : info.at("devices")) {
    EXPECT_NE(result.out.find(device.at("name").get<std::string>()), std::string::npos);
    EXPECT_TRUE(device.at("limits").at("maxStorageBufferRange").is_number_unsigned());
    const auto of = device.at("limits").at("availableOf").get<std::string>();
    EXPECT_NE(result.out.find(" free (" + of + ")"), std::string::npos) << of;
    if (device.at("type") == "cpu") {
      EXPECT_TRUE(of == "machine" || of.starts_with("cgroup /")) << of;
    }
    for (const nlohmann::json& lack : device.at("lacks")) {
      EXPECT_NE(result.out.find(lack.get<std::string>()), std::string::npos) << lack;
    }
    if (device.at("suitable")) {
      const nlohmann::json& loads = device.at("loads");
      EXPECT_NE(result.out.find(loads.at("why").get<std::string>()), std::string::npos);
      EXPECT_EQ(result.out.find("reading a vec4") != std::string::npos, loads.contains("nanoseconds"));
      const nlohmann::json& stores = device.at("stores");
      EXPECT_NE(result.out.find(stores.at("why").get<std::string>()), std::string::npos);
      EXPECT_EQ(result.out.find("writing a vec4") != std::string::npos, stores.contains("nanoseconds"));
    }
    if (device.at("chosen")) {
      ++chosen;
      EXPECT_EQ(device.at("index"), info.at("chosen"));
      EXPECT_TRUE(device.at("suitable"));
    } else {
      EXPECT_NE(device.at("whyNot"), "");
    }
  }
  EXPECT_EQ(chosen, 1);
}

TEST_F(Info, ALoadPathCanBeAskedFor) {
  const Result result = skitter({"info", "--json", file("info.json")}, {{"SKITTER_LOADS", "storage"}});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_NE(result.out.find("storage buffers: asked for"), std::string::npos) << result.out;
  const nlohmann::json written = json("info.json");
  for (const nlohmann::json& device : written.at("devices")) {
    if (device.at("suitable")) {
      EXPECT_EQ(device.at("loads").at("path"), "storage");
    }
  }
}

TEST_F(Info, AStoreWidthCanBeAskedFor) {
  for (const int bits : {32, 64}) {
    const Result result =
        skitter({"info", "--json", file("info.json")}, {{"SKITTER_STORES", std::to_string(bits)}});
    ASSERT_EQ(result.code, 0) << result.err;
    const nlohmann::json written = json("info.json");
    for (const nlohmann::json& device : written.at("devices")) {
      // Storage buffers are written by one width alone.
      if (device.at("suitable") && device.at("loads").at("path") == "texel") {
        EXPECT_EQ(device.at("stores").at("bits"), bits);
        EXPECT_EQ(device.at("stores").at("why"), "asked for");
        EXPECT_NE(result.out.find(std::to_string(bits) + " bits: asked for"), std::string::npos)
            << result.out;
      }
    }
  }
}

TEST_F(Info, AnUnknownStoreWidthIsRefused) {
  expectRefusal(skitter({"info"}, {{"SKITTER_STORES", "16"}}), 2, {"SKITTER_STORES", "16", "32 or 64"});
}

TEST_F(Info, AnUnknownLoadPathIsRefused) {
  expectRefusal(skitter({"info"}, {{"SKITTER_LOADS", "image"}}), 2,
                {"SKITTER_LOADS", "image", "texel or storage"});
}

}  // namespace
}  // namespace skitter::test
