#include "process.h"

namespace skitter::test {
namespace {

struct Determinism : AppTest {
  std::string hashOf(std::vector<std::string> more, const std::string& seed = "3") {
    std::vector<std::string> arguments = {"run", "--headless", "--agents", "40",     "--frames",
                                          "20",  "--seed",     seed,       "--json", file("run.json")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Result result = skitter(arguments);
    EXPECT_EQ(result.code, 0) << result.err;
    return result.code == 0 ? json("run.json").at("stateHash").get<std::string>() : "";
  }
};

TEST_F(Determinism, SameBitsWhateverIsDrawnOrTraced) {
  const std::string hash = hashOf({});
  EXPECT_EQ(hash.size(), 16u);
  EXPECT_EQ(hashOf({}), hash);
  EXPECT_EQ(hashOf({"--trace", file("trace")}), hash);
  EXPECT_EQ(hashOf({"--out", file("walk.mp4"), "--size", "64x48"}), hash);
  EXPECT_EQ(hashOf({"--timings"}), hash);
  EXPECT_NE(hashOf({}, "4"), hash);
}

}  // namespace
}  // namespace skitter::test
