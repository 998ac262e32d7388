#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "assets/rigs/rig_setup.h"
#include "assets/rigs/rig_source.h"
#include "creature.h"
#include "files.h"
#include "skitter/error.h"
#include "skitter/rig_setup.h"

// What legs are, which way is forward and what skin goes with a leg, for models of the kinds that people
// bring.
namespace skitter {
namespace {

using test::Creature;

constexpr std::pair<const char*, double> sides[] = {{".l", 1.0}, {".r", -1.0}};

struct Human {
  double stride = 0;      // by which the left foot is ahead of the middle, the right one behind
  double headBehind = 0;  // of the hips
  bool footOutside = false, toes = false, staff = false, shadow = false, ball = false;
  bool bare = false;  // no skin but the head's
};

// Straight legs, feet that lie on the ground, arms that hang.
Creature human(const Human& is) {
  Creature creature;
  const double skin = is.bare ? 0 : 1;
  const auto root = static_cast<int>(is.ball ? creature.joint("root", -1, {0, -1, 0}, {0, 1, 0}, 1)
                                             : creature.joint("root", -1, {}, {}, 0));
  const auto add = [&](const std::string& name, int parent, const glm::dvec3& at, const glm::dvec3& end,
                       double radius) {
    return static_cast<int>(creature.joint(name, parent, at, end, radius));
  };
  const int pelvis = add("pelvis", root, {0, 0.95, 0}, {0, 1.1, 0}, 0.12 * skin);
  const int chest = add("chest", pelvis, {0, 1.1, 0}, {0, 1.45, 0}, 0.15 * skin);
  add("head", chest, {0, 1.5, -is.headBehind}, {0, 1.75, -is.headBehind}, 0.09);
  for (const auto& [side, x] : sides) {
    const auto named = [&s = side](const char* part) { return std::string(part) + s; };
    const double z = is.stride * x;
    const glm::dvec3 knee(0.1 * x, 0.5, 0.5 * z), ankle(0.1 * x, 0.08, z), ball(0.1 * x, 0.03, z + 0.14);
    const int thigh = add(named("thigh"), pelvis, {0.1 * x, 0.92, 0}, knee, 0.07 * skin);
    const int calf = add(named("calf"), thigh, knee, ankle, 0.05 * skin);
    const int foot =
        add(named("foot"), is.footOutside ? root : calf, ankle, {0.1 * x, 0.04, z + 0.14}, 0.04 * skin);
    if (is.footOutside) add(named("calf_end"), calf, ankle, ankle, 0);
    if (is.toes) add(named("ball"), foot, ball, {0.1 * x, 0.02, z + 0.22}, 0.02 * skin);
    const int arm = add(named("upperarm"), chest, {0.2 * x, 1.42, 0}, {0.22 * x, 1.15, 0}, 0.04 * skin);
    const int hand = add(named("hand"), arm, {0.22 * x, 1.15, 0}, {0.22 * x, 0.85, 0.05}, 0.035 * skin);
    if (is.staff && x < 0) add("staff", hand, {-0.22, 0.85, 0.05}, {-0.3, 0.02, 0.3}, 0.02);
  }
  if (is.shadow) {
    const int shadow = add("shadow", root, {0, -3, 0}, {0, -3, 0.5}, 1e-3);
    add("shadow_edge", shadow, {0, -3, 0.5}, {0, -3, 1}, 1e-3);
  }
  return creature;
}

class Unprepared : public ::testing::Test {
 protected:
  Model modelOf(const test::Glb& glb) {
    test::writeBytes(folder_ / "creature.glb", glb.bytes());
    return loadModel(folder_ / "creature.glb");
  }
  Model modelOf(const Creature& creature) { return modelOf(creature.glb()); }
  RigProposal propose(const Creature& creature) { return proposeRig(modelOf(creature)); }

  test::TemporaryFolder folder_;
};

std::vector<std::string> rootsOf(const RigProposal& proposal) {
  std::vector<std::string> roots;
  for (const RigSetup::Leg& leg : proposal.setup.legs) roots.push_back(leg.joints.front());
  return roots;
}

const std::string& forwardNote(const RigProposal& proposal) {
  static const std::string none;
  for (const std::string& note : proposal.notes) {
    if (note.starts_with("forward is")) return note;
  }
  return none;
}

const glm::dvec3 ahead(0, 0, 1);
const std::vector<std::string> thighs = {"thigh.l", "thigh.r"};

// The skin that follows a node alone.
std::vector<SkinVertex> skinOf(const Model& model, const Rig& rig, const std::string& name) {
  std::vector<SkinVertex> skin;
  for (size_t v = 0; v < model.vertices.size(); ++v) {
    const Model::Influence& heaviest = model.influences[model.vertices[v].firstInfluence];
    if (heaviest.weight > 0.99 && model.nodes[heaviest.node].name == name) skin.push_back(rig.vertices[v]);
  }
  return skin;
}

// Metres a unit of the model.
double scaleOf(const Model& model, const Rig& rig) {
  const glm::vec3 a = rig.vertices[0].position, b = rig.vertices[1].position;
  return glm::length(a - b) / glm::length(model.vertices[0].position - model.vertices[1].position);
}

TEST_F(Unprepared, FeetOutsideTheirLegsEndThem) {
  const Model model = modelOf(human({.footOutside = true}));
  const RigProposal proposal = proposeRig(model);
  ASSERT_EQ(rootsOf(proposal), thighs);
  for (const RigSetup::Leg& leg : proposal.setup.legs) {
    ASSERT_EQ(leg.joints.size(), 3u);
    EXPECT_EQ(leg.joints[2], leg.joints[0] == "thigh.l" ? "foot.l" : "foot.r");
    EXPECT_TRUE(leg.tipOffset.has_value());
    EXPECT_EQ(leg.footBones, 1u);
  }
  const Rig rig = buildRig(model, proposal.setup, "creature");
  float lowest = 1;
  for (const SkinVertex& vertex : skinOf(model, rig, "foot.r")) {
    EXPECT_EQ(vertex.bones[0], 1 + rig.maxBones() + 2);
    lowest = std::min(lowest, vertex.position.y);
  }
  EXPECT_NEAR(lowest, 0, 1e-4);  // it stands as it rests
}

// A heel or a shin plate that hangs from the root goes with the bone that it rests on, and with the body
// where the sidecar says nothing of it.
TEST_F(Unprepared, JointsThatRestOnALegFollowItsBone) {
  Creature creature = human({.toes = true});
  creature.joint("plate.r", 0, {-0.1, 0.3, 0.02}, {-0.1, 0.2, 0.06}, 0.02);
  creature.joint("pouch", 0, {0.16, 0.9, 0}, {0.16, 0.8, 0}, 0.02);
  const Model model = modelOf(creature);
  RigProposal proposal = proposeRig(model);
  ASSERT_EQ(proposal.setup.followers.size(), 1u);
  EXPECT_EQ(proposal.setup.followers[0].joint, "plate.r");
  EXPECT_EQ(proposal.setup.followers[0].bone, "calf.r");
  const auto boneOf = [&] {
    const Rig rig = buildRig(model, parseRigSetup(writeRigSetup(proposal.setup), "creature"), "creature");
    return std::pair(skinOf(model, rig, "plate.r")[0].bones[0], 1 + rig.maxBones() + 1);
  };
  EXPECT_EQ(boneOf().first, boneOf().second);
  proposal.setup.followers.clear();
  EXPECT_EQ(boneOf().first, 0);
}

TEST_F(Unprepared, KneesOfPeopleBendForwardAndSolesStayLevel) {
  for (const bool toes : {false, true}) {
    const Model model = modelOf(human({.toes = toes}));
    const RigProposal proposal = proposeRig(model);
    ASSERT_EQ(rootsOf(proposal), thighs);
    const Rig rig = buildRig(model, proposal.setup, "creature");
    for (const Leg& leg : rig.legs) {
      ASSERT_EQ(leg.bones.size(), 3u);
      EXPECT_GT(leg.bones[1].start.z, leg.root().z + 0.2f);
      EXPECT_GT(leg.bones[1].start.z, leg.bones[2].start.z + 0.2f);
      const Bone& foot = leg.bones.back();
      EXPECT_LT(glm::length(foot.start + foot.direction * foot.length - leg.home), 1e-4f);
      // The ankle's cone cannot fold the foot against the shin.
      EXPECT_LE(foot.coneHalfAngle, glm::radians(45.0f));
    }
    // The foot is turned nowhere: heel and toes are as high as they were above the sole.
    float least = 1;
    const std::vector<SkinVertex> skin = skinOf(model, rig, "foot.l");
    for (const SkinVertex& vertex : skin) least = std::min(least, vertex.position.y);
    EXPECT_NEAR(least, toes ? 0.01f : 0, 0.01f);
  }
}

TEST_F(Unprepared, ModelsInMidStrideHaveTheirPairs) {
  const Model model = modelOf(human({.stride = 0.2}));
  const RigProposal proposal = proposeRig(model);
  EXPECT_EQ(rootsOf(proposal), thighs);
  EXPECT_EQ(proposal.setup.forward, ahead);
  const Rig rig = buildRig(model, proposal.setup, "creature");
  EXPECT_NEAR(rig.legs[0].home.z, rig.legs[1].home.z, 1e-5);
  EXPECT_NEAR(rig.legs[0].home.x, -rig.legs[1].home.x, 1e-5);

  Creature beast;
  const auto body = static_cast<int>(beast.joint("body", -1, {0, 1, 0}, {0, 1, 0.8}, 0.2));
  beast.joint("head", body, {0, 1.2, 0.9}, {0, 1.2, 1.2}, 0.12);
  for (const auto& [side, x] : sides) {
    for (const auto& [row, z, by] : {std::tuple("Front", 0.7, 0.0), std::tuple("Back", -0.1, -0.3 * x)}) {
      const std::string name = std::string(row), end = side;
      beast.limb({name + "Up" + end, name + "Low" + end}, body,
                 {{0.25 * x, 0.95, z}, {0.25 * x, 0.5, z + 0.5 * by + 0.08}, {0.25 * x, 0, z + by}}, 0.04);
    }
  }
  EXPECT_EQ(rootsOf(propose(beast)),
            (std::vector<std::string>{"FrontUp.l", "FrontUp.r", "BackUp.l", "BackUp.r"}));
}

// A foot that is high in the air is found by its partner.
TEST_F(Unprepared, ALiftedFootHasItsPartner) {
  Creature creature;
  const auto body = static_cast<int>(creature.joint("body", -1, {0, 1, 0}, {0, 1.4, 0}, 0.2));
  creature.limb({"up.l", "low.l"}, body, {{0.2, 1, 0}, {0.2, 0.5, 0.1}, {0.2, 0, 0}}, 0.05);
  creature.limb({"up.r", "low.r"}, body, {{-0.2, 1, 0}, {-0.2, 0.6, 0.31}, {-0.2, 0.32, -0.105}}, 0.05);
  EXPECT_EQ(rootsOf(propose(creature)), (std::vector<std::string>{"up.l", "up.r"}));
}

TEST_F(Unprepared, WhatIsHeldIsNoLeg) {
  EXPECT_EQ(rootsOf(propose(human({.staff = true}))), thighs);
  Creature unnamed = human({.staff = true});
  unnamed.named = false;
  const Model model = modelOf(unnamed);
  ASSERT_EQ(proposeRig(model).setup.legs.size(), 2u);
  for (const Leg& leg : buildRig(model, proposeRig(model).setup, "creature").legs) EXPECT_LT(leg.root().y, 1);
}

TEST_F(Unprepared, FingersAreNoLegs) {
  Creature hand;
  const auto palm = static_cast<int>(hand.joint("hand", -1, {0, 1, 0}, {0, 1, 0.3}, 0.2));
  for (const auto& [name, x] : {std::pair("index", -0.2), std::pair("finger_2", -0.07),
                                std::pair("finger_3", 0.07), std::pair("pinky", 0.2)}) {
    hand.limb({std::string(name) + "_a", std::string(name) + "_b"}, palm,
              {{x, 1, 0.3}, {x, 0.6, 0.5}, {x, 0, 0.4}}, 0.05);
  }
  const RigProposal proposal = propose(hand);
  EXPECT_TRUE(proposal.setup.legs.empty());
  ASSERT_FALSE(proposal.notes.empty());
  EXPECT_NE(proposal.notes.back().find("is a finger"), std::string::npos) << proposal.notes.back();
}

TEST_F(Unprepared, ChainsWithoutSkinAreNoLegs) {
  const RigProposal proposal = propose(human({.bare = true}));
  EXPECT_TRUE(proposal.setup.legs.empty());
  ASSERT_FALSE(proposal.notes.empty());
  EXPECT_NE(proposal.notes.back().find("carry no skin"), std::string::npos) << proposal.notes.back();
}

TEST_F(Unprepared, LegsOfOneBoneAreRefusedWithTheReason) {
  Creature egg;
  const auto body = static_cast<int>(egg.joint("body", -1, {0, 0.6, 0}, {0, 1.6, 0}, 0.4));
  for (const auto& [side, x] : sides)
    egg.joint(std::string("leg") + side, body, {0.5 * x, 0.6, 0}, {0.5 * x, 0, 0}, 0.12);
  const RigProposal proposal = propose(egg);
  EXPECT_TRUE(proposal.setup.legs.empty());
  ASSERT_FALSE(proposal.notes.empty());
  EXPECT_NE(proposal.notes.back().find("one bone (leg.l, leg.r)"), std::string::npos)
      << proposal.notes.back();
}

TEST_F(Unprepared, LegsOfTwoToEightBonesAreFound) {
  for (size_t bones = 2; bones <= 8; ++bones) {
    Creature creature;
    const auto body = static_cast<int>(creature.joint("body", -1, {0, 1, 0}, {0, 1.4, 0}, 0.2));
    for (const auto& [side, x] : sides) {
      std::vector<std::string> names;
      std::vector<glm::dvec3> points{{0.3 * x, 1, 0}};
      for (size_t k = 0; k < bones; ++k) {
        names.push_back("leg" + std::to_string(k) + side);
        const double share = static_cast<double>(k + 1) / static_cast<double>(bones);
        points.push_back({0.3 * x, 1 - share, 0.4 * std::sin(std::numbers::pi * share)});
      }
      creature.limb(names, body, points, 0.03);
    }
    const Model model = modelOf(creature);
    const RigProposal proposal = proposeRig(model);
    ASSERT_EQ(proposal.setup.legs.size(), 2u) << bones;
    EXPECT_EQ(buildRig(model, proposal.setup, "creature").legs[0].bones.size(), bones);
  }
}

TEST_F(Unprepared, OddCountsOfLegsKeepAll) {
  for (const size_t count : {3, 5, 7}) {
    Creature creature;
    const auto body = static_cast<int>(creature.joint("body", -1, {0, 0.5, 0}, {0, 0.5, 0.2}, 0.2));
    for (size_t k = 0; k < count; ++k) {
      const double angle = 2 * std::numbers::pi * (static_cast<double>(k) + 0.5) / static_cast<double>(count);
      const glm::dvec3 out(std::sin(angle), 0, std::cos(angle));
      const std::string name = "leg" + std::to_string(k);
      creature.limb({name + "_a", name + "_b"}, body,
                    {0.2 * out + glm::dvec3(0, 0.5, 0), 0.6 * out + glm::dvec3(0, 0.65, 0), 0.9 * out}, 0.04);
    }
    // A tail in the middle is no leg.
    creature.limb({"end_a", "end_b", "end_c"}, body,
                  {{0, 0.5, -0.3}, {0, 0.3, -0.6}, {0, 0.1, -1.1}, {0, 0.02, -1.9}}, 0.03);
    EXPECT_EQ(propose(creature).setup.legs.size(), count);
  }
}

TEST_F(Unprepared, WhatLiesBelowIsNoGround) {
  EXPECT_EQ(rootsOf(propose(human({.ball = true}))), thighs);
  EXPECT_EQ(rootsOf(propose(human({.shadow = true}))), thighs);
  // A plate that no joint moves, far below.
  test::Glb glb = human({}).glb();
  const size_t positions = glb.append(std::vector<float>{-9, -60, -9, 9, -60, -9, 0, -60, 9}, "VEC3");
  glb.json["accessors"][positions]["min"] = {-9, -60, -9};
  glb.json["accessors"][positions]["max"] = {9, -60, 9};
  glb.json["meshes"].push_back({{"primitives", {{{"attributes", {{"POSITION", positions}}}}}}});
  glb.json["nodes"].push_back({{"name", "turntable"}, {"mesh", glb.json["meshes"].size() - 1}});
  glb.json["scenes"][0]["nodes"].push_back(glb.json["nodes"].size() - 1);
  const RigProposal proposal = proposeRig(modelOf(glb));
  EXPECT_EQ(rootsOf(proposal), thighs);
  EXPECT_EQ(proposal.setup.up, glm::dvec3(0, 1, 0));
}

TEST_F(Unprepared, ToesSayMoreThanAHead) {
  const RigProposal proposal = propose(human({.headBehind = 0.2}));
  EXPECT_EQ(proposal.setup.forward, ahead);
  EXPECT_NE(forwardNote(proposal).find("against head"), std::string::npos) << forwardNote(proposal);
}

// Whoever named the joints took the creature's left for his own.
TEST_F(Unprepared, FrontAndBackSayMoreThanLeftAndRight) {
  Creature creature;
  const auto body = static_cast<int>(creature.joint("body", -1, {0, 0.7, 0}, {0, 1.4, 0}, 0.4));
  creature.joint("eyes", body, {0, 0.9, 0.48}, {0, 0.9, 0.5}, 0.1);
  for (const auto& [side, x] : {std::pair("r-", 1.0), std::pair("l-", -1.0)})
    for (const auto& [row, z] : {std::pair("frontleg", 0.6), std::pair("backleg", -0.6)})
      creature.limb({std::string(side) + row, std::string(side) + row + "001"}, body,
                    {{0.9 * x, 0.7, z}, {1.1 * x, 0.4, z}, {x, 0, z}}, 0.05);
  const RigProposal proposal = propose(creature);
  EXPECT_EQ(proposal.setup.forward, ahead);
  ASSERT_EQ(proposal.setup.legs.size(), 4u);
  EXPECT_EQ(proposal.setup.legs[0].joints.front(), "r-frontleg");
  EXPECT_NE(forwardNote(proposal).find("against joints named left and right"), std::string::npos);
}

// One foot before the other and the hips turned: the body still faces along the model's axis.
TEST_F(Unprepared, TurnedHipsDoNotTurnTheCreature) {
  Creature creature;
  const auto body = static_cast<int>(creature.joint("body", -1, {0, 0.4, 0}, {0, 0.7, 0}, 0.2));
  creature.joint("eye", body, {0, 0.5, 0.2}, {0, 0.5, 0.25}, 0.05);
  for (const auto& [side, x] : sides)
    creature.limb({std::string("leg1") + side, std::string("leg2") + side}, body,
                  {{0.26 * x, 0.38, -0.04 * x}, {0.5 * x, 0.4, -0.14 * x}, {0.6 * x, 0, -0.28 * x}}, 0.04);
  EXPECT_EQ(propose(creature).setup.forward, ahead);
}

// A creature that nothing but its clip tells front from back of. Its feet go backward where they stand.
TEST_F(Unprepared, FeetOfAWalkTellForward) {
  for (const double way : {1.0, -1.0}) {
    Creature creature;
    const auto body = static_cast<int>(creature.joint("body", -1, {0, 1, -0.3}, {0, 1, 0.3}, 0.2));
    std::vector<size_t> legs;
    for (const double x : {1.0, -1.0})
      legs.push_back(creature.limb({x > 0 ? "a1" : "b1", x > 0 ? "a2" : "b2"}, body,
                                   {{0.2 * x, 1, 0}, {0.6 * x, 0.6, 0}, {0.3 * x, 0, 0}}, 0.04));
    creature.clip("Walk", 1, 25, [&](test::Pose& pose, double time) {
      for (size_t k = 0; k < 2; ++k) {
        const double phase = std::fmod(time + 0.5 * static_cast<double>(k), 1.0), share = 2 * phase - 1;
        const double swing = phase < 0.5 ? 0.3 - 1.2 * phase : -0.3 + 0.6 * share;
        pose.turn(legs[k], glm::angleAxis(-way * swing, glm::dvec3(1, 0, 0)));
        if (phase >= 0.5)
          pose.turn(legs[k] + 1, glm::angleAxis(0.6 * std::sin(std::numbers::pi * share),
                                                glm::dvec3(0, 0, k == 0 ? -1 : 1)));
      }
    });
    test::writeBytes(folder_ / "walker.glb", creature.glb().bytes());
    const RigSource source = loadBareModel(folder_ / "walker.glb");
    const RigProposal proposal = proposeRig(source.model, &source.document, {});
    EXPECT_EQ(proposal.setup.forward, way * ahead) << forwardNote(proposal);
    EXPECT_NE(forwardNote(proposal).find("by clips that walk"), std::string::npos) << forwardNote(proposal);
    EXPECT_NE(forwardNote(proposeRig(source.model)).find("doubtful"), std::string::npos);
  }
}

// Legs that are brought home sideways carry their feet round, but not over.
TEST_F(Unprepared, FeetThatAreBroughtHomeStayLevel) {
  Creature creature;
  const auto body = static_cast<int>(creature.joint("body", -1, {0, 0.4, 0}, {0, 0.7, 0}, 0.2));
  creature.joint("eye", body, {0, 0.5, 0.2}, {0, 0.5, 0.25}, 0.05);
  for (const auto& [side, x] : sides) {
    const std::string end = side;
    const glm::dvec3 ankle(0.6 * x, 0.1, -0.3 * x);
    creature.limb(
        {"leg1" + end, "leg2" + end, "foot" + end}, body,
        {{0.26 * x, 0.38, 0}, {0.5 * x, 0.42, -0.16 * x}, ankle, ankle + glm::dvec3(0, -0.06, 0.25)}, 0.04);
  }
  const Model model = modelOf(creature);
  const RigProposal proposal = proposeRig(model);
  ASSERT_EQ(proposal.setup.legs.size(), 2u);
  EXPECT_EQ(proposal.setup.legs[0].footBones, 1u);
  const Rig rig = buildRig(model, proposal.setup, "creature");
  for (const char* name : {"foot.l", "foot.r"}) {
    float least = 1, most = -1;
    for (const SkinVertex& vertex : skinOf(model, rig, name)) {
      least = std::min(least, vertex.position.y);
      most = std::max(most, vertex.position.y);
    }
    EXPECT_NEAR(least, 0, 2e-3f) << name;
    // As thick as the box is, 0.078 units of a creature whose legs are 1 m.
    EXPECT_NEAR(most - least, 0.078 * scaleOf(model, rig), 3e-3) << name;
  }
}

TEST_F(Unprepared, DoubtNamesTheOptionThatTurnsItRound) {
  Creature creature = human({});
  creature.named = false;
  const Model model = modelOf(creature);
  EXPECT_EQ(forwardNote(proposeRig(model)).find("doubtful"), std::string::npos);  // toes tell
  Creature plain;
  const auto body = static_cast<int>(plain.joint("", -1, {0, 1, 0}, {0, 1.3, 0}, 0.2));
  for (const double x : {1.0, -1.0})
    plain.limb({"", ""}, body, {{0.2 * x, 1, 0}, {0.5 * x, 0.6, 0}, {0.3 * x, 0, 0}}, 0.04);
  plain.named = false;
  const RigProposal proposal = propose(plain);
  ASSERT_EQ(proposal.setup.legs.size(), 2u);
  EXPECT_NE(forwardNote(proposal).find("doubtful: `skitter rig --forward -Z` turns it round"),
            std::string::npos)
      << forwardNote(proposal);
  const RigProposal turned = proposeRig(model, glm::dvec3(0, 0, -1));
  EXPECT_EQ(turned.setup.forward, -ahead);
  EXPECT_EQ(turned.setup.legs.size(), 2u);
  EXPECT_TRUE(proposeRig(model, glm::dvec3(0, 1, 0)).setup.legs.empty());
}

// A cone about the rest direction that is no wider than the joint's bend at rest ends where the leg is
// straight.
TEST_F(Unprepared, BentKneesCannotTurnOver) {
  const Model model = loadModel(SKITTER_ROOT "/assets/quadruped.glb");
  const Rig rig = buildRig(model, proposeRig(model).setup, "quadruped");
  for (const Leg& leg : rig.legs) {
    for (size_t i = 1; i < leg.bones.size(); ++i) {
      const float bend = std::acos(glm::dot(leg.bones[i - 1].direction, leg.bones[i].direction));
      EXPECT_LE(leg.bones[i].coneHalfAngle, bend + 1e-4f) << leg.name << " " << leg.bones[i].joint;
    }
  }
}

}  // namespace
}  // namespace skitter
