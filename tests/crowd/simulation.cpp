#include "crowd/simulation.h"

#include <algorithm>
#include <cstring>
#include <memory>

#include "crowd/herd.h"
#include "crowd/readback.h"
#include "gpu/submit.h"
#include "validation/herd_facts.h"

namespace skitter::test {

Scene sceneOf(uint32_t agents, float speed, uint64_t seed, Controller controller) {
  Scene scene;
  scene.herds = {Herd{}};
  scene.herds[0].agents = agents;
  scene.herds[0].controller = controller;
  scene.herds[0].goal.speed = speed;
  scene.seed = seed;
  return scene;
}

Scene hurtScene(uint32_t agents, Controller controller) {
  Scene scene = sceneOf(agents, 1, 1, controller);
  scene.herds[0].hurt = true;
  return scene;
}

Heightfield rollingGround() { return generateHeightfield({}); }

Heightfield smallRollingGround() {
  return generateHeightfield({.columns = 65, .rows = 65, .amplitude = 2, .wavelength = 16});
}

Heightfield flatGround() {
  Heightfield flat = generateHeightfield({.columns = 129, .rows = 129});
  std::fill(flat.heights.begin(), flat.heights.end(), 0.0f);
  return flat;
}

Heightfield cliffGround() {
  Heightfield cliff = flatGround();
  for (uint32_t row = cliff.rows / 4; row < cliff.rows; ++row)
    for (uint32_t column = 0; column < cliff.columns; ++column)
      cliff.heights[row * cliff.columns + column] = -6;
  return cliff;
}

Rig scaledSpider(float legLength) {
  Rig rig = spiderRig();
  for (Leg& leg : rig.legs) {
    leg.home *= legLength;
    leg.reach *= legLength;
    for (Bone& bone : leg.bones) {
      bone.start *= legLength;
      bone.length *= legLength;
    }
  }
  rig.legLength *= legLength;
  rig.bodyHeight *= legLength;
  rig.bodyRadius *= legLength;
  rig.vertices.clear();
  rig.indices.clear();
  return rig;
}

std::string testNameOf(Controller controller) {
  std::string name = nameOf(controller);
  std::erase(name, '-');
  return name;
}

void simulate(Device& device, Crowd& crowd, int ticks, float dt) {
  gpu::CommandRing ring(device.context());
  for (int i = 0; i < ticks; ++i) {
    crowd.record(ring.begin(), dt);
    ring.submit();
  }
  ring.waitAll();
}

std::vector<validation::StageResult> replay(Device& device, Crowd& crowd, const validation::HerdFacts& facts,
                                            int ticks, float dt) {
  validation::Replay replay(facts);
  HerdState before = crowd.download(0);
  for (int i = 0; i < ticks && !replay.hasRefused(); ++i) {
    const validation::Surroundings around = validation::surroundingsOf(implOf(crowd));
    simulate(device, crowd, 1, dt);
    HerdState after = crowd.download(0);
    replay.tick(crowd.tick(), before, after, around);
    before = std::move(after);
  }
  return replay.results();
}

std::vector<std::vector<validation::StageResult>> replayAll(Device& device, Crowd& crowd,
                                                            const Heightfield& terrain, int ticks, float dt) {
  // The first tick fixes dt, and with it the tuning that the reference is given.
  if (crowd.tick() == 0) simulate(device, crowd, 1, dt);
  std::vector<std::unique_ptr<validation::Replay>> replays;
  const Crowd::Impl& impl = implOf(crowd);
  const std::vector<crowd::HerdRun> runs = crowd::allRuns(impl);
  std::vector<HerdState> before = crowd::download(impl, runs);
  for (const crowd::HerdRun& of : runs)
    replays.push_back(std::make_unique<validation::Replay>(validation::herdFacts(impl, of, terrain)));
  const auto hasRefused = [](const auto& replay) { return replay->hasRefused(); };
  for (int i = 0; i < ticks && std::ranges::none_of(replays, hasRefused); ++i) {
    const validation::Surroundings around = validation::surroundingsOf(impl);
    simulate(device, crowd, 1, dt);
    std::vector<HerdState> after = crowd::download(impl, runs);
    for (size_t r = 0; r < runs.size(); ++r) replays[r]->tick(crowd.tick(), before[r], after[r], around);
    before = std::move(after);
  }
  std::vector<std::vector<validation::StageResult>> results;
  for (const auto& replay : replays) results.push_back(replay->results());
  return results;
}

std::vector<validation::StageResult> replay(Device& device, Crowd& crowd, const Heightfield& terrain,
                                            int ticks, float dt) {
  return replayAll(device, crowd, terrain, ticks, dt).front();
}

void expectAllPass(const std::vector<validation::StageResult>& results) {
  for (const validation::StageResult& stage : results)
    EXPECT_TRUE(stage.pass) << stage.name << ": " << stage.why;
}

void expectBeganAlike(const Crowd& anew, const Crowd& began) {
  const Controller controller = implOf(began).kindOf(0).controller;
  if (controller == Controller::clip || controller == Controller::keyPoses) {
    EXPECT_EQ(anew.stateHash(), began.stateHash());
    return;
  }
  const HerdState ours = anew.download(0), theirs = began.download(0);
  EXPECT_EQ(ours.goal, theirs.goal);
  EXPECT_EQ(ours.gait, theirs.gait);
  const double leg = began.rig(0).legLength;
  const size_t legs = began.rig(0).legs.size();
  for (size_t i = 0; i < theirs.agents; ++i) {
    EXPECT_LT(glm::distance(positionOf(ours, i), positionOf(theirs, i)), 0.01 * leg) << "agent " << i;
    const float* heading = &theirs.body[4 * (shared::BODY_STRIDE * i + 1)];
    EXPECT_TRUE(std::equal(heading, heading + 2, &ours.body[4 * (shared::BODY_STRIDE * i + 1)]))
        << "agent " << i;
    for (size_t l = 0; l < legs; ++l) {
      const size_t at = 4 * (legs * i + l);
      const glm::vec3 a(ours.tip[at], ours.tip[at + 1], ours.tip[at + 2]);
      const glm::vec3 b(theirs.tip[at], theirs.tip[at + 1], theirs.tip[at + 2]);
      EXPECT_LT(glm::distance(a, b), 0.01 * leg) << "agent " << i << ", leg " << l;
    }
  }
}

glm::dvec3 positionOf(const HerdState& state, size_t agent) {
  const float* b = state.body.data() + agent * shared::BODY_STRIDE * 4;
  return {double{shared::tileX(b[3])} * shared::TILE_SIZE + b[0], b[1],
          double{shared::tileZ(b[3])} * shared::TILE_SIZE + b[2]};
}

bool plantedOf(const HerdState& state, size_t leg) { return state.foot.at(leg * 4 + 3) >= 1; }

bool sameBits(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

}  // namespace skitter::test
