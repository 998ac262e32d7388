#include "skitter/rig_gaits.h"

#include "public/public.h"

namespace skitter::test {
namespace {

TEST(PublicRigGaits, ATableIsWrittenReadAndFound) {
  const Rig rig = spiderRig();
  RigGait gait;
  gait.idle = 4;
  gait.turns.resize(rig.legs.size());
  for (size_t leg = 0; leg < gait.turns.size(); ++leg) gait.turns[leg].phase = leg % 2 == 0 ? 0 : 0.5f;
  gait.turns[2] = {};
  const std::vector<RigGait> gaits = {gait};
  const std::string text = writeGaits(rig, gaits);
  EXPECT_EQ(parseGaits(text, "table", rig), gaits);
  const OwnFolder folder;
  EXPECT_EQ(loadGaits(folder.with("own.gaits.json", text), rig), gaits);
  EXPECT_EQ(gaitsOf(folder / "own.glb"), folder / "own.gaits.json");
  expectRefused("none.gaits.json", [&] { loadGaits(folder / "none.gaits.json", rig); });
  gait.turns.pop_back();
  expectRefused("has 7 turns, expected 8", [&] { writeGaits(rig, std::vector{gait}); });
}

}  // namespace
}  // namespace skitter::test
