#include "skitter/clip.h"

#include <algorithm>

#include "public/public.h"

namespace skitter::test {
namespace {

TEST(PublicClip, TheSpiderWalksAndIdles) {
  const ClipSet set = spiderClips();
  const Clip& walk = set.clip("walk");
  EXPECT_EQ(walk.name, "walk");
  EXPECT_GT(walk.speed, 0);
  EXPECT_EQ(walk.frames(), walk.times.size());
  EXPECT_GT(walk.frames(), 1u);
  EXPECT_EQ(walk.rows.size(), 3 * walk.frames() * set.joints.size());
  EXPECT_EQ(set.clip("idle").speed, 0);
  const std::vector<const Clip*> going = set.locomotion();
  EXPECT_NE(std::ranges::find(going, &walk), going.end());
  EXPECT_NE(std::ranges::find(going, &set.clip("idle")), going.end());
}

TEST(PublicClip, RefusesANameAndListsThoseThereAre) {
  const ClipSet set = spiderClips();
  expectRefused("walk", [&] { set.clip("fly"); });
  expectRefused("idle", [&] { set.clip("fly"); });
}

TEST(PublicClip, ReadsAFileAndCutsItsClips) {
  const std::filesystem::path file = assetFile("spider.glb");
  const Rig rig = loadRig(file);
  const std::vector<ClipCut> cuts{{.clip = "walk", .name = "half", .from = 0, .to = 0.1}};
  const ClipSet set = loadClips(file, rig, cuts);
  EXPECT_EQ(set.clips.size(), spiderClips().clips.size() + 1);
  EXPECT_NEAR(set.clip("half").seconds, 0.1, 1e-8);  // times are float32
  expectRefused("spider.glb", [&] { loadClips(file, loadRig(assetFile("quadruped.glb"))); });
  expectRefused("nowhere.glb", [&] { loadClips("nowhere.glb", rig); });
}

TEST(PublicClip, ARigIsProposedWhereThereIsNone) {
  EXPECT_EQ(proposedRig(assetFile("spider.glb")).legs, spiderRig().legs);
  expectRefused("nowhere.glb", [] { proposedRig("nowhere.glb"); });
}

}  // namespace
}  // namespace skitter::test
