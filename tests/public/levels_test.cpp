#include "skitter/levels.h"

#include "public/public.h"

namespace skitter::test {
namespace {

TEST(PublicLevels, AreReadFromAFileOrAreTheUsualOnes) {
  const OwnFolder folder;
  EXPECT_EQ(loadLevels("default"), Levels{});
  const Levels near{.distances = {5, 5, 80}, .most = {1, 2, 3}};
  const std::string json = R"({"distances": [5, 5, 80], "most": [1, 2, 3]})";
  EXPECT_EQ(loadLevels(folder.with("near.json", json)), near);
  EXPECT_EQ(parseLevels(json, "mine"), near);
  EXPECT_EQ(parseLevels(R"({"most": [4, 5, 6]})", "mine").distances, Levels{}.distances);
}

TEST(PublicLevels, NameWhatIsWrong) {
  const OwnFolder folder;
  expectRefused("none.json", [&] { loadLevels(folder / "none.json"); });
  expectRefused("mine: distances[2] is 4", [] { parseLevels(R"({"distances": [5, 6, 4]})", "mine"); });
  expectRefused("mine", [] { parseLevels(R"({"distance": [5, 6, 7]})", "mine"); });
  expectRefused("mine", [] { parseLevels("[", "mine"); });
}

}  // namespace
}  // namespace skitter::test
