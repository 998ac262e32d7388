#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "skitter/crowd.h"
#include "skitter/scene.h"
#include "support/gpu_fixture.h"
#include "validation/replay.h"

namespace skitter::test {

constexpr float kTick = 1.0f / 60;
// Every agent is measured in every tick, and all that may be written is.
const CrowdOptions kAllWatched{.watchEvery = 1, .feet = true, .footfalls = UINT32_MAX};

// A scene of one herd on generated ground.
Scene sceneOf(uint32_t agents, float speed = 1, uint64_t seed = 1,
              Controller controller = Controller::adaptive);
// The same, of a herd that can be hurt.
Scene hurtScene(uint32_t agents, Controller controller = Controller::adaptive);
Heightfield rollingGround();
// 32 m a side: soon crossed.
Heightfield smallRollingGround();
Heightfield flatGround();
// A plateau that ends in a wall far beyond any reach, across the lanes' way.
Heightfield cliffGround();

// The built-in spider with another leg length, in metres; without its skin.
Rig scaledSpider(float legLength);
// The controller's name as a part of a test's, where GoogleTest allows no hyphen.
std::string testNameOf(Controller controller);

// Submits `ticks` ticks and waits.
void simulate(Device& device, Crowd& crowd, int ticks, float dt = kTick);

// Runs `ticks` ticks in lock step with the reference, or fewer where one is refused, from the crowd's present
// state on; of the first herd.
std::vector<validation::StageResult> replay(Device& device, Crowd& crowd, const Heightfield& terrain,
                                            int ticks, float dt = kTick);
// The same, with `facts` of the herd in place of those that the crowd has.
std::vector<validation::StageResult> replay(Device& device, Crowd& crowd, const validation::HerdFacts& facts,
                                            int ticks, float dt = kTick);
void expectAllPass(const std::vector<validation::StageResult>& results);

// The same of every herd, size after size.
std::vector<std::vector<validation::StageResult>> replayAll(Device& device, Crowd& crowd,
                                                            const Heightfield& terrain, int ticks,
                                                            float dt = kTick);

// Who stood anew before the first tick against who began in the same places: the same bits where poses do not
// depend on feet; else goals, gaits and headings have the same bits, and bodies and feet are within a
// hundredth of a leg, for the way to a foot differs.
void expectBeganAlike(const Crowd& anew, const Crowd& began);

// Agent i's world position and, for each leg, whether it is planted.
glm::dvec3 positionOf(const HerdState& state, size_t agent);
bool plantedOf(const HerdState& state, size_t leg);

bool sameBits(const std::vector<float>& a, const std::vector<float>& b);

}  // namespace skitter::test
