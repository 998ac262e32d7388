#include "skitter/readback.h"

#include <limits>
#include <utility>

#include "public/public.h"

namespace skitter::test {
namespace {

using PublicReadback = PublicTest;

TEST_F(PublicReadback, TellsWhereAgentsAre) {
  Scene scene = standingScene(4);
  scene.herds.push_back(scene.herds[0]);
  Crowd crowd(device(), flatGround(), scene);
  Readback first(device(), crowd, {.herds = {1}});
  Readback readback = std::move(first);
  EXPECT_FALSE(readback.latest());
  device().run([&](VkCommandBuffer commands) {
    crowd.record(commands, tickSeconds);
    readback.record(commands);
  });
  EXPECT_EQ(readback.skipped(), 0u);
  const Snapshot snapshot = readback.latest().value();
  EXPECT_EQ(snapshot.tick(), 1u);
  EXPECT_EQ(snapshot.agents(1), 4u);
  EXPECT_EQ(snapshot.agents(0), 0u);
  EXPECT_EQ(snapshot.agents(7), 0u);
  const HerdState state = crowd.download(1);
  EXPECT_EQ(std::vector(snapshot.bodies(1).begin(), snapshot.bodies(1).end()), state.body);
  EXPECT_TRUE(snapshot.bodies(0).empty());
  const glm::dvec3 origin(1, 2, 3);
  const BodyState body = snapshot.body(1, 2, origin);
  EXPECT_EQ(body.position, snapshot.body(1, 2).position - origin);
  const Box box = snapshot.bounds(1, origin).value();
  for (int i = 0; i < 3; ++i) {
    EXPECT_LT(box.least[i], body.position[i]);
    EXPECT_GT(box.most[i], body.position[i]);
  }
  EXPECT_FALSE(snapshot.bounds(0));
  expectRefused("readback: herd 1, agent 4: expected one of the 4", [&] { snapshot.body(1, 4); });
  expectRefused("readback: herd 0, agent 0", [&] { snapshot.body(0, 0); });
  expectRefused("readback: herd 7, agent 0", [&] { snapshot.body(7, 0); });
}

TEST_F(PublicReadback, PicksAsTheCrowdDoes) {
  Crowd crowd(device(), flatGround(), standingScene(4));
  Readback readback(device(), crowd);
  device().run([&](VkCommandBuffer commands) {
    crowd.record(commands, tickSeconds);
    readback.record(commands);
  });
  const Snapshot snapshot = readback.latest().value();
  const glm::dvec3 above = snapshot.body(0, 3).position + glm::dvec3(0, 10, 0);
  const Ray down{.start = above, .direction = {0, -2, 0}};
  EXPECT_EQ(snapshot.pick(down).value().agent, 3u);
  EXPECT_EQ(snapshot.pick(down)->distance, crowd.pick(down)->distance);
  EXPECT_EQ(snapshot.nearest(above).value().agent, 3u);
  EXPECT_EQ(snapshot.nearest(above)->place, crowd.nearest(above)->place);
  EXPECT_FALSE(snapshot.pick({.start = above, .direction = {0, 1, 0}}));
  expectRefused("the ray's direction is (0, 0, 0)", [&] { snapshot.pick({.direction = glm::dvec3(0)}); });
}

TEST_F(PublicReadback, RefusesWhatCannotBe) {
  Scene scene = standingScene(4);
  scene.herds.push_back(scene.herds[0]);
  scene.herds[1].controller = Controller::loop;
  Crowd crowd(device(), flatGround(), scene);
  expectRefused("readback: 1 slots, expected at least 2", [&] { Readback(device(), crowd, {.slots = 1}); });
  expectRefused("readback: herd 0 is named twice", [&] { Readback(device(), crowd, {.herds = {0, 0}}); });
  expectRefused("herd 7: expected one of the crowd's 2", [&] { Readback(device(), crowd, {.herds = {7}}); });
  Readback readback(device(), crowd);
  crowd.removeHerd(crowd.herdId(1));
  device().run([&](VkCommandBuffer commands) {
    expectRefused("readback: herd 1 was removed", [&] { readback.record(commands); });
  });
}

}  // namespace
}  // namespace skitter::test
