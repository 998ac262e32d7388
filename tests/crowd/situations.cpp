#include "crowd/situations.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include "crowd/changes.h"
#include "crowd/herd.h"
#include "gpu/transfer.h"
#include "validation/herd_facts.h"

namespace skitter::test {
namespace {

using Results = std::vector<validation::StageResult>;

// Calls `change` with the number and the floats of every record of a buffer.
void forEachRecord(const Device& device, const gpu::Buffer& buffer, int stride,
                   const std::function<void(size_t, float*)>& change) {
  const gpu::Context& context = device.context();
  std::vector<float> floats = gpu::download<float>(context, buffer);
  const auto each = static_cast<size_t>(stride) * 4;
  for (size_t record = 0; record * each < floats.size(); ++record) change(record, &floats[record * each]);
  gpu::upload(context, buffer, floats);
}

crowd::Kind& kindOf(Crowd& crowd) { return implOf(crowd).kindOf(0); }
const crowd::Page& pageOf(Crowd& crowd) { return kindOf(crowd).pages.at(0); }

void setGoals(const Device& device, Crowd& crowd, const std::function<void(size_t, float*)>& change) {
  forEachRecord(device, pageOf(crowd).goal, shared::GOAL_STRIDE, change);
}

void raiseAll(Crowd& crowd, float by) {
  std::vector<float> heights = crowd.terrain().heights;
  for (float& height : heights) height += by;
  crowd.editHeights(0, 0, crowd.terrain().columns, crowd.terrain().rows, heights);
}

// Agents in rows around one place, who walk to it and keep clear of each other.
Scene gathering(Controller controller, float spacing) {
  Scene scene = sceneOf(49, 1, 1, controller);
  scene.herds[0].avoid = true;
  scene.herds[0].spawn = {.kind = Spawn::Kind::grid, .spacing = spacing};
  scene.herds[0].goal = {.kind = Goal::Kind::point, .target = {0.3f, 0.2f}};
  return scene;
}

Results meeting(Device& device, Controller controller, const CrowdOptions& options) {
  const Heightfield ground = smallRollingGround();
  Crowd crowd(device, ground, gathering(controller, 1.4f), options);
  simulate(device, crowd, 20);
  return replay(device, crowd, ground, 200);
}

// Small ones meet large ones, of whom they keep as far as they look, which is less than the room of both.
Results meetingLarge(Device& device, Controller controller, const CrowdOptions& options) {
  const Heightfield ground = smallRollingGround();
  Scene scene = sceneOf(25, 1, 1, controller);
  scene.herds[0].avoid = true;
  scene.herds[0].spawn = {.kind = Spawn::Kind::grid, .spacing = 1, .centre = {0, -5}};
  scene.herds[0].goal = {.kind = Goal::Kind::velocity, .velocity = {0, 1}};
  scene.herds.push_back(scene.herds[0]);
  scene.herds[0].sizes = {0.5f};
  scene.herds[1].sizes = {2};
  scene.herds[1].agents = 4;
  scene.herds[1].spawn = {.kind = Spawn::Kind::grid, .spacing = 4, .centre = {0, 4}};
  scene.herds[1].goal.velocity = {0, -1};
  Crowd crowd(device, ground, scene, options);
  return replay(device, crowd, ground, 200);
}

// They begin so close that nothing but their cells keeps them apart.
Results crowding(Device& device, Controller controller, const CrowdOptions& options) {
  const Heightfield ground = smallRollingGround();
  Crowd crowd(device, ground, gathering(controller, 0.7f), options);
  return replay(device, crowd, ground, 100);
}

Results partingFrom(Device& device, Controller controller, const CrowdOptions& options, uint32_t agents,
                    const Spawn& spawn, uint64_t ticks) {
  const Heightfield ground = smallRollingGround();
  Scene scene = sceneOf(agents, 1, 1, controller);
  scene.herds[0].avoid = true;
  scene.herds[0].spawn = spawn;
  scene.herds[0].goal = {.kind = Goal::Kind::none};
  Crowd crowd(device, ground, scene, options);
  return replay(device, crowd, ground, ticks);
}

// Agents begin in each other, and part.
Results parting(Device& device, Controller controller, const CrowdOptions& options) {
  return partingFrom(device, controller, options, 25, {.kind = Spawn::Kind::grid, .spacing = 0.4f}, 100);
}

// They are whole quanta from each other, many of them equally far: numbers say who is nearer. The middle of
// the ground is a corner of cells, of whose agents those of lesser numbers come first anyway.
Results ranking(Device& device, Controller controller, const CrowdOptions& options) {
  const Spawn spawn{.kind = Spawn::Kind::grid, .spacing = 0.15625f, .centre = {-15, 0}};
  return partingFrom(device, controller, options, 49, spawn, 5);
}

// They are more, near each other, than keys tell apart.
Results packing(Device& device, Controller controller, const CrowdOptions& options) {
  return partingFrom(device, controller, options, 144, {.kind = Spawn::Kind::grid, .spacing = 0.163f}, 5);
}

// Pairs walk at each other, a little beside or straight, so that a rule and not their places says on which
// side they pass.
Results facing(Device& device, Controller controller, const CrowdOptions& options) {
  constexpr uint32_t agents = 12;
  const Heightfield ground = smallRollingGround();
  Scene scene = sceneOf(agents, 1, 1, controller);
  scene.herds[0].avoid = true;
  Crowd crowd(device, ground, scene, options);
  std::vector<AgentPlace> places;
  std::vector<AgentGoal> goals;
  for (uint32_t i = 0; i < agents; ++i) {
    const float side = i % 2 == 0 ? 1.0f : -1.0f, beside = 0.02f * (static_cast<float>(i / 2) - 2.5f);
    const float x = 4 * static_cast<float>(i / 2) - 10 + side * beside;
    const AgentId agent = crowd.agentId(0, i);
    places.push_back({agent, {{x, -3 * side}, i % 2 == 0 ? 0.0f : std::numbers::pi_v<float>}});
    goals.push_back({agent, {.kind = Goal::Kind::velocity, .velocity = {0, 2.5f * side}}});
  }
  crowd.teleport(places);
  crowd.steer(goals);
  return replay(device, crowd, ground, 150);
}

// Agents meet among obstacles of every shape, more than an agent looks at, and one agent begins in one.
Results amongObstacles(Device& device, Controller controller, const CrowdOptions& options) {
  const Heightfield ground = smallRollingGround();
  Scene scene = sceneOf(49, 1, 1, controller);
  scene.obstacles = {{Disc{.centre = {2.1f, 1.7f}, .radius = 0.6f}},
                     {Capsule{.from = {-3, -2}, .to = {1, -3}, .radius = 0.2f}},
                     {ConvexPolygon{.corners = {{-2.5f, 0.8f}, {-1.6f, 2.6f}, {-0.6f, 1}}}},
                     {Disc{.centre = {0.4f, -1.1f}, .radius = 0.3f}},
                     {Disc{.centre = {-1.1f, -0.7f}, .radius = 0.25f}},
                     {Capsule{.from = {3, -3}, .to = {3.2f, 4}}},
                     {ConvexPolygon{.corners = {{0, 2.5f}, {1, 2.6f}, {1.2f, 3.5f}, {0.2f, 3.6f}}}}};
  // More of them around the goal than an agent keeps clear of.
  for (const glm::vec2 post :
       {glm::vec2(1.2f, 0.4f), glm::vec2(0.6f, 1.2f), glm::vec2(-0.3f, 0.9f), glm::vec2(1, -0.5f)})
    scene.obstacles.push_back({Disc{.centre = post, .radius = 0.1f}});
  scene.herds[0].avoid = true;
  scene.herds[0].spawn = {.kind = Spawn::Kind::grid, .spacing = 1.4f};
  scene.herds[0].goal = {.kind = Goal::Kind::point, .target = {0.3f, 0.2f}};
  Crowd crowd(device, ground, scene, options);
  simulate(device, crowd, 20);
  return replay(device, crowd, ground, 200);
}

// Round the end of a wall to a goal behind it, and on to the goal.
Results findingWays(Device& device, Controller controller, const CrowdOptions& options) {
  const Heightfield ground = smallRollingGround();
  Scene scene = sceneOf(36, 2, 1, controller);
  scene.obstacles = {{Capsule{.from = {-16, 0}, .to = {3, 0}, .radius = 0.3f}}};
  scene.herds[0].ways = Ways{};
  scene.herds[0].spawn = {.kind = Spawn::Kind::grid, .spacing = 1, .centre = {0, -4}};
  scene.herds[0].goal = {.kind = Goal::Kind::point, .target = {0, 5}, .speed = 2};
  Crowd crowd(device, ground, scene, options);
  simulate(device, crowd, 60);
  return replay(device, crowd, ground, 400);
}

// From place to place of a disc.
Results roaming(Device& device, Controller controller, const CrowdOptions& options) {
  const Heightfield ground = smallRollingGround();
  Scene scene = sceneOf(36, 2, 1, controller);
  scene.herds[0].ways = Ways{};
  scene.herds[0].spawn = {.kind = Spawn::Kind::grid, .spacing = 1};
  scene.herds[0].goal = {.kind = Goal::Kind::roam, .speed = 2, .radius = 6};
  Crowd crowd(device, ground, scene, options);
  simulate(device, crowd, 60);
  return replay(device, crowd, ground, 240);
}

// To food at both ends of a wall and home again, until a source is empty and searches are given up.
Results foraging(Device& device, Controller controller, const CrowdOptions& options) {
  const Heightfield ground = smallRollingGround();
  Crowd crowd(device, ground, foragersScene(controller), options);
  simulate(device, crowd, 30);
  return replay(device, crowd, ground, 600);
}

Results walking(Device& device, Controller controller, const CrowdOptions& options) {
  const Heightfield ground = rollingGround();
  Crowd crowd(device, ground, sceneOf(64, 1, 1, controller), options);
  return replay(device, crowd, ground, 60);
}

// One agent after the other.
Results fallingAsleep(Device& device, Controller controller, const CrowdOptions& options) {
  const Heightfield ground = rollingGround();
  Scene scene = sceneOf(20, 1, 1, controller);
  scene.herds[0].goal.kind = Goal::Kind::none;
  CrowdOptions sleeping = options;
  sleeping.sleep = true;
  Crowd crowd(device, ground, scene, sleeping);
  simulate(device, crowd, 100);
  return replay(device, crowd, ground, 120);
}

// Goals far beyond every side of a terrain that is longer than wide hold the agents at its margin. Then half
// of them are called back: whoever goes inward is not turned round.
Results atTheEdge(Device& device, Controller controller, const CrowdOptions& options) {
  const Heightfield ground =
      generateHeightfield({.columns = 29, .rows = 21, .amplitude = 0.5f, .wavelength = 8});
  Scene scene = sceneOf(16, 3, 1, controller);
  scene.herds[0].spawn = {.kind = Spawn::Kind::grid, .spacing = 0.5f};
  Crowd crowd(device, ground, scene, options);
  const auto send = [&](float turn) {
    setGoals(device, crowd, [&](size_t agent, float* goal) {
      const float angle = 0.3f + 0.785398f * static_cast<float>(agent);
      const float way = agent % 2 == 0 ? turn : 1.0f;
      goal[0] = 100 * way * std::sin(angle), goal[1] = 100 * way * std::cos(angle);
      goal[6] = shared::GOAL_POINT;
    });
  };
  send(1);
  simulate(device, crowd, 150);
  send(-1);
  return replay(device, crowd, ground, 60);
}

// By velocities of every direction, half of them longer than they are cut to.
Results goingByVelocity(Device& device, Controller controller, const CrowdOptions& options) {
  const Heightfield ground = rollingGround();
  Crowd crowd(device, ground, sceneOf(16, 1, 1, controller), options);
  simulate(device, crowd, 30);
  setGoals(device, crowd, [&](size_t agent, float* goal) {
    const float angle = 0.785398f * static_cast<float>(agent);
    goal[0] = 0.8f * std::sin(angle), goal[1] = 0.8f * std::cos(angle);
    goal[4] = agent < 8 ? 0.6f : 1.0f, goal[6] = shared::GOAL_VELOCITY;
  });
  return replay(device, crowd, ground, 30);
}

// On a small map agents run faster than they can turn back in time: they brake before its edge.
Results tooFastForTheMap(Device& device, Controller controller, const CrowdOptions& options) {
  const Heightfield ground = smallRollingGround();
  Crowd crowd(device, ground, sceneOf(64, 1000, 1, controller), options);
  simulate(device, crowd, 150);
  return replay(device, crowd, ground, 120);
}

// Reach-triggered stepping over ground so rough that the nearest foothold that fits is often not the best.
// The replay is told what such stepping is, and not what the host made of it.
Results reachingOverRocks(Device& device, Controller controller, const CrowdOptions& options) {
  const Heightfield ground =
      generateHeightfield({.columns = 257, .rows = 257, .amplitude = 2, .wavelength = 4});
  Scene scene = sceneOf(32, 2.5f, 1, controller);
  scene.herds[0].stepping = Stepping::reach;
  Crowd crowd(device, ground, scene, options);
  simulate(device, crowd, 60);
  validation::HerdFacts facts = validation::herdFacts(kindOf(crowd), ground);
  facts.parameters.reachTriggered = facts.parameters.nearestOnly = 1;
  return replay(device, crowd, facts, 60);
}

// The ground drops below agents that stand. Each lifts one leg in the same tick, together one more than a
// work group has invocations.
Results liftingAtOnce(Device& device, Controller controller, const CrowdOptions& options) {
  const Heightfield ground = smallRollingGround();
  Scene scene = sceneOf(shared::WORK_GROUP + 1, 1, 1, controller);
  scene.herds[0].goal.kind = Goal::Kind::none;
  Crowd crowd(device, ground, scene, options);
  simulate(device, crowd, 90);
  raiseAll(crowd, -0.1f);
  return replay(device, crowd, crowd.terrain(), 2);
}

// All feet stand at home, on landings that were last resorts. They have no other reason to step.
Results onLastResorts(Device& device, Controller controller, const CrowdOptions& options) {
  const Heightfield ground = rollingGround();
  Scene scene = sceneOf(16, 1, 1, controller);
  scene.herds[0].goal.kind = Goal::Kind::none;
  Crowd crowd(device, ground, scene, options);
  simulate(device, crowd, 1);
  forEachRecord(device, pageOf(crowd).step, shared::STEP_STRIDE,
                [](size_t, float* step) { step[7] = -std::abs(step[7]); });
  return replay(device, crowd, crowd.terrain(), 30);
}

// Ground that stops who walks on it: steps and pits with sheer sides, spikes, and a slope that is too steep,
// a quarter of the map each.
Results onBrokenGround(Device& device, Controller controller, const CrowdOptions& options) {
  Heightfield ground = smallRollingGround();
  for (uint32_t row = 0; row < ground.rows; ++row) {
    for (uint32_t column = 0; column < ground.columns; ++column) {
      float& height = ground.heights[row * ground.columns + column];
      const bool right = column > ground.columns / 2, far = row > ground.rows / 2;
      const float hashed = static_cast<float>((row * 7919 + column * 104729) % 1000) / 1000;
      if (right && far) height = 1.1f * static_cast<float>((row / 6 + column / 6) % 3);
      if (right && !far) height = (row / 5 + column / 7) % 4 == 0 ? -3.0f : 0.0f;
      if (!right && far) height += 1.5f * hashed;
      if (!right && !far) height += 3.2f * ground.spacingX * static_cast<float>(column);
    }
  }
  Crowd crowd(device, ground, sceneOf(48, 1.2f, 1, controller), options);
  return replay(device, crowd, ground, 150);
}

// Ticks so long that a step lasts the least number of them, and that its windows set the length of a cycle.
Results inLongTicks(Device& device, Controller controller, const CrowdOptions& options) {
  const Heightfield ground = rollingGround();
  Crowd crowd(device, ground, sceneOf(16, 1, 1, controller), options);
  return replay(device, crowd, ground, 40, 0.3f);
}

// From none to all agents fade from one clip to another, one more in each tick, so that the last of their
// joints is anywhere in its work group.
Results fading(Device& device, Controller controller, const CrowdOptions& options) {
  constexpr size_t agents = 32;
  const Heightfield ground = rollingGround();
  Crowd crowd(device, ground, sceneOf(agents, 1, 1, controller), options);
  simulate(device, crowd, 60);
  validation::Replay replay(validation::herdFacts(kindOf(crowd), ground));
  for (size_t many = 0; many <= agents && !replay.hasRefused(); ++many) {
    forEachRecord(device, pageOf(crowd).play, shared::PLAY_STRIDE,
                  [&](size_t agent, float* play) { play[4] = agent < many ? 0.25f : 1; });
    const HerdState before = crowd.download(0);
    simulate(device, crowd, 1);
    replay.tick(crowd.tick(), before, crowd.download(0));
  }
  return replay.results();
}

// The spider has one gait; its walk played twice as fast serves as a run. Agents of all speeds from below a
// walk to above the run start, change their gait and stop.
Results changingGaits(Device& device, Controller controller, const CrowdOptions& options) {
  const Heightfield ground = rollingGround();
  Scene scene = sceneOf(16, 1, 1, controller);
  scene.herds[0].clips = {"idle", "walk", "walk"};
  Crowd crowd(device, ground, scene, options);
  crowd::ClipRecords& clips = kindOf(crowd).clips;
  float* run = &clips.heads[8];
  const auto first = static_cast<size_t>(run[0]), end = first + static_cast<size_t>(run[1]);
  run[2] /= 2, run[3] *= 2;
  for (size_t frame = first; frame < end; ++frame)
    clips.times[4 * frame] /= 2, clips.times[4 * frame + 1] *= 2;
  gpu::upload(device.context(), kindOf(crowd).clipHeads, clips.heads);
  gpu::upload(device.context(), kindOf(crowd).clipTimes, clips.times);
  setGoals(device, crowd, [&](size_t agent, float* goal) {
    goal[4] = 0.04f * std::pow(1.36f, static_cast<float>(agent));
    goal[6] = shared::GOAL_POINT;
    const HerdState state = crowd.download(0, {static_cast<uint32_t>(agent), 16});
    const glm::dvec3 place = positionOf(state, 0);
    goal[0] = static_cast<float>(place.x), goal[1] = static_cast<float>(place.z) + 2.5f;
  });
  return replay(device, crowd, ground, 150);
}

// The third bone of each leg points straight back, against its rest direction, where stereographic
// coordinates end: its far joint moves with the second bone.
Results foldingBack(Device& device, Controller controller, const CrowdOptions& options) {
  const Heightfield ground = rollingGround();
  Crowd crowd(device, ground, sceneOf(16, 1, 1, controller), options);
  crowd::Kind& kind = kindOf(crowd);
  for (size_t l = 0; l < kind.rig.legs.size(); ++l) {
    const Bone& bone = kind.rig.legs[l].bones.at(2);
    float* joints = &kind.clips.legs[l * static_cast<size_t>(kind.bones + 1) * 4];
    const glm::vec3 end = bone.start - bone.length * bone.direction;
    const float secondBone = joints[4 + 3];
    joints[12] = end.x, joints[13] = end.y, joints[14] = end.z, joints[15] = secondBone;
  }
  gpu::upload(device.context(), kind.clipLegs, kind.clips.legs);
  return replay(device, crowd, ground, 60);
}

// The clip bends every bone further than its rig allows, so that planted widens every limit.
Results beyondTheLimits(Device& device, Controller controller, const CrowdOptions& options) {
  const Heightfield ground = rollingGround();
  Rig rig = spiderRig();
  for (Leg& leg : rig.legs)
    for (Bone& bone : leg.bones) bone.coneHalfAngle = 0.05f;
  CrowdOptions stiff = options;
  stiff.rigs = {rig};
  Crowd crowd(device, ground, sceneOf(16, 1, 1, controller), stiff);
  return replay(device, crowd, ground, 60);
}

// What the host has said happens before the first of them.
void replayTicks(Device& device, Crowd& crowd, validation::Replay& replay, int ticks, float dt = kTick) {
  crowd::applyChanges(implOf(crowd));
  HerdState before = crowd.download(0);
  for (int i = 0; i < ticks && !replay.hasRefused(); ++i) {
    simulate(device, crowd, 1, dt);
    HerdState after = crowd.download(0);
    replay.tick(crowd.tick(), before, after);
    before = std::move(after);
  }
}

// A crowd that has walked for a while, to be replayed from then on.
struct Underway {
  Crowd crowd;
  validation::Replay replay;

  Underway(Device& device, const Scene& scene, const CrowdOptions& options)
      : Underway(device, rollingGround(), scene, options) {}

 private:
  Underway(Device& device, const Heightfield& ground, const Scene& scene, const CrowdOptions& options)
      : crowd(walked(device, ground, scene, options)), replay(validation::herdFacts(kindOf(crowd), ground)) {}

  static Crowd walked(Device& device, const Heightfield& ground, const Scene& scene,
                      const CrowdOptions& options) {
    Crowd crowd(device, ground, scene, options);
    simulate(device, crowd, 40);
    return crowd;
  }
};

// Every agent is hurt in a way of its own, some to where they lie down; later half of them heal.
Results losingLegs(Device& device, Controller controller, const CrowdOptions& options) {
  constexpr uint32_t agents = 24, legs = 8;
  Underway underway(device, hurtScene(agents, controller), options);
  auto& [crowd, replay] = underway;
  const auto run = [&](int ticks) { replayTicks(device, crowd, replay, ticks); };
  std::vector<AgentLeg> hurt;
  const auto add = [&](uint32_t agent, uint32_t leg, LegState state) {
    hurt.push_back({crowd.agentId(0, agent), leg % legs, state, (agent + leg) % 4});
  };
  for (uint32_t agent = 0; agent < agents; ++agent) {
    add(agent, agent, LegState::lost);
    if (agent % 3 == 0) add(agent, 3 * agent + 1, LegState::stuck);
    if (agent % 2 == 0) add(agent, 5 * agent + 2, LegState::lame);
    if (agent % 12 == 11)
      for (uint32_t leg = 0; leg < (agent == 23 ? legs : legs - 2); ++leg) add(agent, leg, LegState::lost);
  }
  crowd.hurt(hurt);
  run(45);
  for (uint32_t agent = 0; agent < agents; agent += 2) crowd.heal(crowd.agentId(0, agent));
  crowd.heal(crowd.agentId(0, 23));
  run(45);
  return replay.results();
}

// Agents that are not told what they lost try gaits: each is hurt in a way of its own, goes at a speed of its
// own, some too slowly to try anything, and some turn. Ticks are long, for a trial takes seconds.
Results tryingGaits(Device& device, Controller controller, const CrowdOptions& options) {
  constexpr uint32_t agents = 16, legs = 8;
  constexpr float longTick = 1.0f / 15;
  const Heightfield ground = rollingGround();
  Scene scene = hurtScene(agents, controller);
  scene.herds[0].adapts = true;
  Crowd crowd(device, ground, scene, options);
  std::vector<AgentLeg> hurt;
  std::vector<AgentGoal> goals;
  for (uint32_t agent = 0; agent < agents; ++agent) {
    const AgentId id = crowd.agentId(0, agent);
    const auto add = [&](uint32_t leg, LegState state) { hurt.push_back({id, leg % legs, state}); };
    if (agent == 15) {  // it lies down
      for (uint32_t leg = 0; leg < legs - 2; ++leg) add(leg, LegState::lost);
    } else if (agent % 4 == 1) {
      add(5 * agent + 2, LegState::lame);
    } else {
      for (uint32_t k = 0; k <= agent / 4; ++k) add(agent + k * (1 + agent % 3), LegState::lost);
      if (agent % 3 == 0) add(3 * agent + 1, LegState::stuck);
    }
    const float speed = agent == 6 || agent == 7 ? 0.15f : 1 + 0.1f * static_cast<float>(agent % 5);
    const float angle = 0.6f * static_cast<float>(agent);
    goals.push_back(
        {id,
         {.kind = Goal::Kind::velocity, .velocity = speed * glm::vec2(std::sin(angle), std::cos(angle))}});
  }
  crowd.steer(goals);
  simulate(device, crowd, 10, longTick);
  crowd.hurt(hurt);
  return replay(device, crowd, ground, 290, longTick);
}

// On three or four legs agents try one gait after the other; only their trials are looked at.
Results tryingManyGaits(Device& device, Controller controller, const CrowdOptions& options) {
  constexpr uint32_t agents = 4, legs = 8;
  constexpr float longTick = 1.0f / 15;
  Scene scene = hurtScene(agents, controller);
  scene.herds[0].adapts = true;
  Crowd crowd(device, rollingGround(), scene, options);
  simulate(device, crowd, 10, longTick);
  for (uint32_t agent = 0; agent < agents; ++agent)
    for (uint32_t k = 0; k < 4 + agent % 2; ++k)
      crowd.hurt(crowd.agentId(0, agent), (agent + k * (1 + agent / 2)) % legs);
  validation::Replay replay(validation::herdFacts(kindOf(crowd), crowd.terrain()), {crowd::StageId::adapt});
  replayTicks(device, crowd, replay, 13 * 63, longTick);
  return replay.results();
}

// Loads of every weight and to every side, some of agents that lose a leg; later some are laid down, and
// others shifted.
Results carryingLoads(Device& device, Controller controller, const CrowdOptions& options) {
  constexpr uint32_t agents = 24;
  Underway underway(device, hurtScene(agents, controller), options);
  auto& [crowd, replay] = underway;
  const auto load = [&](uint32_t agent, float turn) {
    const float angle = static_cast<float>(agent) + turn, far = static_cast<float>(agent % 5) / 2;
    return AgentLoad{crowd.agentId(0, agent),
                     {.mass = 0.25f * static_cast<float>(1 + agent % 16),
                      .offset = {far * std::sin(angle), 0.3f, far * std::cos(angle)}}};
  };
  std::vector<AgentLoad> loads;
  for (uint32_t agent = 1; agent < agents; ++agent) loads.push_back(load(agent, 0));
  crowd.carry(loads);
  for (uint32_t agent = 0; agent < agents; agent += 5) crowd.hurt(crowd.agentId(0, agent), agent % 8);
  replayTicks(device, crowd, replay, 45);
  for (uint32_t agent = 0; agent < agents; agent += 3) crowd.carry(crowd.agentId(0, agent), {});
  for (uint32_t agent = 1; agent < agents; agent += 3) crowd.carry(std::array{load(agent, 2)});
  replayTicks(device, crowd, replay, 45);
  return replay.results();
}

// Pushes of every strength and to every side, ground that is gone under some, and a leg that others lose;
// some are pushed again as they lie or rise.
Results gettingPushed(Device& device, Controller controller, const CrowdOptions& options) {
  constexpr uint32_t agents = 24;
  Scene scene = sceneOf(agents, 1, 1, controller);
  scene.herds[0].reactions = true;
  Underway underway(device, scene, options);
  auto& [crowd, replay] = underway;
  const auto run = [&](int ticks) { replayTicks(device, crowd, replay, ticks); };
  const auto pushAll = [&](float strongest, uint32_t every) {
    for (uint32_t agent = 0; agent < agents; agent += every)
      pushAside(crowd, agent, strongest * static_cast<float>(agent) / agents);
  };
  pushAll(14, 1);
  run(30);
  pushAll(9, 5);
  for (uint32_t agent = 0; agent < agents; agent += 4) crowd.hurt(crowd.agentId(0, agent), agent % 8);
  run(40);
  // A dent of 0.6 m in front of every other agent.
  const Heightfield& now = crowd.terrain();
  const HerdState standing = crowd.download(0);
  for (uint32_t agent = 0; agent < agents; agent += 2) {
    const glm::dvec3 at = positionOf(standing, agent);
    const auto x = static_cast<uint32_t>((at.x - now.originX()) / now.spacingX);
    const auto z = static_cast<uint32_t>((at.z - now.originZ()) / now.spacingZ) + 1;
    std::vector<float> heights;
    for (uint32_t row = z; row < z + 2; ++row)
      for (uint32_t column = x; column < x + 2; ++column)
        heights.push_back(now.heights[size_t{row} * now.columns + column] - 0.6f);
    crowd.editHeights(x, z, 2, 2, heights);
    replay.edit(x, z, 2, 2, heights);
  }
  run(30);
  std::vector<bool> again(agents);
  for (int i = 0; i < 8; ++i) {
    const std::vector<Reaction> all = crowd.reactions(0);
    for (uint32_t agent = 1; agent < agents; agent += 2) {
      if (all[agent].phase != ReactionPhase::rising || again[agent]) continue;
      crowd.push(crowd.agentId(0, agent), {0, 12});
      again[agent] = true;
    }
    run(12);
  }
  run(120);
  return replay.results();
}

// The same push, to every side, of agents with loads of every weight: beside them, on top, and hanging so low
// that the pendulum is at its shortest.
Results pushedUnderLoads(Device& device, Controller controller, const CrowdOptions& options) {
  constexpr uint32_t agents = 32;
  Scene scene = sceneOf(agents, 1, 1, controller);
  scene.herds[0].reactions = true;
  Underway underway(device, scene, options);
  auto& [crowd, replay] = underway;
  const glm::vec3 offsets[] = {{0.8f, 0, 0}, {0, 1.5f, 0}, {0, -2, 0}, {0, 0.2f, -0.7f}};
  for (uint32_t agent = 1; agent < agents; ++agent)
    crowd.carry(crowd.agentId(0, agent),
                {.mass = 0.5f * static_cast<float>(1 + agent % 8), .offset = offsets[agent % 4]});
  replayTicks(device, crowd, replay, 20);
  for (const float speed : {4.0f, 12.0f}) {
    for (uint32_t agent = 0; agent < agents; ++agent) pushAside(crowd, agent, speed);
    replayTicks(device, crowd, replay, 60);
  }
  return replay.results();
}

// Bellies are higher above the ground than the body itself stands, so who falls has nowhere to sink.
Results pushedOnHighBellies(Device& device, Controller controller, const CrowdOptions& options) {
  constexpr uint32_t agents = 16;
  Scene scene = sceneOf(agents, 1, 1, controller);
  scene.herds[0].reactions = true;
  scene.herds[0].tuning.bellyClearance = 1.3f;
  Underway underway(device, scene, options);
  auto& [crowd, replay] = underway;
  for (uint32_t agent = 0; agent < agents; ++agent) pushAside(crowd, agent, 14);
  replayTicks(device, crowd, replay, 150);
  return replay.results();
}

}  // namespace

Scene foragersScene(Controller controller) {
  Scene scene = sceneOf(48, 3, 1, controller);
  scene.obstacles = {{Capsule{.from = {-4, 1}, .to = {3, 1}, .radius = 0.3f}}};
  scene.herds[0].spawn = {.kind = Spawn::Kind::grid, .spacing = 0.7f, .centre = {0, -3}};
  scene.herds[0].forage =
      Forage{.nest = {.centre = {0, -3}, .radius = 1.5f},
             .food = {{.centre = {4, -2}, .radius = 1.5f, .amount = 2}, {.centre = {-5, 3}, .radius = 2}},
             .branches = {{.centre = {-3, -2}, .radius = 1.5f}},
             .cell = 1,
             .layOut = 1,
             .life = 20,
             .patience = 14,
             .rest = 0.5f};
  return scene;
}

void pushAside(Crowd& crowd, uint32_t agent, float speed) {
  const float angle = 2.4f * static_cast<float>(agent);
  crowd.push(crowd.agentId(0, agent), speed * glm::vec2(std::cos(angle), std::sin(angle)));
}

const std::vector<Situation>& situations() {
  static const std::vector<Situation> all = [] {
    std::vector<Situation> both = {
        {"walking", {Controller::adaptive}, walking, true},
        {"meeting", {Controller::adaptive, Controller::clip}, meeting},
        {"meetingLarge", {Controller::adaptive}, meetingLarge},
        {"crowding", {Controller::adaptive}, crowding},
        {"parting", {Controller::adaptive}, parting},
        {"ranking", {Controller::adaptive}, ranking},
        {"packing", {Controller::adaptive}, packing},
        {"facing", {Controller::adaptive}, facing},
        {"amongObstacles", {Controller::adaptive, Controller::clip}, amongObstacles, true},
        {"findingWays", {Controller::adaptive, Controller::clip}, findingWays, true},
        {"roaming", {Controller::adaptive, Controller::clip}, roaming},
        {"foraging", {Controller::adaptive, Controller::clip}, foraging, true},
        {"fallingAsleep", {Controller::adaptive}, fallingAsleep, true},
        {"atTheEdge", {Controller::adaptive}, atTheEdge},
        {"goingByVelocity", {Controller::adaptive, Controller::loop}, goingByVelocity},
        {"tooFastForTheMap", {Controller::adaptive, Controller::loop}, tooFastForTheMap},
        {"reachingOverRocks", {Controller::adaptive}, reachingOverRocks},
        {"liftingAtOnce", {Controller::adaptive}, liftingAtOnce},
        {"onLastResorts", {Controller::adaptive}, onLastResorts},
        {"onBrokenGround", {Controller::adaptive, Controller::loop}, onBrokenGround},
        {"inLongTicks", {Controller::adaptive, Controller::loop}, inLongTicks},
        {"fading", {Controller::clip, Controller::planted}, fading},
        {"changingGaits", {Controller::clip, Controller::planted}, changingGaits},
        {"foldingBack", {Controller::clip}, foldingBack},
        {"beyondTheLimits", {Controller::planted}, beyondTheLimits},
        {"gettingPushed", {Controller::adaptive}, gettingPushed, true},
        {"pushedOnHighBellies", {Controller::adaptive}, pushedOnHighBellies},
        {"pushedUnderLoads", {Controller::adaptive}, pushedUnderLoads, true},
        {"losingLegs", {Controller::adaptive, Controller::loop, Controller::planted}, losingLegs, true},
        {"tryingGaits", {Controller::adaptive}, tryingGaits, true},
        {"tryingManyGaits", {Controller::adaptive}, tryingManyGaits},
        {"carryingLoads", {Controller::adaptive, Controller::loop, Controller::planted}, carryingLoads, true},
    };
    both.insert(both.end(), situationsAtRates().begin(), situationsAtRates().end());
    return both;
  }();
  return all;
}

const Situation& situationNamed(const std::string& name) {
  const auto found = std::find_if(situations().begin(), situations().end(),
                                  [&](const Situation& situation) { return situation.name == name; });
  if (found == situations().end()) throw std::out_of_range("no situation '" + name + "'");
  return *found;
}

}  // namespace skitter::test
