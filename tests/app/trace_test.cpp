#include <array>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "../assets/files.h"
#include "../assets/glb_builder.h"
#include "../assets/gltf_pose.h"
#include "../assets/height_bytes.h"
#include "npy.h"
#include "process.h"

namespace skitter::test {
namespace {

using Shape = std::vector<uint64_t>;
using Trace = AppTest;

constexpr uint64_t legs = 8, bones = 4;  // of the built-in spider

using Vector = std::array<double, 3>;

Vector operator-(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
double length(const Vector& v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

// The x, y, z under an index without its last axis.
Vector vectorAt(const Npy& npy, std::vector<uint64_t> index) {
  Vector v{};
  index.push_back(0);
  for (uint64_t k = 0; k < 3; ++k) {
    index.back() = k;
    v[k] = npy.at(index);
  }
  return v;
}

// R^-1 v, by the quaternion's matrix.
Vector turnedBack(const std::array<double, 4>& q, const Vector& v) {
  const auto [x, y, z, w] = q;
  return {(1 - 2 * (y * y + z * z)) * v[0] + 2 * (x * y + w * z) * v[1] + 2 * (x * z - w * y) * v[2],
          2 * (x * y - w * z) * v[0] + (1 - 2 * (x * x + z * z)) * v[1] + 2 * (y * z + w * x) * v[2],
          2 * (x * z + w * y) * v[0] + 2 * (y * z - w * x) * v[1] + (1 - 2 * (x * x + y * y)) * v[2]};
}

// The ground below a point, from the files alone.
double groundBelow(const Npy& heights, const nlohmann::json& terrain, const Vector& p) {
  const double u = (p[0] - terrain.at("originX").get<double>()) / terrain.at("spacingX").get<double>();
  const double v = (p[2] - terrain.at("originZ").get<double>()) / terrain.at("spacingZ").get<double>();
  const auto column = static_cast<uint64_t>(u), row = static_cast<uint64_t>(v);
  const auto h = [&](uint64_t r, uint64_t c) { return double{heights.at({r, c})}; };
  const double a = u - static_cast<double>(column), b = v - static_cast<double>(row);
  return (1 - b) * ((1 - a) * h(row, column) + a * h(row, column + 1)) +
         b * ((1 - a) * h(row + 1, column) + a * h(row + 1, column + 1));
}

// On ground of other spacings and other numbers of samples in x and in z: feet that stand are on it and stay,
// others move, and the legs' roots are fixed to the body.
TEST_F(Trace, FeetStandOnTheGroundAndRootsOnTheBody) {
  constexpr uint64_t columns = 81, rows = 31, ticks = 60, agents = 4;
  std::vector<float> metres;
  for (uint64_t row = 0; row < rows; ++row)
    for (uint64_t column = 0; column < columns; ++column)
      metres.push_back(static_cast<float>(0.4 * std::sin(0.3 * static_cast<double>(column)) +
                                          0.3 * std::cos(0.9 * static_cast<double>(row))));
  writeBytes(file("hills_81x31.r32f"), r32f(metres));
  write("hills.json",
        R"({"terrain": {"kind": "file", "file": "hills_81x31.r32f", "spacingX": 0.4, "spacingZ": 0.9},
                          "herds": [{"agents": 4}]})");
  const Result result = skitter(
      {"run", file("hills.json"), "--headless", "--frames", std::to_string(ticks), "--trace", file("trace")});
  ASSERT_EQ(result.code, 0) << result.err;
  const nlohmann::json terrain = json("trace/trace.json").at("terrain");
  EXPECT_NEAR(terrain.at("spacingX").get<double>(), 0.4, 1e-6);
  EXPECT_NEAR(terrain.at("spacingZ").get<double>(), 0.9, 1e-6);
  EXPECT_NEAR(terrain.at("originX").get<double>(), -0.4 * 40, 1e-5);
  EXPECT_NEAR(terrain.at("originZ").get<double>(), -0.9 * 15, 1e-5);
  const Npy heights = readNpy(file("trace/heights.npy"));
  ASSERT_EQ(heights.shape, (Shape{rows, columns}));
  // Heights are relative to the terrain's mid height.
  for (uint64_t i = 0; i < metres.size(); ++i)
    ASSERT_NEAR(heights.values[i] - heights.values[0], metres[i] - metres[0], 1e-6) << i;

  const Npy joints = readNpy(file("trace/herd0/joints.npy")),
            stance = readNpy(file("trace/herd0/stance.npy")), body = readNpy(file("trace/herd0/body.npy"));
  uint64_t standing = 0, flying = 0;
  for (uint64_t agent = 0; agent < agents; ++agent)
    for (uint64_t leg = 0; leg < legs; ++leg)
      for (uint64_t tick = 0; tick < ticks; ++tick) {
        const auto place = testing::Message() << "tick " << tick << ", agent " << agent << ", leg " << leg;
        const auto rootAt = [&](uint64_t t) {
          std::array<double, 4> turn{};
          for (uint64_t k = 0; k < 4; ++k) turn[k] = body.at({t, agent, 3 + k});
          return turnedBack(turn, vectorAt(joints, {t, agent, leg, 0}) - vectorAt(body, {t, agent}));
        };
        ASSERT_LT(length(rootAt(tick) - rootAt(0)), 1e-5) << place;

        const Vector foot = vectorAt(joints, {tick, agent, leg, bones});
        const bool stands = stance.at({tick, agent, leg}) == 1;
        if (stands) {
          ASSERT_NEAR(foot[1], groundBelow(heights, terrain, foot), 1e-3) << place;
        }
        if (tick == 0) continue;
        const double moved = length(foot - vectorAt(joints, {tick - 1, agent, leg, bones}));
        if (stands && stance.at({tick - 1, agent, leg}) == 1) {
          ++standing;
          ASSERT_LT(moved, 1e-3) << place;
        } else if (!stands) {
          ++flying;
          ASSERT_GT(moved, 1e-3) << place;
        }
      }
  EXPECT_GT(standing, flying);
  EXPECT_GT(flying, 0u);
}

glm::dvec3 pointAt(const Npy& npy, const std::vector<uint64_t>& index) {
  const auto [x, y, z] = vectorAt(npy, index);
  return {x, y, z};
}

// The quaternion from `first` on under an index without its last axis.
glm::dquat turnAt(const Npy& npy, std::vector<uint64_t> index, uint64_t first) {
  double q[4];
  index.push_back(first);
  for (double& value : q) value = npy.at(index), ++index.back();
  return {q[3], q[0], q[1], q[2]};
}

// The spider's walk as its file has it: where the joints of all legs are at a time, and how bones are turned.
class Walk {
 public:
  static constexpr double seconds = 0.6;

  Walk() : pose_(readGlb(SKITTER_ROOT "/assets/spider.glb")) {
    for (int i = 0; i <= parts; ++i) table_.push_back(jointsAt(seconds * i / parts));
  }
  std::vector<glm::dvec3> jointsAt(double time) const {
    std::vector<glm::dvec3> joints;
    for (const char* leg : names)
      for (const char* joint : segments)
        joints.push_back(glm::dvec3(pose_.at("walk", std::string(leg) + joint, time)[3]));
    return joints;
  }
  glm::dmat3 turnAt(uint64_t leg, uint64_t bone, double time) const {
    return glm::dmat3(pose_.at("walk", std::string(names[leg]) + segments[bone], time));
  }
  // When the walk comes nearest to these joints.
  double timeOf(const std::vector<glm::dvec3>& joints) const {
    double nearest = HUGE_VAL, time = 0;
    for (int i = 0; i < parts; ++i) {
      double along = 0, length = 0;
      for (size_t j = 0; j < joints.size(); ++j) {
        const glm::dvec3 way = table_[i + 1][j] - table_[i][j];
        along += glm::dot(joints[j] - table_[i][j], way), length += glm::dot(way, way);
      }
      const double u = glm::clamp(along / length, 0.0, 1.0);
      double off = 0;
      for (size_t j = 0; j < joints.size(); ++j) {
        const glm::dvec3 apart = joints[j] - glm::mix(table_[i][j], table_[i + 1][j], u);
        off += glm::dot(apart, apart);
      }
      if (off < nearest) nearest = off, time = seconds * (i + u) / parts;
    }
    return time;
  }

 private:
  static constexpr int parts = 180;
  static constexpr const char* names[] = {"L1", "R1", "L2", "R2", "L3", "R3", "L4", "R4"};
  static constexpr const char* segments[] = {"_coxa", "_femur", "_tibia", "_tarsus", "_foot"};

  GltfPose pose_;
  std::vector<std::vector<glm::dvec3>> table_;
};

// On level ground a herd of controller clip has the legs of its model's file, turned and moved with the body.
// The clip runs on as the body does, and the body moves ahead.
TEST_F(Trace, ClipsAreThoseOfTheModel) {
  constexpr uint64_t ticks = 100, agents = 2, side = 41;
  writeBytes(file("flat_41x41.r32f"), r32f(std::vector<float>(side * side, 0.0f)));
  write("flat.json",
        R"({"terrain": {"kind": "file", "file": "flat_41x41.r32f", "spacingX": 1, "spacingZ": 1},
            "herds": [{"agents": 2, "controller": "clip", "clips": ["walk"], "goal": {"speed": 1}}]})");
  const Result result = skitter(
      {"run", file("flat.json"), "--headless", "--frames", std::to_string(ticks), "--trace", file("trace")});
  ASSERT_EQ(result.code, 0) << result.err;
  const Npy joints = readNpy(file("trace/herd0/joints.npy")),
            rotations = readNpy(file("trace/herd0/rotations.npy")),
            stance = readNpy(file("trace/herd0/stance.npy")), body = readNpy(file("trace/herd0/body.npy"));
  const Walk walk;
  // The bake may err by 1e-4 of a size of some 1.5 m, and linear play of the table above by a tenth of that.
  constexpr double allowed = 2e-4;
  double ground = 0;  // of the clip, which is taken off: the mean height of its feet, that roll on and off
  for (uint64_t agent = 0; agent < agents; ++agent) {
    double played = 0, gone = 0, before = 0;
    for (uint64_t tick = 0; tick < ticks; ++tick) {
      SCOPED_TRACE(testing::Message() << "tick " << tick << ", agent " << agent);
      const glm::dvec3 at = pointAt(body, {tick, agent});
      const glm::dquat turn = turnAt(body, {tick, agent}, 3);
      EXPECT_NEAR(at.y, 0, 1e-5);
      EXPECT_LT(glm::length(turn * glm::dvec3(0, 1, 0) - glm::dvec3(0, 1, 0)), 1e-5);
      std::vector<glm::dvec3> legsOf;
      for (uint64_t leg = 0; leg < legs; ++leg)
        for (uint64_t joint = 0; joint <= bones; ++joint)
          legsOf.push_back(glm::conjugate(turn) * (pointAt(joints, {tick, agent, leg, joint}) - at) +
                           glm::dvec3(0, ground, 0));
      double time = walk.timeOf(legsOf);
      if (agent == 0 && tick == 0) {
        for (int k = 0; k < 5; ++k) {
          const double lower = walk.jointsAt(time)[0].y - legsOf[0].y;
          for (glm::dvec3& joint : legsOf) joint.y += lower;
          ground += lower, time = walk.timeOf(legsOf);
        }
        EXPECT_NEAR(ground, 0, 2e-3);
      }
      if (tick > 0) {
        const glm::dvec3 way = at - pointAt(body, {tick - 1, agent}), ahead = turn * glm::dvec3(0, 0, 1);
        EXPECT_LT(glm::length(way - glm::dot(way, ahead) * ahead), 1e-2 * glm::length(way) + 1e-5);
        const glm::dquat turned = glm::conjugate(turnAt(body, {tick - 1, agent}, 3)) * turn;
        // Feet of a body that turns go further.
        if (std::abs(turned.y) < 1e-6) {
          played += time - before - Walk::seconds * std::round((time - before) / Walk::seconds);
          gone += glm::length(way);
        }
      }
      before = time;
      if (tick % 10 != 9) continue;
      const std::vector<glm::dvec3> exact = walk.jointsAt(time),
                                    past =
                                        walk.jointsAt(std::fmod(time + Walk::seconds - 0.02, Walk::seconds));
      for (uint64_t leg = 0; leg < legs; ++leg) {
        for (uint64_t joint = 0; joint <= bones; ++joint) {
          const size_t j = leg * (bones + 1) + joint;
          EXPECT_LT(glm::length(legsOf[j] - exact[j]), allowed) << "leg " << leg << ", joint " << joint;
          if (joint == bones) continue;
          const glm::dmat3 bone = glm::mat3_cast(turnAt(rotations, {tick, agent, leg, joint}, 0)),
                           own = glm::mat3_cast(turn) * walk.turnAt(leg, joint, time);
          for (int axis = 0; axis < 3; ++axis)
            EXPECT_LT(glm::length(bone[axis] - own[axis]), 5e-3) << "leg " << leg << ", bone " << joint;
        }
        // A foot lifts at a quarter of its range of 0.12 m.
        const double height = exact[leg * (bones + 1) + bones].y, sooner = past[leg * (bones + 1) + bones].y;
        if (height > 0.05) {
          EXPECT_EQ(stance.at({tick, agent, leg}), 0) << "leg " << leg;
        }
        if (std::max(height, sooner) < 0.002) {
          EXPECT_EQ(stance.at({tick, agent, leg}), 1) << "leg " << leg;
        }
      }
    }
    EXPECT_GT(gone, 0.5) << "agent " << agent;
    EXPECT_NEAR(played, gone, 0.01 * gone) << "agent " << agent;  // at 1 m/s
  }
}

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

// Each agent's bones are as long as those of its size, which the herd lists.
TEST_F(Trace, SizesAreListed) {
  write("sized.json", R"({"herds": [{"agents": 9, "sizes": [2, 0.5]}, {"agents": 2, "sizes": [3]}]})");
  const Result result =
      skitter({"run", file("sized.json"), "--headless", "--frames", "3", "--trace", file("trace")});
  ASSERT_EQ(result.code, 0) << result.err;
  const nlohmann::json herds = json("trace/trace.json").at("herds");
  EXPECT_FALSE(herds[1].contains("sizes"));
  EXPECT_NEAR(herds[1].at("legLength").get<double>(), 3, 1e-6);
  const nlohmann::json& herd = herds[0];
  const Npy joints = readNpy(file("trace/herd0/joints.npy"));
  uint64_t next = 0;
  ASSERT_EQ(herd.at("sizes").size(), 2u);
  for (const nlohmann::json& size : herd.at("sizes")) {
    EXPECT_EQ(size.at("firstAgent"), next);
    EXPECT_NEAR(size.at("legLength").get<double>(), size.at("size").get<double>(), 1e-6);
    EXPECT_NEAR(size.at("footprintRadius").get<double>() * herds[1].at("legLength").get<double>(),
                herds[1].at("footprintRadius").get<double>() * size.at("legLength").get<double>(), 1e-5);
    EXPECT_GT(size.at("footprintRadius").get<double>(), 0.1 * size.at("legLength").get<double>());
    const double larger = size.at("size").get<double>() / 2;
    for (const uint64_t end = next + size.at("agents").get<uint64_t>(); next < end; ++next) {
      double length = 0;
      for (uint64_t k = 0; k < 3; ++k) {
        const double along = double{joints.at({2, next, 0, 1, k})} - double{joints.at({2, next, 0, 0, k})};
        length += along * along;
      }
      EXPECT_NEAR(std::sqrt(length), larger * herd.at("boneLengths")[0][0].get<double>(), 1e-4) << next;
    }
  }
  EXPECT_EQ(next, 9u);
}

// By tick, as the events of a scene have it.
TEST_F(Trace, LegsThatAreHurtAreListed) {
  write("hurt.json", R"({"herds": [{"agents": 3, "hurt": true}, {"agents": 1}], "events": [
    {"at": 0.1, "agents": [2], "leg": "R2"},
    {"at": 0.1, "agents": [1], "leg": "L1", "state": "stuck"},
    {"at": 0.2, "agents": [2], "leg": "R2", "state": "whole"}
  ]})");
  const Result result =
      skitter({"run", file("hurt.json"), "--headless", "--frames", "20", "--trace", file("trace")});
  ASSERT_EQ(result.code, 0) << result.err;
  const auto herds = json("trace/trace.json").at("herds");
  EXPECT_EQ(herds.at(0).at("hurt"), nlohmann::json::parse(R"([
    {"tick": 6, "agent": 1, "leg": "L1", "state": "stuck"},
    {"tick": 6, "agent": 2, "leg": "R2", "state": "lost", "bone": 1},
    {"tick": 12, "agent": 2, "leg": "R2", "state": "whole"}
  ])"));
  EXPECT_FALSE(herds.at(1).contains("hurt"));
}

TEST_F(Trace, LoadsAreListed) {
  write("loads.json", R"({"herds": [{"agents": 3, "hurt": true}, {"agents": 1, "hurt": true}], "events": [
    {"at": 0.1, "agents": [2], "load": {"mass": 0.5, "offset": [0, 0.25, -0.5]}},
    {"at": 0.15, "agents": [0], "load": {"mass": 2}},
    {"at": 0.2, "agents": [2], "load": {}}
  ]})");
  const Result result =
      skitter({"run", file("loads.json"), "--headless", "--frames", "20", "--trace", file("trace")});
  ASSERT_EQ(result.code, 0) << result.err;
  const auto herds = json("trace/trace.json").at("herds");
  EXPECT_EQ(herds.at(0).at("loads"), nlohmann::json::parse(R"([
    {"tick": 6, "agent": 2, "mass": 0.5, "offset": [0, 0.25, -0.5]},
    {"tick": 9, "agent": 0, "mass": 2, "offset": [0, 0, 0]},
    {"tick": 12, "agent": 2, "mass": 0, "offset": [0, 0, 0]}
  ])"));
  EXPECT_FALSE(herds.at(0).contains("hurt"));
  EXPECT_FALSE(herds.at(1).contains("loads"));
}

TEST_F(Trace, NoTicksAreNoEntries) {
  ASSERT_EQ(skitter({"run", "--headless", "--agents", "2", "--frames", "0", "--trace", file("trace")}).code,
            0);
  EXPECT_EQ(readNpy(file("trace/herd0/body.npy")).shape, (Shape{0, 2, 7}));
  EXPECT_EQ(json("trace/trace.json").at("ticks"), 0);
}

}  // namespace
}  // namespace skitter::test
