#include "skitter/controller.h"

#include <set>

#include "public/public.h"

namespace skitter::test {
namespace {

TEST(PublicController, IsFoundByItsName) {
  std::set<std::string> names;
  for (const Controller each : allControllers) {
    names.insert(nameOf(each));
    EXPECT_EQ(controllerNamed(nameOf(each)), each);
  }
  EXPECT_EQ(names.size(), allControllers.size());
  EXPECT_EQ(controllerNamed("swimming"), std::nullopt);
}

TEST(PublicController, IsFoundByItsEarlierName) {
  EXPECT_TRUE(isEarlierName(Controller::keyPoses, "pose"));
  EXPECT_FALSE(isEarlierName(Controller::clip, "pose"));
  EXPECT_EQ(controllerNamed("pose"), Controller::keyPoses);
}

TEST(PublicStepping, IsFoundByItsName) {
  for (const Stepping each : allSteppings) EXPECT_EQ(steppingNamed(nameOf(each)), each);
  EXPECT_EQ(steppingNamed("hopping"), std::nullopt);
}

}  // namespace
}  // namespace skitter::test
