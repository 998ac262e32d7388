#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <set>
#include <tuple>

#include "files.h"
#include "made_models.h"
#include "skitter/rig_setup.h"

// Rigs that are proposed for models that nobody prepared.
namespace skitter {
namespace {

struct Expected {
  const char* file;
  size_t joints, nodes, vertices, triangles, clips, legs, jointsOfLeg;
};
// A bone is a box: 8 vertices, 12 triangles.
constexpr Expected expectations[] = {
    {"hexapod.glb", 37, 39, 37 * 8, 37 * 12, 0, 6, 6},
    {"leg.glb", 7, 9, 7 * 8, 7 * 12, 0, 1, 7},
    {"spider.gltf", 57, 59, 49 * 8, 49 * 12, 1, 8, 5},
    {"fox.glb", 24, 26, 22 * 36, 22 * 12, 3, 4, 0},
    {"column.glb", 2, 4, 2 * 8, 2 * 12, 1, 0, 0},
    {"figure.glb", 19, 21, 19 * 8, 19 * 12, 1, 2, 4},
    {"biped.glb", 15, 17, 15 * 8, 15 * 12, 0, 2, 0},
    {"crawler.glb", 26, 28, 26 * 8, 26 * 12, 0, 8, 3},
    {"simple_skin.gltf", 2, 3, 10, 8, 1, 0, 0},
    {"step_skin.gltf", 2, 3, 10, 8, 1, 0, 0},
    {"interpolations.gltf", 0, 12, 9 * 8 + 4, 9 * 12 + 2, 9, 0, 0},
    {"plate.glb", 10, 23, 4, 2, 0, 0, 0},
    {"sparse.gltf", 0, 1, 14, 12, 0, 0, 0},
    {"strided.gltf", 0, 1, 3, 1, 0, 0, 0},
    {"matrix.gltf", 0, 1, 24, 12, 0, 0, 0},
};

class ProposeRig : public ::testing::Test {
 protected:
  ProposeRig() { test::writeMadeModels(folder_.path()); }
  std::filesystem::path file(const std::string& name) const { return folder_ / name; }
  Model load(const std::string& name) const { return loadModel(file(name)); }
  RigProposal propose(const std::string& name) const { return proposeRig(load(name)); }
  Rig rigOf(const std::string& name) const {
    const Model model = load(name);
    return buildRig(model, proposeRig(model).setup, name);
  }

 private:
  test::TemporaryFolder folder_;
};

std::string groupsOf(const Rig& rig) {
  std::string text;
  for (const Leg& leg : rig.legs) text += leg.name + rig.groups[static_cast<size_t>(leg.group)] + " ";
  return text;
}

// Left legs on +X, each pair mirrored, homes on the ground and well within reach.
void expectSound(const Rig& rig) {
  for (size_t i = 0; i < rig.legs.size(); ++i) {
    const Leg& leg = rig.legs[i];
    SCOPED_TRACE(leg.name);
    EXPECT_EQ(leg.home.x > 0, leg.name[0] == 'L');
    EXPECT_NEAR(leg.home.y, 0, 1e-5);
    const float stance = glm::length(leg.home - leg.root()) / leg.reach;
    EXPECT_GT(stance, 0.35f);
    EXPECT_LT(stance, 0.78f);
    if (i % 2 == 1) {
      EXPECT_NEAR(leg.home.z, rig.legs[i - 1].home.z, 0.1f);
    }
    if (i >= 2) {
      EXPECT_LT(leg.home.z, rig.legs[i - 2].home.z);
    }
  }
}

TEST_F(ProposeRig, CountsOfModels) {
  EXPECT_EQ(test::madeModels().size(), std::size(expectations));
  for (const Expected& expected : expectations) {
    SCOPED_TRACE(expected.file);
    const Model model = load(expected.file);
    EXPECT_EQ(model.jointCount(), expected.joints);
    EXPECT_EQ(model.nodes.size(), expected.nodes);
    EXPECT_EQ(model.vertices.size(), expected.vertices);
    EXPECT_EQ(model.indices.size() / 3, expected.triangles);
    EXPECT_EQ(model.clips.size(), expected.clips);
    const RigProposal proposal = proposeRig(model);
    ASSERT_EQ(proposal.found.size(), expected.legs);
    for (const FoundLeg& leg : proposal.found) {
      if (expected.jointsOfLeg > 0) {
        EXPECT_EQ(leg.joints.size(), expected.jointsOfLeg);
      }
    }
  }
}

TEST_F(ProposeRig, HexapodFacesMinusX) {
  const RigProposal proposal = propose("hexapod.glb");
  EXPECT_EQ(proposal.setup.forward, glm::dvec3(-1, 0, 0));
  std::set<std::string> feet;
  for (const FoundLeg& leg : proposal.found) EXPECT_TRUE(leg.footJoint);
  for (const RigSetup::Leg& leg : proposal.setup.legs) {
    EXPECT_EQ(leg.joints.size(), 5u);  // the first of six lies in the body, in one place for all legs
    feet.insert(leg.joints.back());
  }
  EXPECT_EQ(feet.size(), 6u);
  ASSERT_FALSE(proposal.setup.legs.empty());
  EXPECT_EQ(proposal.setup.legs[0].joints.front(), "leg_front_r_1");  // on its left, whatever its name says
  const Rig rig = rigOf("hexapod.glb");
  expectSound(rig);
  EXPECT_FLOAT_EQ(rig.legLength, 1);
  EXPECT_EQ(groupsOf(rig), "L1A R1B L2B R2A L3A R3B ");
}

TEST_F(ProposeRig, SpiderWithoutFootJoints) {
  const RigProposal proposal = propose("spider.gltf");
  EXPECT_EQ(proposal.setup.forward, glm::dvec3(0, 0, 1));
  for (const FoundLeg& leg : proposal.found) EXPECT_FALSE(leg.footJoint);
  for (const RigSetup::Leg& leg : proposal.setup.legs) {
    ASSERT_TRUE(leg.tipOffset.has_value());
    // The shin is 1.4 units long and falls at 80 degrees.
    EXPECT_NEAR(leg.tipOffset->y, -1.4 * std::sin(glm::radians(80.0)), 1e-3);
  }
  const Rig rig = rigOf("spider.gltf");
  expectSound(rig);
  EXPECT_EQ(groupsOf(rig), "L1A R1B L2B R2A L3A R3B L4B R4A ");
}

// The feet alone would turn the biped by 24 degrees.
TEST_F(ProposeRig, AnAxisOfTheModelWins) {
  EXPECT_EQ(propose("biped.glb").setup.forward, glm::dvec3(0, 0, 1));
}

TEST_F(ProposeRig, AModelThatStandsAslantIsTakenSo) {
  test::Glb glb = test::readGlb(file("crawler.glb"));
  auto& root = glb.json["nodes"][glb.json["scenes"][0]["nodes"][0].get<size_t>()];
  for (size_t i = 0; i < glb.json["nodes"].size(); ++i)
    glb.json["nodes"][i]["name"] = "part" + std::to_string(i);
  // Nothing tells front from back, so forward is the way that is more along +Z, or else +X.
  for (const auto& [degrees, x, z] : {std::tuple(30.0, 0.5, std::sqrt(0.75)),
                                      {-30.0, -0.5, std::sqrt(0.75)},
                                      {150.0, -0.5, std::sqrt(0.75)},
                                      {90.0, 1.0, 0.0},
                                      {-90.0, 1.0, 0.0}}) {
    const double half = glm::radians(degrees / 2);
    root["rotation"] = {0, std::sin(half), 0, std::cos(half)};
    test::writeBytes(file("aslant.glb"), glb.bytes());
    EXPECT_LT(glm::length(propose("aslant.glb").setup.forward - glm::dvec3(x, 0, z)), 1e-6) << degrees;
  }
}

// Every other tool shows it.
TEST_F(ProposeRig, VerticesWithoutWeightAreNoted) {
  const std::vector<std::string> notes = load("crawler.glb").notes;
  ASSERT_EQ(notes.size(), 2u);
  EXPECT_NE(notes[0].find("24 numbers that are not finite: they count as 0"), std::string::npos) << notes[0];
  EXPECT_NE(notes[1].find("6 vertices have no weight"), std::string::npos) << notes[1];
  expectSound(rigOf("crawler.glb"));
}

// The foremost and hindmost legs of the crawler point along its way, where a stride takes the most of a leg.
TEST_F(ProposeRig, LegsReachBothEndsOfAStride) {
  for (const char* name : {"crawler.glb", "spider.gltf", "hexapod.glb"}) {
    const Rig rig = rigOf(name);
    for (const Leg& leg : rig.legs)
      for (const float half : {-0.3f, 0.3f})
        EXPECT_LT(glm::length(leg.home + glm::vec3(0, 0, half) - leg.root()) / leg.reach, 0.9501f)
            << name << " " << leg.name;
  }
}

// Gait lifts a foot that is nearer to its root than a quarter of the reach, and a leg should fold about as
// far without a joint that turns over. The crawler's legs lie in planes and all their joints bend the same
// way, so angles add up.
TEST_F(ProposeRig, LegsFoldWithoutTurningKneesOver) {
  for (const Leg& leg : rigOf("crawler.glb").legs) {
    float least = 1;
    for (float share = 0; share <= 1; share += 0.01f) {
      glm::vec2 tip(0);
      float angle = 0;
      for (size_t b = 0; b < leg.bones.size(); ++b) {
        if (b > 0)
          angle += std::acos(glm::dot(leg.bones[b - 1].direction, leg.bones[b].direction)) +
                   share * leg.bones[b].coneHalfAngle;
        tip += leg.bones[b].length * glm::vec2(std::cos(angle), std::sin(angle));
      }
      least = std::min(least, glm::length(tip) / leg.reach);
    }
    EXPECT_LT(least, 0.35f) << leg.name;
    const float knee = std::acos(glm::dot(leg.bones[1].direction, leg.bones[2].direction));
    EXPECT_LE(leg.bones[2].coneHalfAngle, knee + 1e-4f) << leg.name;
  }
}

TEST_F(ProposeRig, StraightLegsAreBent) {
  const RigProposal proposal = propose("fox.glb");
  ASSERT_EQ(proposal.setup.legs.size(), 4u);
  ASSERT_TRUE(proposal.setup.legs[0].bend.has_value());
  EXPECT_FALSE(proposal.setup.legs[2].bend.has_value());
  EXPECT_LT(proposal.setup.legs[0].bend->z, -0.9);  // elbows go back
  expectSound(rigOf("fox.glb"));
  expectSound(rigOf("figure.glb"));
}

TEST_F(ProposeRig, CommittedQuadruped) {
  const std::filesystem::path file = SKITTER_ROOT "/assets/quadruped.glb";
  const Rig rig = loadRig(file);
  expectSound(rig);
  EXPECT_EQ(groupsOf(rig), "L1A R1B L2B R2A ");
  EXPECT_FLOAT_EQ(rig.legLength, 0.66f);
  // Its sidecar is the proposal, unedited.
  RigSetup proposed = proposeRig(loadModel(file)).setup;
  proposed.legLength = 0.66;
  const std::vector<uint8_t> bytes = test::readBytes(sidecarOf(file));
  EXPECT_EQ(writeRigSetup(proposed), std::string(bytes.begin(), bytes.end()));
}

TEST_F(ProposeRig, QuadrupedGeneratorWritesTheCommittedBytes) {
  test::TemporaryFolder folder;
  const std::string command =
      std::string("\"" SKITTER_PYTHON "\" \"" SKITTER_ROOT "/assets/quadruped/generate.py\" \"") +
      (folder / "quadruped.glb").string() + "\" > /dev/null";
  ASSERT_EQ(std::system(command.c_str()), 0);
  EXPECT_TRUE(test::readBytes(folder / "quadruped.glb") ==
              test::readBytes(SKITTER_ROOT "/assets/quadruped.glb"))
      << "assets/quadruped.glb is not what assets/quadruped/generate.py writes";
}

}  // namespace
}  // namespace skitter
