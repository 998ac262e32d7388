#include "skitter/rig_setup.h"

#include "public/public.h"

namespace skitter::test {
namespace {

RigSetup quadrupedSetup() { return loadRigSetup(assetFile("quadruped.rig.json")); }

TEST(PublicRigSetup, IsReadBackAsItIsWritten) {
  const RigSetup setup = quadrupedSetup();
  EXPECT_EQ(setup.legs.size(), 4u);
  const std::string text = writeRigSetup(setup);
  const RigSetup again = parseRigSetup(text, "again");
  EXPECT_EQ(writeRigSetup(again), text);
  EXPECT_EQ(again.legs.at(2).joints, setup.legs.at(2).joints);
}

TEST(PublicRigSetup, LiesBesideItsModel) {
  EXPECT_EQ(sidecarOf("beasts/crab.glb"), std::filesystem::path("beasts/crab.rig.json"));
}

TEST(PublicRigSetup, BuildsTheRigOfItsFile) {
  const Model model = loadModel(assetFile("quadruped.glb"));
  RigSetup setup = quadrupedSetup();
  EXPECT_EQ(buildRig(model, setup, "mine").legs, loadRig(assetFile("quadruped.rig.json")).legs);
  setup.legs[1].joints[0] = "nothing of that name";
  expectRefused("mine: ", [&] { buildRig(model, setup, "mine"); });
  expectRefused("nothing of that name", [&] { buildRig(model, setup, "mine"); });
}

TEST(PublicRigSetup, IsProposedForAModel) {
  const Model model = loadModel(assetFile("quadruped.glb"));
  const RigProposal proposal = proposeRig(model);
  EXPECT_EQ(proposal.found.size(), 4u);
  ASSERT_EQ(proposal.setup.legs.size(), proposal.found.size());
  for (size_t leg = 0; leg < proposal.found.size(); ++leg)
    EXPECT_EQ(proposal.setup.legs[leg].name, proposal.found[leg].name);
  EXPECT_EQ(buildRig(model, proposal.setup, "proposed").legCount(), 4);
}

TEST(PublicRigSetup, RefusesSidecarsByTheirNames) {
  const OwnFolder folder;
  expectRefused("nowhere.rig.json", [&] { loadRigSetup(folder / "nowhere.rig.json"); });
  expectRefused("mine", [] { parseRigSetup("{}", "mine"); });
  expectRefused("mine", [] { parseRigSetup("no JSON", "mine"); });
}

}  // namespace
}  // namespace skitter::test
