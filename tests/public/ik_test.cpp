#include "skitter/ik.h"

#include <algorithm>
#include <utility>

#include "public/public.h"

namespace skitter::test {
namespace {

using glm::vec3;

// Four bones of a quarter each, along +x at rest.
ik::Chain quarterChain(const ik::Limit& limit = ik::Free{}) {
  ik::Chain chain;
  for (int bone = 0; bone < 4; ++bone)
    chain.bones.push_back({.length = 0.25f, .direction = {1, 0, 0}, .limit = limit});
  return chain;
}

TEST(PublicIkChain, KnowsItsRest) {
  const ik::Chain chain = quarterChain();
  EXPECT_TRUE(chain.isFree());
  EXPECT_FALSE(quarterChain(ik::Cone{1}).isFree());
  EXPECT_EQ(chain.reach(), 1);
  ASSERT_EQ(chain.rest().size(), 5u);
  EXPECT_EQ(chain.rest().back(), vec3(1, 0, 0));
}

TEST(PublicIkChain, IsRefusedByItsBone) {
  EXPECT_NO_THROW(ik::check(quarterChain(ik::Cone{1})));
  expectRefused("a chain of 0 bones, expected 1 to 15", [] { ik::check({}); });
  ik::Chain chain = quarterChain();
  chain.bones[2].length = -1;
  expectRefused("bone 2: its length is -1", [&] { ik::check(chain); });
  chain = quarterChain();
  chain.bones[1].direction = vec3(0);
  expectRefused("bone 1: its rest direction has no length", [&] { ik::check(chain); });
  expectRefused("bone 0: a half-angle is 0", [] { ik::check(quarterChain(ik::Cone{0})); });
  expectRefused("bone 0: its hinge's axis lies along the bone", [] {
    ik::check(quarterChain(ik::Hinge{{1, 0, 0}, -1, 1}));
  });
}

TEST(PublicIkChain, HasDefaults) {
  const ik::Chain chain = quarterChain(), limited = quarterChain(ik::Hinge{{0, 0, 1}, -1, 1});
  EXPECT_EQ(ik::defaultIterations(chain, {}), 20u);
  EXPECT_EQ(ik::defaultIterations(limited, {}), 64u);
  EXPECT_EQ(ik::defaultIterations(limited, {.start = ik::Start::previous}), 4u);
  EXPECT_EQ(ik::restPullOf(limited, {.start = ik::Start::previous}), 0.02f);
  EXPECT_EQ(ik::restPullOf(limited, {}), 0);
  EXPECT_EQ(ik::restPullOf(chain, {.restPull = 0.5f}), 0.5f);
  EXPECT_EQ(ik::solverFor(chain, {}), ik::Solver::stretchAlign);
  EXPECT_EQ(ik::solverFor(limited, {}), ik::Solver::activeSet);
  EXPECT_EQ(ik::solverFor(limited, {.solver = ik::Solver::ccd}), ik::Solver::ccd);
}

using PublicIkBatch = PublicTest;

TEST_F(PublicIkBatch, ReachesItsTargets) {
  ik::Batch first(device(), quarterChain(ik::Cone{1.2f}), 3);
  ik::Batch batch = std::move(first);
  EXPECT_EQ(batch.chains(), 3u);
  EXPECT_EQ(batch.joints(), 5u);
  EXPECT_EQ(batch.solver(), ik::Solver::activeSet);
  EXPECT_EQ(batch.iterations(), 64u);
  EXPECT_GT(batch.memoryBytes(), 3u * 5 * 16);
  EXPECT_FALSE(batch.downloadSeeds().empty());
  const std::vector<vec3> targets{{0.8f, 0.2f, 0}, {0.7f, 0, 0.3f}, {0.9f, -0.1f, 0.1f}};
  batch.setTargets(targets);
  batch.solve();
  const std::vector<vec3> joints = batch.downloadJoints();
  ASSERT_EQ(joints.size(), 15u);
  const std::vector<ik::Report> reports = batch.downloadReports();
  ASSERT_EQ(reports.size(), 3u);
  for (size_t c = 0; c < 3; ++c) {
    EXPECT_EQ(reports[c].stop, ik::Stop::tolerance) << c;
    EXPECT_LE(reports[c].error, 1e-3f) << c;  // of a reach of 1, what the tolerance and rounding leave
    EXPECT_LE(glm::distance(joints[5 * c + 4], targets[c]), 1e-3f) << c;
    for (size_t bone = 0; bone < 4; ++bone)
      EXPECT_NEAR(glm::distance(joints[5 * c + bone], joints[5 * c + bone + 1]), 0.25f, 1e-4f) << c;
  }
  device().run([&](VkCommandBuffer commands) { batch.record(commands); });
  EXPECT_EQ(batch.downloadJoints(), joints);
}

TEST_F(PublicIkBatch, StandsOnBasesAndTellsRotations) {
  ik::Batch batch(device(), quarterChain(), 1, {.bases = true, .rotations = true});
  batch.setBases(std::vector<ik::Base>{{.position = {10, 0, 0}}});
  batch.setTargets(std::vector<vec3>{{10, 0.8f, 0}});
  batch.solve();
  const std::vector<vec3> joints = batch.downloadJoints();
  EXPECT_EQ(joints.front(), vec3(10, 0, 0));
  EXPECT_LE(glm::distance(joints.back(), vec3(10, 0.8f, 0)), 2e-3f);
  const std::vector<glm::quat> rotations = batch.downloadRotations();
  ASSERT_EQ(rotations.size(), 4u);
  for (size_t bone = 0; bone < 4; ++bone)
    EXPECT_LE(glm::distance(joints[bone] + rotations[bone] * vec3(0.25f, 0, 0), joints[bone + 1]), 1e-4f)
        << bone;
}

TEST_F(PublicIkBatch, GoesOnFromPosesThatItIsGiven) {
  ik::Batch batch(device(), quarterChain(ik::Cone{1.2f}), 2, {.start = ik::Start::previous});
  const std::vector<glm::vec4> rest = batch.downloadStates();
  batch.setTargets(std::vector<vec3>{{0.8f, 0.2f, 0}, {0.7f, 0, 0.3f}});
  batch.solve();
  const std::vector<glm::vec4> solved = batch.downloadStates();
  EXPECT_NE(solved, rest);
  batch.reset();
  EXPECT_EQ(batch.downloadStates(), rest);
  batch.setStates(solved);
  EXPECT_EQ(batch.downloadStates(), solved);
  const std::vector<vec3> straight = quarterChain().rest();
  std::vector<vec3> both = straight;
  both.insert(both.end(), straight.begin(), straight.end());
  batch.setJoints(both);
  EXPECT_NE(batch.downloadStates(), solved);
}

TEST_F(PublicIkBatch, WorksInTheCallersBuffers) {
  const OwnBuffer targets(device(), 16), joints(device(), 4 * 16);
  ik::Batch batch(device(), quarterChain(), 1);
  batch.use({.targets = {targets.handle(), 16}, .joints = {joints.handle(), 4 * 16}});
  targets.floats()[1] = 0.75f;
  device().run([&](VkCommandBuffer commands) {
    batch.record(commands);
    OwnBuffer::toHost(commands);
  });
  EXPECT_NEAR(joints.floats()[4 * 3 + 1], 0.75f, 1e-3f);  // y of the tip
  EXPECT_EQ(batch.downloadJoints().back().y, joints.floats()[4 * 3 + 1]);
  expectRefused("targets", [&] { batch.use({.targets = {targets.handle(), 8}}); });
}

TEST_F(PublicIkBatch, IsSplitOverPages) {
  ik::Batch batch(device(), quarterChain(), 5, {.bases = true, .rotations = true, .pageChains = 2});
  EXPECT_EQ(batch.pageChains(), 2u);
  EXPECT_EQ(batch.pages(), 3u);
  EXPECT_EQ(batch.targets(0).bytes, 2u * 16);
  EXPECT_EQ(batch.bases(0).bytes, 2u * 2 * 16);
  EXPECT_EQ(batch.joints(0).bytes, 2u * 4 * 16);
  EXPECT_EQ(batch.rotations(2).bytes, 1u * 4 * 16);
  EXPECT_EQ(batch.reports(2).bytes, 1u * 16);
  expectRefused("page 3 of a batch, expected one of its 3", [&] { batch.targets(3); });
  expectRefused("page 3 of a batch", [&] { batch.bases(3); });
  expectRefused("page 3 of a batch", [&] { batch.joints(3); });
  expectRefused("page 3 of a batch", [&] { batch.rotations(3); });
  expectRefused("page 3 of a batch", [&] { batch.reports(3); });
  expectRefused("5 chains take 3 pages", [&] { batch.use({}); });
}

TEST_F(PublicIkBatch, RefusesWhatCannotBe) {
  const ik::Chain chain = quarterChain(), limited = quarterChain(ik::Cone{1});
  expectRefused("16777217 chains", [&] { ik::Batch(device(), chain, ik::Batch::maxChains + 1); });
  expectRefused("the tolerance is 0", [&] { ik::Batch(device(), chain, 1, {.tolerance = 0}); });
  expectRefused("the rest pull is 2", [&] { ik::Batch(device(), limited, 1, {.restPull = 2}); });
  expectRefused("stretch-align takes chains without limits",
                [&] { ik::Batch(device(), limited, 1, {.solver = ik::Solver::stretchAlign}); });
  ik::Batch batch(device(), chain, 2);
  expectRefused("a batch was given 1 targets, expected 2", [&] { batch.setTargets(std::vector<vec3>(1)); });
  expectRefused("expected Options::bases", [&] { batch.setBases(std::vector<ik::Base>(2)); });
  expectRefused("expected Options::rotations", [&] { batch.downloadRotations(); });
  expectRefused("expected Start::previous", [&] { batch.setJoints(std::vector<vec3>(10)); });
  expectRefused("1 vec4 of states", [&] { batch.setStates(std::vector<glm::vec4>(1)); });
  ik::Batch based(device(), chain, 2, {.start = ik::Start::previous, .bases = true});
  expectRefused("3 bases, expected 2", [&] { based.setBases(std::vector<ik::Base>(3)); });
  expectRefused("9 joints, expected 10", [&] { based.setJoints(std::vector<vec3>(9)); });
}

// Two legs to both sides of the body.
ik::Tree twoLeggedTree() {
  ik::Tree tree;
  for (const float side : {-1.0f, 1.0f})
    tree.legs.push_back(
        {.root = {0.1f * side, 0, 0}, .bones = {2, {.length = 0.5f, .direction = {side, 0, 0}}}});
  return tree;
}

using PublicTreeBatch = PublicTest;

TEST_F(PublicTreeBatch, PutsEveryFootOnItsTarget) {
  ik::TreeBatch first(device(), twoLeggedTree(), 1);
  ik::TreeBatch batch = std::move(first);
  const std::vector<vec3> targets{{-0.7f, -0.3f, 0}, {0.7f, -0.3f, 0}};
  batch.solve(std::vector<vec3>{{0, 0, 0}}, targets);
  EXPECT_EQ(batch.downloadBodies().size(), 1u);
  const std::vector<vec3> joints = batch.downloadJoints();
  ASSERT_EQ(joints.size(), 6u);
  ASSERT_EQ(batch.downloadReports().size(), 1u);
  EXPECT_LE(batch.downloadReports()[0].error, 1e-3f);
  for (size_t leg = 0; leg < 2; ++leg)
    EXPECT_LE(glm::distance(joints[3 * leg + 2], targets[leg]), 2e-3f) << leg;
}

TEST_F(PublicTreeBatch, RefusesWhatCannotBe) {
  expectRefused("a tree of 0 legs, expected 1 to 8", [&] { ik::TreeBatch(device(), {}, 1); });
  ik::Tree tree = twoLeggedTree();
  tree.anchor = 2;
  expectRefused("the tree's anchor is 2", [&] { ik::TreeBatch(device(), tree, 1); });
  expectRefused("the tolerance is 0", [&] { ik::TreeBatch(device(), twoLeggedTree(), 1, 20, 0); });
  ik::TreeBatch batch(device(), twoLeggedTree(), 1);
  expectRefused("2 bodies, expected 1", [&] { batch.solve(std::vector<vec3>(2), std::vector<vec3>(2)); });
  expectRefused("3 targets, expected 2", [&] { batch.solve(std::vector<vec3>(1), std::vector<vec3>(3)); });
}

}  // namespace
}  // namespace skitter::test
