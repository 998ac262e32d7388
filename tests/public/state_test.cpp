#include "skitter/state.h"

#include "public/public.h"

namespace skitter::test {
namespace {

using PublicState = PublicTest;

TEST_F(PublicState, GoesOnFromAFileAndFromMemory) {
  const OwnFolder folder;
  Crowd crowd(device(), flatGround(), standingScene(4));
  walk(device(), crowd, 3);
  crowd.save(folder / "own.state", R"({"mine": 7})");
  EXPECT_TRUE(isState(folder / "own.state"));
  const State read = loadState(folder / "own.state");
  EXPECT_EQ(read.tick, 3u);
  EXPECT_EQ(read.dt, tickSeconds);
  EXPECT_THAT(read.note, testing::HasSubstr("7"));
  EXPECT_EQ(read.scene.herds.at(0).agents, 4u);
  EXPECT_EQ(read.terrain.heights, crowd.terrain().heights);
  Crowd again(device(), read), third(device(), parseState(crowd.saveToMemory(), "mine"));
  for (Crowd* each : {&crowd, &again, &third}) walk(device(), *each, 3);
  EXPECT_EQ(again.stateHash(), crowd.stateHash());
  EXPECT_EQ(third.stateHash(), crowd.stateHash());
}

TEST_F(PublicState, RefusesWhatIsDamaged) {
  const Crowd crowd(device(), flatGround(), standingScene(4));
  const std::vector<std::byte> whole = crowd.saveToMemory();
  expectRefused("mine", [] { parseState({}, "mine"); });
  expectRefused("mine", [] { parseState(std::vector<std::byte>(1000, std::byte{7}), "mine"); });
  const std::vector<std::byte> cut(whole.begin(), whole.end() - 1);
  expectRefused("mine", [&] { Crowd(device(), parseState(cut, "mine")); });
  std::vector<std::byte> changed = whole;
  changed[changed.size() / 2] ^= std::byte{1};
  expectRefused("mine", [&] { Crowd(device(), parseState(changed, "mine")); });
  expectRefused("a state that no file or bytes were read for", [&] { Crowd(device(), State{}); });
}

TEST_F(PublicState, RefusesFilesThatAreNone) {
  const OwnFolder folder;
  const std::filesystem::path text =
      folder.with("own.txt", "no state at all, but long enough to be read as one");
  EXPECT_FALSE(isState(text));
  EXPECT_FALSE(isState(folder / "nowhere.state"));
  expectRefused("own.txt", [&] { loadState(text); });
  expectRefused("nowhere.state", [&] { loadState(folder / "nowhere.state"); });
}

}  // namespace
}  // namespace skitter::test
