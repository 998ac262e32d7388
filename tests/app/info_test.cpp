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
    EXPECT_TRUE(device.at("features").at("presentation").is_boolean());
    for (const nlohmann::json& lack : device.at("lacks")) {
      EXPECT_NE(result.out.find(lack.get<std::string>()), std::string::npos) << lack;
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

}  // namespace
}  // namespace skitter::test
