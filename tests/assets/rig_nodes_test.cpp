// Where a rig has its legs, worked out anew from the model's nodes and from what the sidecar or the extras
// say.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <map>

#include "glb_builder.h"
#include "skitter/rig.h"

namespace skitter {
namespace {

using Json = nlohmann::json;

const std::string assets = SKITTER_ROOT "/assets/";

glm::dvec3 vectorOf(const Json& from) { return {from[0], from[1], from[2]}; }

glm::dmat4 localOf(const Json& node) {
  glm::dmat4 m(1);
  if (node.contains("translation")) m = glm::translate(m, vectorOf(node["translation"]));
  if (node.contains("rotation")) {
    const Json& q = node["rotation"];
    m *= glm::mat4_cast(glm::dquat(q[3], q[0], q[1], q[2]));
  }
  if (node.contains("scale")) m = glm::scale(m, vectorOf(node["scale"]));
  return m;
}

// Where every named node is, in the model's own units.
std::map<std::string, glm::dvec3> placesOf(const std::string& file) {
  const Json nodes = test::readGlb(file).json["nodes"];
  std::map<size_t, size_t> parents;
  for (size_t i = 0; i < nodes.size(); ++i)
    for (const Json& child : nodes[i].value("children", Json::array())) parents[child] = i;
  std::map<std::string, glm::dvec3> places;
  for (size_t i = 0; i < nodes.size(); ++i) {
    glm::dmat4 world = localOf(nodes[i]);
    for (auto parent = parents.find(i); parent != parents.end(); parent = parents.find(parent->second))
      world = localOf(nodes[parent->second]) * world;
    places[nodes[i].value("name", "")] = world[3];
  }
  return places;
}

// `setup` as in docs/rig.md; a point x of the model lies at scale (x - origin).
void expectLegs(const Rig& rig, const Json& setup, const std::map<std::string, glm::dvec3>& places,
                const glm::dvec3& origin, double scale) {
  const auto place = [&](const glm::dvec3& x) { return scale * (x - origin); };
  const auto near = [](const glm::dvec3& got, const glm::dvec3& expected) {
    return glm::distance(got, expected) < 1e-6;
  };
  ASSERT_EQ(rig.groups, setup["groups"].get<std::vector<std::string>>());
  ASSERT_EQ(rig.legs.size(), setup["legs"].size());
  EXPECT_NEAR(rig.bodyHeight, scale * setup["bodyHeight"].get<double>(), 1e-6);
  EXPECT_NEAR(rig.bodyRadius, scale * setup["bodyRadius"].get<double>(), 1e-6);
  double longest = 0;
  for (size_t l = 0; l < rig.legs.size(); ++l) {
    const Leg& leg = rig.legs[l];
    const Json& from = setup["legs"][l];
    SCOPED_TRACE(leg.name);
    EXPECT_EQ(leg.name, from["name"]);
    EXPECT_EQ(rig.groups.at(static_cast<size_t>(leg.group)), from["group"]);
    const auto joints = from["joints"].get<std::vector<std::string>>();
    ASSERT_EQ(leg.bones.size() + 1, joints.size());
    double reach = 0;
    for (size_t b = 0; b < leg.bones.size(); ++b) {
      const glm::dvec3 start = place(places.at(joints[b])), end = place(places.at(joints[b + 1]));
      EXPECT_TRUE(near(leg.bones[b].start, start)) << joints[b];
      EXPECT_TRUE(near(leg.bones[b].direction, glm::normalize(end - start))) << joints[b];
      EXPECT_NEAR(leg.bones[b].length, glm::distance(start, end), 1e-6) << joints[b];
      EXPECT_NEAR(leg.bones[b].coneHalfAngle, glm::radians(from["coneHalfAngleDegrees"][b].get<double>()),
                  1e-6);
      reach += glm::distance(start, end);
    }
    EXPECT_NEAR(leg.reach, reach, 1e-6);
    longest = std::max(longest, reach);
    const glm::dvec3 foot = place(places.at(joints.back()));
    EXPECT_TRUE(near(leg.home,
                     from.contains("home") ? place(vectorOf(from["home"])) : glm::dvec3(foot.x, 0, foot.z)));
  }
  EXPECT_NEAR(rig.legLength, longest, 1e-6);
}

TEST(RigNodes, OfTheSpider) {
  const Json setup = test::readGlb(assets + "spider.glb").json["scenes"][0]["extras"]["skitter"];
  expectLegs(spiderRig(), setup, placesOf(assets + "spider.glb"), glm::dvec3(0), 1);
}

// Its sidecar has a scale, an origin and homes of its own.
TEST(RigNodes, OfTheQuadruped) {
  std::ifstream file(assets + "quadruped.rig.json");
  const Json setup = Json::parse(file);
  const std::map<std::string, glm::dvec3> places = placesOf(assets + "quadruped.glb");
  double longest = 0;
  for (const Json& leg : setup["legs"]) {
    double reach = 0;
    for (size_t b = 0; b + 1 < leg["joints"].size(); ++b)
      reach += glm::distance(places.at(leg["joints"][b]), places.at(leg["joints"][b + 1]));
    longest = std::max(longest, reach);
  }
  const double scale = setup["legLength"].get<double>() / longest;
  expectLegs(loadRig(assets + "quadruped.rig.json"), setup, places, vectorOf(setup["origin"]), scale);
}

}  // namespace
}  // namespace skitter
