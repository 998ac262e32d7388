#include "skitter/rig_setup.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "files.h"
#include "glb_builder.h"

// The sidecar: what its keys do, and that a fault names the key.
namespace skitter {
namespace {

using test::inputFault;

class Sidecar : public ::testing::Test {
 protected:
  Sidecar() {
    test::Glb glb = test::smallestRig();
    glb.json["scenes"][0].erase("extras");
    test::writeBytes(folder_ / "small.glb", glb.bytes());
    json_ = nlohmann::json::parse(R"({
      "model": "small.glb", "scale": 1, "origin": [0, 0, 0], "bodyHeight": 1, "bodyRadius": 0.5, "groups": ["A"],
      "legs": [{"name": "leg", "group": "A", "joints": ["hip", "knee", "foot"]}]})");
  }
  std::filesystem::path write() const {
    test::writeText(folder_ / "small.rig.json", json_.dump());
    return folder_ / "small.rig.json";
  }
  Rig load() const { return loadRig(write()); }
  nlohmann::json& leg() { return json_["legs"][0]; }

  test::TemporaryFolder folder_;
  nlohmann::json json_;
};

TEST_F(Sidecar, IsFoundBesideItsModelOrNamed) {
  EXPECT_EQ(load().legs[0].home, glm::vec3(1, 0, 0));
  EXPECT_EQ(loadRig(folder_ / "small.glb").legs[0].home, glm::vec3(1, 0, 0));
  json_["model"] = "other.glb";
  write();
  EXPECT_NE(inputFault([&] { loadRig(folder_ / "small.glb"); }).find("model is \"other.glb\""),
            std::string::npos);
  EXPECT_NE(inputFault([&] { loadRig(folder_ / "small.rig.json"); }).find("other.glb"), std::string::npos);
  std::filesystem::remove(folder_ / "small.rig.json");
  EXPECT_NE(inputFault([&] { loadRig(folder_ / "small.glb"); }).find("run `skitter rig "), std::string::npos);
}

TEST_F(Sidecar, ScaleAndLegLength) {
  json_["scale"] = 0.25;
  EXPECT_FLOAT_EQ(load().legLength, 0.5f);
  EXPECT_FLOAT_EQ(load().bodyHeight, 0.25f);
  EXPECT_FLOAT_EQ(load().vertices[1].position.x,
                  0.25f * loadModel(folder_ / "small.glb").vertices[1].position.x);
  json_.erase("scale");
  json_["legLength"] = 3;
  EXPECT_FLOAT_EQ(load().legLength, 3);
  EXPECT_FLOAT_EQ(load().bodyRadius, 0.75f);
}

// The body stands as high as the legs' roots on average, where the file does not say.
TEST_F(Sidecar, BodyHeightIsTheRoots) {
  json_["origin"] = {0, -0.7, 0};
  const float given = load().bodyHeight;
  json_.erase("bodyHeight");
  const Rig rig = load();
  EXPECT_NE(rig.bodyHeight, given);
  EXPECT_FLOAT_EQ(rig.bodyHeight, rig.legs[0].root().y);
}

TEST_F(Sidecar, ForwardUpAndOrigin) {
  json_["forward"] = "+X";
  EXPECT_LT(glm::length(load().legs[0].home - glm::vec3(0, 0, 1)), 1e-6f);
  json_["forward"] = {-3, 0, 0};
  EXPECT_LT(glm::length(load().legs[0].home - glm::vec3(0, 0, -1)), 1e-6f);
  json_["forward"] = "+Z";
  json_["origin"] = {1, -0.5, 0};
  EXPECT_LT(glm::length(load().legs[0].root() - glm::vec3(-1, 1.5f, 0)), 1e-6f);
  EXPECT_LT(glm::length(load().legs[0].home), 1e-6f);  // on the ground, below the foot at rest
  json_["up"] = "-X";
  json_["origin"] = {1, 0, 0};
  EXPECT_LT(glm::length(load().legs[0].root() - glm::vec3(1, 1, 0)), 1e-6f);
}

TEST_F(Sidecar, TipOffsetIsAFootWithoutAJoint) {
  leg()["joints"] = {"hip", "knee"};
  leg()["tipOffset"] = {0.5, -1, 0};
  const Rig rig = load();
  ASSERT_EQ(rig.legs[0].bones.size(), 2u);
  EXPECT_EQ(rig.legs[0].home, glm::vec3(1.5f, 0, 0));
  EXPECT_FLOAT_EQ(rig.legs[0].bones[1].length, std::sqrt(1.25f));
}

TEST_F(Sidecar, HomeConesAndColour) {
  leg()["home"] = {1.25, 0, 0.5};
  leg()["coneHalfAngleDegrees"] = {60, 180};
  json_["colour"] = {0.5, 0.25, 0};
  const Rig rig = load();
  EXPECT_EQ(rig.legs[0].home, glm::vec3(1.25f, 0, 0.5f));
  EXPECT_FLOAT_EQ(rig.legs[0].bones[0].coneHalfAngle, glm::radians(60.0f));
  EXPECT_EQ(rig.legs[0].bones[1].coneHalfAngle, Bone{}.coneHalfAngle);
  EXPECT_EQ(rig.vertices[0].colour, glm::vec3(0.5f, 0.25f, 0));
}

TEST_F(Sidecar, BendMovesTheKneeAndTheSkin) {
  // A straight leg: hip at (0, 1, 0), knee 1 m on, foot 1 m further.
  test::Glb glb = test::smallestRig();
  glb.json["scenes"][0].erase("extras");
  glb.node("foot")["translation"] = {1, 0, 0};
  test::writeBytes(folder_ / "small.glb", glb.bytes());
  json_["origin"] = {0, 0.5, 0};
  leg()["home"] = {1.5, 0.5, 0};
  leg()["bend"] = {0, 1, 0};
  leg()["bendDegrees"] = 90;
  const Rig rig = load();
  const Leg& bent = rig.legs[0];
  EXPECT_EQ(bent.root(), glm::vec3(0, 0.5f, 0));
  EXPECT_LT(glm::length(bent.bones[1].start - glm::vec3(std::sqrt(0.5f), 0.5f + std::sqrt(0.5f), 0)), 1e-5f);
  const glm::vec3 tip = bent.bones[1].start + bent.bones[1].direction * bent.bones[1].length;
  EXPECT_LT(glm::length(tip - glm::vec3(std::sqrt(2.0f), 0.5f, 0)), 1e-5f);
  // Vertex 2 hangs from knee and foot alone: it turns about the knee with the lower bone.
  json_["legs"][0].erase("bend");
  const glm::vec3 straight = load().vertices[2].position - glm::vec3(1, 0.5f, 0);
  const glm::vec3 moved = rig.vertices[2].position - bent.bones[1].start;
  EXPECT_NEAR(glm::length(straight), glm::length(moved), 1e-5f);
}

TEST_F(Sidecar, FootBonesBringTheFootHome) {
  leg()["footBones"] = 0;
  leg()["home"] = {0.7, -0.2, 0.1};
  const Rig rig = load();
  const Bone& last = rig.legs[0].bones.back();
  EXPECT_EQ(rig.legs[0].root(), glm::vec3(0, 1, 0));
  EXPECT_LT(glm::length(last.start + last.direction * last.length - rig.legs[0].home), 1e-5f);
  // Vertex 2 hangs from knee and foot alone: it goes with the lower bone.
  const glm::vec3 moved = rig.vertices[2].position - last.start;
  leg().erase("footBones");
  const Rig before = load();
  EXPECT_NEAR(glm::length(before.vertices[2].position - before.legs[0].bones.back().start),
              glm::length(moved), 1e-5f);
}

TEST_F(Sidecar, JointsByIndex) {
  leg()["joints"] = {"#2", "knee", "#4"};
  EXPECT_EQ(load().legs[0].home, glm::vec3(1, 0, 0));
  for (const char* absent : {"#99", "#99999999999999999999"}) {
    leg()["joints"] = {"#2", "knee", absent};
    const std::string what = inputFault([&] { load(); });
    EXPECT_NE(what.find(fmt::format("legs[0].joints[2] is \"{}\", but there are 5 nodes", absent)),
              std::string::npos)
        << what;
  }
}

TEST_F(Sidecar, FaultsNameTheKey) {
  const nlohmann::json good = json_;
  const std::pair<std::function<void(nlohmann::json&)>, const char*> cases[] = {
      {[](auto& j) { j.erase("model"); }, "model is missing"},
      {[](auto& j) { j["model"] = 3; }, "model is 3"},
      {[](auto& j) { j["modle"] = "x"; }, "unknown key \"modle\"; did you mean model? Expected one of "},
      {[](auto& j) { j["scale"] = 0; }, "scale is 0"},
      {[](auto& j) { j["scale"] = "big"; }, "scale is \"big\""},
      {[](auto& j) { j["legLength"] = 1; }, "scale and legLength"},
      {[](auto& j) { j["forward"] = "ahead"; }, "forward is \"ahead\""},
      {[](auto& j) { j["forward"] = "+Y"; }, "forward is along up"},
      {[](auto& j) {
         j["up"] = {0, 0, 0};
       },
       "up is an array of 3"},
      {[](auto& j) {
         j["origin"] = {0, 1};
       },
       "origin is an array of 2"},
      {[](auto& j) {
         j["origin"] = {0, 1, "x"};
       },
       "origin[2] is \"x\""},
      {[](auto& j) { j["bodyHeight"] = -1; }, "bodyHeight is -1"},
      {[](auto& j) { j["bodyRadius"] = nullptr; }, "bodyRadius is null"},
      {[](auto& j) {
         j["colour"] = {1, -1, 1};
       },
       "colour is an array"},
      {[](auto& j) { j["groups"] = "A"; }, "groups is \"A\""},
      {[](auto& j) {
         j["groups"] = {"A\nA", "A\nA"};
       },
       "groups names \"A A\" twice"},
      {[](auto& j) { j["legs"] = nlohmann::json::object(); }, "legs is an object"},
      {[](auto& j) { j["legs"][0]["knee"] = 1; }, "legs[0] has the unknown key \"knee\""},
      {[](auto& j) { j["legs"][0].erase("name"); }, "legs[0].name is missing"},
      {[](auto& j) { j["legs"][0]["group"] = "B"; }, "legs[0].group is \"B\""},
      {[](auto& j) { j["legs"][0]["joints"] = {"hip"}; }, "legs[0].joints is an array of 1"},
      {[](auto& j) { j["legs"][0]["joints"] = std::vector<std::string>(17, "hip"); },
       "legs[0].joints is an array of 17"},
      {[](auto& j) {
         j["legs"][0]["joints"] = std::vector<std::string>(16, "hip");
         j["legs"][0]["tipOffset"] = {0, 0, -0.1};
       },
       "legs[0].joints is an array of 16"},
      {[](auto& j) { j["legs"][0]["joints"][1] = "elbow"; }, "legs[0].joints[1]: no node is named \"elbow\""},
      {[](auto& j) { j["legs"][0]["tipOffset"] = 1; }, "legs[0].tipOffset is 1"},
      {[](auto& j) {
         j["legs"][0]["tipOffset"] = {0, 0, 0};
       },
       "legs[0]: the bone at \"foot\" has length 0"},
      {[](auto& j) {
         j["legs"][0]["home"] = {0, 0};
       },
       "legs[0].home is an array of 2"},
      {[](auto& j) {
         j["legs"][0]["home"] = {9, 0, 0};
       },
       "legs[0].home is 9.06 m from the leg's root"},
      {[](auto& j) {
         j["legs"][0]["bend"] = {0, 0, 0};
       },
       "legs[0].bend"},
      {[](auto& j) { j["legs"][0]["bendDegrees"] = 121; }, "legs[0].bendDegrees is 121"},
      {[](auto& j) { j["legs"][0]["footBones"] = 2; },
       "legs[0].footBones is 2, expected a whole number less than"},
      {[](auto& j) {
         j["legs"][0]["joints"] = {"knee", "hip", "foot"};
       },
       "\"hip\" is above \"knee\""},
      {[](auto& j) { j["follow"] = "knee"; }, "follow is \"knee\", expected an object"},
      {[](auto& j) { j["follow"]["knee"] = "hip"; }, "follow: \"knee\" is a joint of a leg"},
      {[](auto& j) { j["follow"]["body"] = "body"; }, "follow.body is \"body\", expected a joint of a leg"},
      {[](auto& j) { j["follow"]["tail"] = "hip"; }, "follow: no node is named \"tail\""},
      {[](auto& j) { j["legs"][0]["coneHalfAngleDegrees"] = 60; }, "legs[0].coneHalfAngleDegrees is 60"},
      {[](auto& j) { j["legs"][0]["coneHalfAngleDegrees"] = {60}; }, "1 angles, the leg 2 bones"},
      {[](auto& j) {
         j["legs"][0]["coneHalfAngleDegrees"] = {60, 0};
       },
       "coneHalfAngleDegrees[1] is 0"},
  };
  for (const auto& [change, expected] : cases) {
    json_ = good;
    change(json_);
    const std::string what = inputFault([&] { load(); });
    EXPECT_NE(what.find("small.rig.json: "), std::string::npos) << what;
    EXPECT_NE(what.find(expected), std::string::npos) << what << "\nexpected: " << expected;
  }
  test::writeText(folder_ / "small.rig.json", "{\"model\": ");
  EXPECT_NE(inputFault([&] { loadRig(folder_ / "small.rig.json"); }).find("not valid JSON"),
            std::string::npos);
}

TEST_F(Sidecar, NumbersTooSmallForSixDigitsAreWritten) {
  leg()["tipOffset"] = {1e-320, -1, 0};
  const std::string text = writeRigSetup(parseRigSetup(json_.dump(), "small"));
  EXPECT_LT(std::fabs(nlohmann::json::parse(text)["legs"][0]["tipOffset"][0].get<double>()), 1e-300);
}

TEST_F(Sidecar, WhatIsWrittenReadsTheSame) {
  leg()["tipOffset"] = {0.5, -1, 0.25};
  leg()["home"] = {1, 0, 0};
  leg()["bend"] = {0, 1, 0};
  leg()["bendDegrees"] = 20;
  leg()["coneHalfAngleDegrees"] = {60, 70, 180};
  leg()["joints"][0] = "a, \"b\"";
  json_["follow"]["body"] = "knee";
  json_["forward"] = "-X";
  json_["colour"] = {0.5, 0.5, 0.5};
  const std::string once = writeRigSetup(parseRigSetup(json_.dump(), "once"));
  EXPECT_EQ(once, writeRigSetup(parseRigSetup(once, "twice")));
  EXPECT_NE(once.find("\"coneHalfAngleDegrees\": [60, 70, 180]"), std::string::npos) << once;
  EXPECT_EQ(nlohmann::json::parse(once)["legs"][0]["joints"][0], "a, \"b\"");
  EXPECT_EQ(nlohmann::json::parse(once)["forward"], "-X");
  EXPECT_EQ(nlohmann::json::parse(once)["follow"]["body"], "knee");
  leg()["footBones"] = 1;
  EXPECT_EQ(
      nlohmann::json::parse(writeRigSetup(parseRigSetup(json_.dump(), "thrice")))["legs"][0]["footBones"], 1);
}

}  // namespace
}  // namespace skitter
