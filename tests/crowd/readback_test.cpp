// Positions that arrive later, and picking among them.
#include "skitter/readback.h"

#include <gmock/gmock.h>

#include "crowd/simulation.h"
#include "gpu/barrier.h"
#include "gpu/submit.h"
#include "skitter/error.h"

namespace skitter::test {
namespace {

using ReadbackTest = GpuTest;

// Three kinds, nobody in one herd, two sizes in one, pages that end within herds; no two agents touch.
Scene herdsToRead() {
  Scene scene = sceneOf(5);
  scene.herds[0].spawn = {.kind = Spawn::Kind::grid, .spacing = 3, .centre = {-30, 0}};
  scene.herds.resize(4, scene.herds[0]);
  scene.herds[1].agents = 0;
  scene.herds[2].agents = 37;
  scene.herds[2].spawn.centre = {0, 20};
  scene.herds[2].sizes = {0.6f, 1};
  scene.herds[3].spawn.centre = {30, 0};
  scene.herds[3].controller = Controller::loop;
  return scene;
}
const CrowdOptions inPages{.measure = false, .pageAgents = 24};

TEST_F(ReadbackTest, HoldsTheBodiesOfItsTick) {
  Crowd crowd(device(), rollingGround(), herdsToRead(), inPages);
  Crowd same(device(), rollingGround(), herdsToRead(), inPages);
  Readback readback(device(), crowd);
  EXPECT_FALSE(readback.latest());
  std::vector<std::vector<std::vector<float>>> history(1);  // by tick and herd
  gpu::CommandRing ring(context(), 2);
  uint64_t last = 0, arrived = 0;
  const auto look = [&] {
    const std::optional<Snapshot> snapshot = readback.latest();
    if (!snapshot) return;
    EXPECT_GE(snapshot->tick(), last);
    EXPECT_LE(snapshot->tick(), crowd.tick());
    arrived += snapshot->tick() > last;
    last = snapshot->tick();
    for (uint32_t herd = 0; herd < crowd.herdCount(); ++herd) {
      const std::span<const float> bodies = snapshot->bodies(herd);
      ASSERT_EQ(std::vector<float>(bodies.begin(), bodies.end()), history.at(last).at(herd))
          << "tick " << last << " herd " << herd;
    }
  };
  for (int i = 0; i < 30; ++i) {
    simulate(device(), same, 1);
    auto& now = history.emplace_back();
    for (uint32_t herd = 0; herd < same.herdCount(); ++herd) now.push_back(same.download(herd).body);
    const vk::CommandBuffer cmd = ring.begin();
    look();
    crowd.record(cmd, kTick);
    readback.record(cmd);
    ring.submit();
    look();
  }
  ring.waitAll();
  look();
  EXPECT_EQ(last, 30u);
  EXPECT_GT(arrived, 10u);
  EXPECT_EQ(readback.skipped(), 0u);
  EXPECT_EQ(crowd.stateHash(), same.stateHash());
}

// What is on its way is waited for by nobody.
TEST_F(ReadbackTest, SkipsTicksWhenEverySlotIsOnItsWay) {
  Crowd crowd(device(), rollingGround(), sceneOf(9), inPages);
  Readback readback(device(), crowd, {.slots = 3});
  gpu::CommandRing ring(context(), 2);
  const vk::CommandBuffer cmd = ring.begin();
  for (int i = 0; i < 5; ++i) {
    crowd.record(cmd, kTick);
    readback.record(cmd);
  }
  EXPECT_FALSE(readback.latest());
  EXPECT_EQ(readback.skipped(), 2u);
  ring.submit();
  ring.waitAll();
  ASSERT_TRUE(readback.latest());
  EXPECT_EQ(readback.latest()->tick(), 3u);
  // The newest stays as it is while others are on their way.
  const vk::CommandBuffer next = ring.begin();
  for (int i = 0; i < 3; ++i) {
    crowd.record(next, kTick);
    readback.record(next);
  }
  EXPECT_EQ(readback.skipped(), 3u);
  EXPECT_EQ(readback.latest()->tick(), 3u);
  ring.submit();
  ring.waitAll();
  EXPECT_EQ(readback.latest()->tick(), 7u);
}

TEST_F(ReadbackTest, ReadsTheHerdsThatAreNamed) {
  const Scene scene = herdsToRead();
  Crowd crowd(device(), rollingGround(), scene, inPages);
  Readback readback(device(), crowd, {.herds = {3, 0}});
  gpu::submitAndWait(context(), [&](vk::CommandBuffer cmd) {
    crowd.record(cmd, kTick);
    readback.record(cmd);
  });
  const Snapshot snapshot = readback.latest().value();
  for (const uint32_t herd : {1u, 2u, 99u}) {
    EXPECT_EQ(snapshot.agents(herd), 0u);
    EXPECT_TRUE(snapshot.bodies(herd).empty());
    EXPECT_FALSE(snapshot.bounds(herd));
  }
  const glm::dvec3 origin(3.5, -1, 12.25);
  for (const uint32_t herd : {0u, 3u}) {
    ASSERT_EQ(snapshot.agents(herd), scene.herds[herd].agents);
    const HerdState state = crowd.download(herd);
    const Box box = snapshot.bounds(herd, origin).value();
    glm::dvec3 least(1e9), most(-1e9);
    for (uint32_t agent = 0; agent < snapshot.agents(herd); ++agent) {
      const glm::dvec3 place = positionOf(state, agent) - origin;
      EXPECT_LT(glm::distance(snapshot.body(herd, agent, origin).position, place), 1e-9);
      least = glm::min(least, place), most = glm::max(most, place);
    }
    // A leg's reach and more about the outermost.
    for (int i = 0; i < 3; ++i) {
      EXPECT_LT(box.least[i], least[i] - 1) << i;
      EXPECT_GT(box.most[i], most[i] + 1) << i;
      EXPECT_NEAR(box.most[i] - box.least[i], most[i] - least[i], 4) << i;
    }
  }
}

TEST_F(ReadbackTest, RefusesWhatCannotBe) {
  Crowd crowd(device(), rollingGround(), herdsToRead(), inPages);
  const auto expectRefused = [&](const ReadbackOptions& wanted, const std::string& message) {
    try {
      Readback(device(), crowd, wanted);
      ADD_FAILURE() << "taken: " << message;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), Error::Kind::input);
      EXPECT_THAT(error.what(), testing::HasSubstr(message));
    }
  };
  expectRefused({.slots = 1}, "readback: 1 slots, expected at least 2");
  expectRefused({.herds = {2, 0, 2}}, "readback: herd 2 is named twice");
}

TEST_F(ReadbackTest, OfAHerdThatIsGoneIsRefused) {
  Scene scene = herdsToRead();
  scene.events = {{2 * kTick, HerdRemoval{3}}};
  Crowd crowd(device(), rollingGround(), scene, inPages);
  Readback all(device(), crowd), first(device(), crowd, {.herds = {0}});
  const auto tick = [&](Readback& readback) -> std::string {
    std::string fault = "taken";
    gpu::submitAndWait(context(), [&](vk::CommandBuffer cmd) {
      crowd.record(cmd, kTick);
      try {
        readback.record(cmd);
      } catch (const Error& error) {
        fault = error.what();
      }
    });
    return fault;
  };
  EXPECT_EQ(tick(all), "taken");
  EXPECT_EQ(tick(all), "readback: herd 3 was removed, expected it to be there for as long as it is read");
  EXPECT_EQ(tick(first), "taken");
  // Another one of its number is not the one that is read.
  crowd.addHerd(scene.herds[0]);
  EXPECT_THAT(tick(all), testing::HasSubstr("herd 3 was removed"));
  crowd.removeHerd(crowd.herdId(3));
  Readback rest(device(), crowd);
  EXPECT_EQ(tick(rest), "taken");
  EXPECT_EQ(rest.latest()->agents(2), 37u);
  EXPECT_EQ(rest.latest()->agents(3), 0u);
  EXPECT_THROW(Readback(device(), crowd, {.herds = {3}}), Error);
}

// From straight above each agent, from aside, and where nobody is.
TEST_F(ReadbackTest, PicksTheAgentUnderTheRay) {
  Crowd crowd(device(), rollingGround(), herdsToRead(), inPages);
  Readback readback(device(), crowd);
  for (int i = 0; i < 20; ++i)
    gpu::submitAndWait(context(), [&](vk::CommandBuffer cmd) {
      crowd.record(cmd, kTick);
      readback.record(cmd);
    });
  const Snapshot snapshot = readback.latest().value();
  ASSERT_EQ(snapshot.tick(), crowd.tick());
  const glm::dvec3 origin(-8.5, 2, 31);
  for (const uint32_t herd : {0u, 2u, 3u})
    for (uint32_t agent = 0; agent < snapshot.agents(herd); ++agent) {
      const Rig& rig = crowd.rig(herd, agent);
      const double radius = std::max(rig.bodyRadius, rig.bodyHeight);
      const BodyState body = snapshot.body(herd, agent, origin);
      const glm::dvec3 middle = body.position + glm::dvec3(body.rotation * glm::vec3(0, rig.bodyHeight, 0));
      const glm::dvec3 beside = 0.9 * radius * glm::dvec3(1, 0, 0);
      for (const Ray& ray : {Ray{middle + glm::dvec3(0, 50, 0), {0, -3, 0}},
                             Ray{middle + beside + glm::dvec3(0, 50, 0), {0, -1, 0}}}) {
        const std::optional<Picked> picked = crowd.pick(ray, origin), read = snapshot.pick(ray, origin);
        ASSERT_TRUE(picked && read);
        EXPECT_EQ(picked->herd, herd);
        EXPECT_EQ(picked->agent, agent);
        EXPECT_NEAR(glm::distance(picked->place, middle), radius, 1e-6);
        EXPECT_NEAR(glm::distance(picked->place, ray.start), picked->distance, 1e-9);
        EXPECT_EQ(read->agent, agent);
        EXPECT_EQ(read->distance, picked->distance);
        EXPECT_FALSE(snapshot.pick({ray.start, ray.direction, 40}, origin));
        EXPECT_FALSE(snapshot.pick({ray.start, -ray.direction}, origin));
      }
      const glm::dvec3 point = middle + glm::dvec3(0.1, 0.05, -0.1);
      EXPECT_EQ(crowd.nearest(point, origin)->agent, agent);
      EXPECT_EQ(snapshot.nearest(point, origin)->herd, herd);
      EXPECT_NEAR(snapshot.nearest(point, origin)->distance, 0.15, 1e-9);
    }
  // Through two agents: the nearer one.
  const Rig& rig = crowd.rig(0);
  const glm::dvec3 first = snapshot.body(0, 0).position, second = snapshot.body(0, 1).position;
  const glm::dvec3 start = first + 3.0 * (first - second) + glm::dvec3(0, rig.bodyHeight, 0);
  EXPECT_EQ(snapshot.pick({start, second - first})->agent, 0u);
  EXPECT_EQ(snapshot.pick({first + glm::dvec3(0, rig.bodyHeight, 0), {0, 1, 0}})->distance, 0);
  EXPECT_FALSE(snapshot.pick({{0, 200, 0}, {1, 0, 0}}));
}

TEST_F(ReadbackTest, PicksNobodyWhereNobodyIs) {
  // In an empty place.
  Crowd one(device(), flatGround(), sceneOf(1), inPages);
  Readback readback(device(), one);
  const RecordBuffer bodies = one.buffers(0, Record::body).at(0);
  gpu::submitAndWait(context(), [&](vk::CommandBuffer cmd) {
    one.record(cmd, kTick);
    const float empty = 1;
    cmd.updateBuffer(bodies.buffer, 16 + 12, sizeof empty, &empty);
    gpu::transferToTransfer(cmd);
    readback.record(cmd);
  });
  EXPECT_FALSE(readback.latest()->body(0, 0).present);
  EXPECT_FALSE(readback.latest()->nearest({0, 0, 0}));
  EXPECT_FALSE(readback.latest()->bounds(0));
  EXPECT_FALSE(one.nearest({0, 0, 0}));
  // In a herd without agents.
  const Crowd crowd(device(), rollingGround(), sceneOf(0), inPages);
  EXPECT_FALSE(crowd.pick({{0, 50, 0}, {0, -1, 0}}));
  EXPECT_FALSE(crowd.nearest({0, 0, 0}));
}

}  // namespace
}  // namespace skitter::test
