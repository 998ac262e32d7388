#include <cmath>
#include <random>

#include "cpu_reference/ik/tree.h"
#include "skitter/error.h"
#include "skitter/ik.h"
#include "support/gpu_fixture.h"

// A body with its legs as one solve, held against the reference.
namespace skitter::test {
namespace {

using glm::vec3;

constexpr uint32_t kTrees = 65;
constexpr size_t kLegs = 8, kBones = 4;
// A spider's legs stand around its body, bent upward and out.
ik::Tree spider() {
  ik::Tree tree;
  for (size_t l = 0; l < kLegs; ++l) {
    const float angle = 0.4f + 0.78f * static_cast<float>(l);
    const vec3 out(std::cos(angle), 0, std::sin(angle));
    ik::Tree::Leg leg{0.15f * out, {}};
    for (size_t i = 0; i < kBones; ++i)
      leg.bones.push_back({.length = 0.2f + 0.05f * static_cast<float>(i),
                           .direction = out + vec3(0, 1.2f - 0.8f * static_cast<float>(i), 0)});
    tree.legs.push_back(leg);
  }
  return tree;
}

reference::IkTree referenceOf(const ik::Tree& tree, const vec3& body) {
  std::vector<std::vector<double>> lengths;
  std::vector<glm::dvec3> offsets;
  for (const ik::Tree::Leg& leg : tree.legs) {
    lengths.emplace_back();
    for (const ik::Bone& bone : leg.bones) lengths.back().push_back(bone.length);
    offsets.emplace_back(leg.root);
  }
  reference::IkTree result = reference::IkTree::of(lengths, offsets);
  result.anchor = body;
  result.anchorShare = tree.anchor;
  return result;
}

reference::IkTreeState restOf(const ik::Tree& tree, const vec3& body) {
  reference::IkTreeState state{glm::dvec3(body), {}};
  for (const ik::Tree::Leg& leg : tree.legs) {
    reference::Joints joints = {glm::dvec3(body) + glm::dvec3(leg.root)};
    for (const ik::Bone& bone : leg.bones)
      joints.push_back(joints.back() +
                       static_cast<double>(bone.length) * glm::normalize(glm::dvec3(bone.direction)));
    state.legs.push_back(joints);
  }
  return state;
}

struct Problem {
  std::vector<vec3> bodies, targets;
};

// The feet at rest about a body that was moved, each strayed a little: all can be reached.
Problem problemOf(const ik::Tree& tree, uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> shift(-0.25f, 0.25f), stray(-0.05f, 0.05f);
  Problem problem;
  for (uint32_t t = 0; t < kTrees; ++t) {
    const vec3 body(3.0f * shift(random), 1, 3.0f * shift(random));
    const vec3 moved = body + vec3(shift(random), shift(random), shift(random));
    problem.bodies.push_back(body);
    for (const reference::Joints& leg : restOf(tree, moved).legs)
      problem.targets.push_back(vec3(leg.back()) + vec3(stray(random), stray(random), stray(random)));
  }
  return problem;
}

class TreeTest : public GpuTest {
 protected:
  // After one iteration from rest every joint is some forty roundings from the reference's; coordinates
  // are below 4.
  void expectIterationMatches(const ik::Tree& tree, uint32_t seed) {
    const Problem problem = problemOf(tree, seed);
    ik::TreeBatch batch(device(), tree, kTrees, 1);
    batch.solve(problem.bodies, problem.targets);
    const std::vector<vec3> joints = batch.downloadJoints();
    constexpr double tolerance = 40 * 4 * 6e-8;
    for (uint32_t t = 0; t < kTrees; ++t) {
      const std::vector<glm::dvec3> targets(problem.targets.begin() + t * kLegs,
                                            problem.targets.begin() + (t + 1) * kLegs);
      const reference::IkTreeResult expected = reference::solveTree(
          referenceOf(tree, problem.bodies[t]), targets, restOf(tree, problem.bodies[t]), 9e-4, 1);
      for (size_t l = 0; l < kLegs; ++l)
        for (size_t j = 0; j <= kBones; ++j)
          ASSERT_LT(
              glm::length(glm::dvec3(joints[(t * kLegs + l) * (kBones + 1) + j]) - expected.state.legs[l][j]),
              tolerance)
              << "seed " << seed << ", tree " << t << ", leg " << l << ", joint " << j;
    }
  }
};

TEST_F(TreeTest, AnIterationIsTheReferences) {
  for (const float anchor : {0.0f, 0.5f, 1.0f}) {
    ik::Tree tree = spider();
    tree.anchor = anchor;
    expectIterationMatches(tree, 11);
  }
}

TEST_F(TreeTest, AFloatingBodyGoesWhereItsFeetAre) {
  const ik::Tree tree = spider();
  const Problem problem = problemOf(tree, 12);
  ik::TreeBatch batch(device(), tree, kTrees, 64);
  batch.solve(problem.bodies, problem.targets);
  const std::vector<ik::Report> reports = batch.downloadReports();
  const std::vector<vec3> joints = batch.downloadJoints(), bodies = batch.downloadBodies();
  for (uint32_t t = 0; t < kTrees; ++t) {
    EXPECT_EQ(reports[t].stop, ik::Stop::tolerance) << "tree " << t << ", error " << reports[t].error;
    for (size_t l = 0; l < kLegs; ++l) {
      const vec3* leg = &joints[(t * kLegs + l) * (kBones + 1)];
      EXPECT_LT(glm::length(leg[0] - bodies[t] - tree.legs[l].root), 1e-6f) << "tree " << t << ", leg " << l;
      EXPECT_LT(glm::length(leg[kBones] - problem.targets[t * kLegs + l]), 1.2e-3f)
          << "tree " << t << ", leg " << l;
      for (size_t i = 0; i < kBones; ++i)
        EXPECT_NEAR(glm::length(leg[i + 1] - leg[i]), tree.legs[l].bones[i].length, 1e-6f);
    }
  }
}

// Feet that are wanted far apart pull the body to and fro, so an iteration may end farther from the targets
// than one before it. What counts is the best.
TEST_F(TreeTest, TheBestPoseIsKept) {
  constexpr uint32_t iterations = 3;
  ik::Tree tree = spider();
  tree.anchor = 0.5f;
  Problem problem = problemOf(tree, 15);
  std::mt19937 random(16);
  std::uniform_real_distribution<float> anywhere(-1.5f, 1.5f);
  for (vec3& target : problem.targets) target += vec3(anywhere(random), anywhere(random), anywhere(random));
  ik::TreeBatch batch(device(), tree, kTrees, iterations);
  batch.solve(problem.bodies, problem.targets);
  const std::vector<ik::Report> reports = batch.downloadReports();
  const std::vector<vec3> joints = batch.downloadJoints();
  size_t worsened = 0;
  for (uint32_t t = 0; t < kTrees; ++t) {
    const std::vector<glm::dvec3> targets(problem.targets.begin() + t * kLegs,
                                          problem.targets.begin() + (t + 1) * kLegs);
    const reference::IkTree expected = referenceOf(tree, problem.bodies[t]);
    reference::IkTreeState state = restOf(tree, problem.bodies[t]);
    double least = reference::treeError(expected, targets, state), last = least;
    for (uint32_t k = 0; k < iterations; ++k) {
      reference::iterateTree(expected, targets, state);
      last = reference::treeError(expected, targets, state);
      least = std::min(least, last);
    }
    if (last > least + 1e-3) ++worsened;
    double found = 0;
    for (size_t l = 0; l < kLegs; ++l)
      found = std::max(found,
                       glm::length(targets[l] - glm::dvec3(joints[(t * kLegs + l) * (kBones + 1) + kBones])));
    EXPECT_NEAR(reports[t].error, least, 1e-5) << "tree " << t;
    EXPECT_NEAR(found / expected.longestLeg(), least, 1e-5) << "tree " << t;
  }
  EXPECT_GT(worsened, 5u);
}

TEST_F(TreeTest, AnAnchoredBodyStays) {
  ik::Tree tree = spider();
  tree.anchor = 1;
  const Problem problem = problemOf(tree, 13);
  ik::TreeBatch batch(device(), tree, kTrees);
  batch.solve(problem.bodies, problem.targets);
  EXPECT_EQ(batch.downloadBodies(), problem.bodies);
}

TEST_F(TreeTest, ATargetThatIsNoNumberKeepsTheTree) {
  const ik::Tree tree = spider();
  Problem problem = problemOf(tree, 14);
  problem.targets[5 * kLegs + 2].y = NAN;
  ik::TreeBatch batch(device(), tree, kTrees);
  batch.solve(problem.bodies, problem.targets);
  EXPECT_EQ(batch.downloadReports()[5].stop, ik::Stop::skipped);
  EXPECT_EQ(batch.downloadBodies()[5], problem.bodies[5]);
  EXPECT_NE(batch.downloadReports()[6].stop, ik::Stop::skipped);
}

TEST_F(TreeTest, RefusesWhatItCannotSolve) {
  const auto refused = [&](const ik::Tree& tree, const char* fault) {
    try {
      ik::TreeBatch batch(device(), tree, 1);
      ADD_FAILURE() << "not refused: " << fault;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(fault), std::string::npos) << error.what();
    }
  };
  refused({}, "0 legs");
  ik::Tree tree = spider();
  tree.legs[3].bones.pop_back();
  refused(tree, "leg 3 has 3 bones");
  tree = spider();
  tree.legs[1].bones[2].limit = ik::Cone{1};
  refused(tree, "leg 1 has limits");
  tree = spider();
  tree.anchor = 2;
  refused(tree, "anchor is 2");
}

}  // namespace
}  // namespace skitter::test
