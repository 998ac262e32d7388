#include "skitter/light.h"

#include <set>

#include "public/public.h"

namespace skitter::test {
namespace {

TEST(PublicLight, SkiesAreFoundByTheirNames) {
  std::set<std::string> names;
  for (const Sky each : allSkies) {
    names.insert(nameOf(each));
    EXPECT_EQ(skyNamed(nameOf(each)), each);
  }
  EXPECT_EQ(names.size(), allSkies.size());
  EXPECT_EQ(skyNamed("noon"), std::nullopt);
}

TEST(PublicLight, IsTheScenes) {
  const OwnFolder folder;
  EXPECT_EQ(builtinScene().light, Light{});
  const auto read = [&](const std::string& light) {
    return loadScene(folder.with("scene.json", R"({"herds": [{}], "light": )" + light + "}")).light;
  };
  EXPECT_EQ(read(R"("overcast")"), Light{.sky = Sky::overcast});
  EXPECT_EQ(read(R"({"sky": "night", "exposure": 2, "fog": 80})"),
            (Light{.sky = Sky::night, .exposure = 2, .fog = 80}));
  expectRefused("light", [&] { read(R"("noon")"); });
  expectRefused("light.exposure", [&] { read(R"({"exposure": 0})"); });
}

}  // namespace
}  // namespace skitter::test
