#include <gtest/gtest.h>

#include <cstdlib>
#include <set>

#include "files.h"
#include "skitter/rig_setup.h"

// What is proposed for models that nobody prepared. The counts are those of MANIFEST.md beside the files.
namespace skitter {
namespace {

struct Foreign {
  const char* file;
  size_t joints, nodes, vertices, triangles, clips, legs, jointsOfLeg;
};
constexpr Foreign foreign[] = {
    {"mjolnir_hexapod.glb", 37, 39, 6532, 3168, 0, 6, 6},
    {"mjolnir_single_leg.glb", 7, 9, 96, 48, 0, 1, 7},
    {"luanti_spider_animated.gltf", 57, 59, 1000, 500, 1, 8, 5},
    {"Fox.glb", 24, 26, 1728, 576, 3, 4, 0},
    {"RiggedSimple.glb", 2, 5, 96, 188, 1, 0, 0},
    {"RiggedFigure.glb", 19, 22, 370, 256, 1, 2, 4},
    {"SimpleSkin.gltf", 2, 3, 10, 8, 1, 0, 0},
    {"InterpolationTest/interpolation_test.gltf", 0, 12, 220, 110, 9, 0, 0},
    {"assimp_quad_skin.glb", 10, 23, 4, 2, 0, 0, 0},
    {"luanti_simple_skin_step.gltf", 2, 3, 10, 8, 1, 0, 0},
    {"luanti_simple_sparse_accessor.gltf", 0, 1, 14, 12, 0, 0, 0},
    {"luanti_triangle_with_vertex_stride.gltf", 0, 1, 3, 1, 0, 0, 0},
    {"luanti_blender_cube_matrix_transform.gltf", 0, 1, 24, 12, 0, 0, 0},
};

const std::filesystem::path data = std::filesystem::path(SKITTER_SHARED_DATA) / "gltf";

RigProposal propose(const std::string& file) { return proposeRig(loadModel(data / file)); }
Rig rigOf(const std::string& file) {
  const Model model = loadModel(data / file);
  return buildRig(model, proposeRig(model).setup, file);
}

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

TEST(ProposeRig, CountsOfForeignModels) {
  if (!std::filesystem::exists(data)) GTEST_SKIP() << data << " is absent";
  size_t files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(data)) {
    files += entry.path().extension() == ".glb" || entry.path().extension() == ".gltf";
  }
  EXPECT_EQ(files, std::size(foreign));
  for (const Foreign& expected : foreign) {
    SCOPED_TRACE(expected.file);
    const Model model = loadModel(data / expected.file);
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

TEST(ProposeRig, HexapodFacesMinusX) {
  if (!std::filesystem::exists(data)) GTEST_SKIP() << data << " is absent";
  const RigProposal proposal = propose("mjolnir_hexapod.glb");
  EXPECT_EQ(proposal.setup.forward, glm::dvec3(-1, 0, 0));
  std::set<std::string> feet;
  for (const FoundLeg& leg : proposal.found) EXPECT_TRUE(leg.footJoint);
  for (const RigSetup::Leg& leg : proposal.setup.legs) {
    EXPECT_EQ(leg.joints.size(), 5u);  // the first of six lies in the body, in one place for all legs
    feet.insert(leg.joints.back());
  }
  EXPECT_EQ(feet.size(), 6u);
  EXPECT_EQ(proposal.setup.legs[0].joints.front(), "leg_front_r_1");  // on its left, whatever its name says
  const Rig rig = rigOf("mjolnir_hexapod.glb");
  expectSound(rig);
  EXPECT_FLOAT_EQ(rig.legLength, 1);
  EXPECT_EQ(groupsOf(rig), "L1A R1B L2B R2A L3A R3B ");
}

TEST(ProposeRig, SpiderWithoutFootJoints) {
  if (!std::filesystem::exists(data)) GTEST_SKIP() << data << " is absent";
  const RigProposal proposal = propose("luanti_spider_animated.gltf");
  EXPECT_EQ(proposal.setup.forward, glm::dvec3(0, 0, 1));
  for (const FoundLeg& leg : proposal.found) EXPECT_FALSE(leg.footJoint);
  for (const RigSetup::Leg& leg : proposal.setup.legs) {
    ASSERT_TRUE(leg.tipOffset.has_value());
    EXPECT_LT(leg.tipOffset->y, -1);  // the shin is 1.3 units long
  }
  const Rig rig = rigOf("luanti_spider_animated.gltf");
  expectSound(rig);
  EXPECT_EQ(groupsOf(rig), "L1A R1B L2B R2A L3A R3B L4B R4A ");
}

TEST(ProposeRig, StraightLegsAreBent) {
  if (!std::filesystem::exists(data)) GTEST_SKIP() << data << " is absent";
  const RigProposal proposal = propose("Fox.glb");
  ASSERT_EQ(proposal.setup.legs.size(), 4u);
  EXPECT_TRUE(proposal.setup.legs[0].bend.has_value());
  EXPECT_FALSE(proposal.setup.legs[2].bend.has_value());
  EXPECT_LT(proposal.setup.legs[0].bend->z, -0.9);  // elbows go back
  expectSound(rigOf("Fox.glb"));
  expectSound(rigOf("RiggedFigure.glb"));
}

TEST(ProposeRig, CommittedQuadruped) {
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

TEST(ProposeRig, QuadrupedGeneratorWritesTheCommittedBytes) {
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
