#include <cmath>

#include "../assets/glb_builder.h"
#include "npy.h"
#include "process.h"

namespace skitter::test {
namespace {

using Shape = std::vector<uint64_t>;
using Trace = AppTest;

constexpr uint64_t legs = 8, bones = 4;  // of the built-in spider

TEST_F(Trace, FilesHoldEveryTick) {
  write("two.json", R"({"herds": [{"agents": 6}, {"agents": 3, "goal": {"kind": "none"}}]})");
  const Result result = skitter(
      {"run", file("two.json"), "--headless", "--frames", "12", "--trace", file("trace"), "--dt", "0.02"});
  ASSERT_EQ(result.code, 0) << result.err;

  const nlohmann::json trace = json("trace/trace.json");
  EXPECT_NEAR(trace.at("dt").get<double>(), 0.02, 1e-8);
  ASSERT_EQ(trace.at("herds").size(), 2u);
  const nlohmann::json& herd = trace.at("herds")[0];
  EXPECT_EQ(herd.at("rig"), "spider");
  EXPECT_EQ(herd.at("agents"), 6);
  for (const char* key : {"legNames", "groups", "boneLengths", "restDirections", "limits"}) {
    EXPECT_EQ(herd.at(key).size(), legs) << key;
  }
  EXPECT_EQ(herd.at("restDirections")[0].size(), bones);
  EXPECT_EQ(herd.at("restDirections")[0][0].size(), 3u);

  const Npy heights = readNpy(file("trace/heights.npy"));
  ASSERT_EQ(heights.shape.size(), 2u);
  const nlohmann::json& terrain = trace.at("terrain");
  EXPECT_FLOAT_EQ(terrain.at("originX").get<float>(),
                  -0.5f * terrain.at("spacingX").get<float>() * static_cast<float>(heights.shape[1] - 1));
  EXPECT_FLOAT_EQ(terrain.at("originZ").get<float>(),
                  -0.5f * terrain.at("spacingZ").get<float>() * static_cast<float>(heights.shape[0] - 1));

  const Npy joints = readNpy(file("trace/herd0/joints.npy")),
            rotations = readNpy(file("trace/herd0/rotations.npy")),
            stance = readNpy(file("trace/herd0/stance.npy")), body = readNpy(file("trace/herd0/body.npy"));
  EXPECT_EQ(joints.type, "<f4");
  EXPECT_EQ(joints.shape, (Shape{12, 6, legs, bones + 1, 3}));
  EXPECT_EQ(rotations.shape, (Shape{12, 6, legs, bones, 4}));
  EXPECT_EQ(stance.type, "|u1");
  EXPECT_EQ(stance.shape, (Shape{12, 6, legs}));
  EXPECT_EQ(body.shape, (Shape{12, 6, 7}));
  EXPECT_EQ(readNpy(file("trace/herd1/body.npy")).shape, (Shape{12, 3, 7}));
  for (const float value : stance.values) EXPECT_TRUE(value == 0 || value == 1);

  // Bone i is as long as the rig says, and R_i turns its rest direction onto it.
  for (uint64_t tick : {0, 11}) {
    for (uint64_t leg = 0; leg < legs; ++leg) {
      for (uint64_t bone = 0; bone < bones; ++bone) {
        double along[3], length = 0;
        for (uint64_t k = 0; k < 3; ++k) {
          along[k] =
              double{joints.at({tick, 5, leg, bone + 1, k})} - double{joints.at({tick, 5, leg, bone, k})};
          length += along[k] * along[k];
        }
        length = std::sqrt(length);
        EXPECT_NEAR(length, herd.at("boneLengths")[leg][bone].get<double>(), 1e-4);
        double q[4], r[3];
        for (uint64_t k = 0; k < 4; ++k) q[k] = rotations.at({tick, 5, leg, bone, k});
        for (size_t k = 0; k < 3; ++k) r[k] = herd.at("restDirections")[leg][bone][k];
        for (size_t k = 0; k < 3; ++k) {
          const size_t a = (k + 1) % 3, b = (k + 2) % 3;
          const double t[3] = {2 * (q[1] * r[2] - q[2] * r[1]), 2 * (q[2] * r[0] - q[0] * r[2]),
                               2 * (q[0] * r[1] - q[1] * r[0])};
          const double turned = r[k] + q[3] * t[k] + q[a] * t[b] - q[b] * t[a];
          EXPECT_NEAR(turned, along[k] / length, 1e-3);
        }
      }
    }
  }
}

TEST_F(Trace, ShorterLegsArePaddedWithNaN) {
  Glb glb = readGlb(SKITTER_ROOT "/assets/spider.glb");
  nlohmann::json& shortLeg = glb.json["scenes"][0]["extras"]["skitter"]["legs"][0];
  shortLeg["joints"].erase(0);  // the coxa becomes a part of the body
  shortLeg["coneHalfAngleDegrees"].erase(0);
  const std::vector<uint8_t> bytes = glb.bytes();
  write("short.glb", std::string(bytes.begin(), bytes.end()));
  write("short.json", R"({"herds": [{"rig": "short.glb", "agents": 2}]})");
  const Result result =
      skitter({"run", file("short.json"), "--headless", "--frames", "3", "--trace", file("trace")});
  ASSERT_EQ(result.code, 0) << result.err;

  EXPECT_EQ(json("trace/trace.json").at("herds")[0].at("boneLengths")[0].size(), bones - 1);
  const Npy joints = readNpy(file("trace/herd0/joints.npy")),
            rotations = readNpy(file("trace/herd0/rotations.npy"));
  ASSERT_EQ(joints.shape, (Shape{3, 2, legs, bones + 1, 3}));
  for (uint64_t l = 0; l < legs; ++l) {
    for (uint64_t joint = 0; joint <= bones; ++joint) {
      EXPECT_EQ(std::isnan(joints.at({2, 1, l, joint, 0})), l == 0 && joint == bones);
    }
    for (uint64_t bone = 0; bone < bones; ++bone) {
      EXPECT_EQ(std::isnan(rotations.at({2, 1, l, bone, 3})), l == 0 && bone == bones - 1);
    }
  }
}

TEST_F(Trace, NoTicksAreNoEntries) {
  ASSERT_EQ(skitter({"run", "--headless", "--agents", "2", "--frames", "0", "--trace", file("trace")}).code,
            0);
  EXPECT_EQ(readNpy(file("trace/herd0/body.npy")).shape, (Shape{0, 2, 7}));
  EXPECT_EQ(json("trace/trace.json").at("ticks"), 0);
}

}  // namespace
}  // namespace skitter::test
