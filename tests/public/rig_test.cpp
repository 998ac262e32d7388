#include "skitter/rig.h"

#include <iterator>

#include "public/public.h"

namespace skitter::test {
namespace {

TEST(PublicRig, TheBuiltInSpiderHasEightLegsOfFourBones) {
  const Rig rig = spiderRig();
  EXPECT_EQ(rig.legCount(), 8);
  EXPECT_EQ(rig.maxBones(), 4);
  EXPECT_EQ(rig.groupCount(), static_cast<int>(rig.groups.size()));
  EXPECT_GE(rig.groupCount(), 2);
  EXPECT_EQ(rig.paletteSize(), 33);
  const std::vector<glm::vec3> starts = rig.restStarts();
  ASSERT_EQ(starts.size(), 33u);
  for (size_t leg = 0; leg < 8; ++leg) {
    EXPECT_EQ(rig.legs[leg].root(), rig.legs[leg].bones[0].start);
    for (size_t bone = 0; bone < 4; ++bone)
      EXPECT_EQ(starts[1 + 4 * leg + bone], rig.legs[leg].bones[bone].start) << leg << ", " << bone;
  }
}

TEST(PublicRig, ReadsAFileASidecarAndBytes) {
  EXPECT_EQ(loadRig(assetFile("spider.glb")).legs, spiderRig().legs);
  EXPECT_EQ(loadRig(assetFile("quadruped.rig.json")).legCount(), 4);
  EXPECT_EQ(loadRig(assetFile("quadruped.glb")).legs, loadRig(assetFile("quadruped.rig.json")).legs);
  std::ifstream file(assetFile("spider.glb"), std::ios::binary);
  const std::vector<uint8_t> bytes((std::istreambuf_iterator<char>(file)), {});
  EXPECT_EQ(parseRig(bytes, "mine").legs, spiderRig().legs);
}

TEST(PublicRig, RefusesFilesByTheirNames) {
  const OwnFolder folder;
  expectRefused("nowhere.glb", [&] { loadRig(folder / "nowhere.glb"); });
  expectRefused("own.rig.json", [&] { loadRig(folder.with("own.rig.json", "{}")); });
  expectRefused("mine", [] { parseRig(std::vector<uint8_t>(40, 7), "mine"); });
}

}  // namespace
}  // namespace skitter::test
