// How a scene's herds begin and look: phases, colours and tints.
#include <algorithm>
#include <set>

#include "crowd/page.h"
#include "crowd/simulation.h"
#include "crowd/tint.h"
#include "gpu/transfer.h"
#include "render/tint.h"
#include "skitter/error.h"

namespace skitter::test {
namespace {

class LooksTest : public GpuTest {};

Scene plainScene(uint32_t agents = 40, Controller controller = Controller::adaptive) {
  return sceneOf(agents, 1, 5, controller);
}

TEST_F(LooksTest, PhasesAreDrawnOrGiven) {
  const Heightfield ground = flatGround();
  const auto phases = [&](std::optional<float> phase, Controller controller) {
    Scene scene = plainScene(50, controller);
    scene.herds[0].phase = phase;
    const HerdState state = Crowd(device(), ground, scene).download(0);
    std::set<float> all;
    for (uint32_t a = 0; a < 50; ++a) {
      if (controller == Controller::clip)
        all.insert(state.play[a * 4 * shared::PLAY_STRIDE + 1]);
      else
        all.insert(state.gait[a * 4 * shared::GAIT_STRIDE]);
    }
    return all;
  };
  EXPECT_EQ(phases({}, Controller::adaptive).size(), 50u);
  EXPECT_EQ(phases(0.25f, Controller::adaptive), std::set<float>{0.25f});
  EXPECT_EQ(phases(1, Controller::adaptive), std::set<float>{0});
  EXPECT_EQ(phases({}, Controller::clip).size(), 50u);
  EXPECT_EQ(phases(0, Controller::clip), std::set<float>{0});
  const std::set<float> half = phases(0.5f, Controller::clip);
  ASSERT_EQ(half.size(), 1u);
  EXPECT_GT(*half.begin(), 0.1f);
  Scene scene = plainScene(1);
  scene.herds[0].phase = 1.5f;
  EXPECT_THROW(Crowd(device(), ground, scene), Error);
}

std::vector<glm::vec4> tintsOf(const Crowd& crowd, uint32_t herd) {
  std::vector<glm::vec4> tints;
  for (const crowd::Part& part : crowd::partsOf(implOf(crowd), herd)) {
    const auto all = gpu::download<glm::vec4>(*implOf(crowd).context, part.page->tint);
    tints.insert(tints.end(), all.begin() + part.first, all.begin() + part.first + part.agents);
  }
  return tints;
}

TEST_F(LooksTest, OnlyHerdsThatAskHaveTintsAndTheyAreDrawnBySeed) {
  const Heightfield ground = flatGround();
  Scene scene = plainScene();
  scene.herds.resize(4, scene.herds[0]);
  scene.herds[1].colour = glm::vec3(0.5f, 0.25f, 0.125f);
  scene.herds[2].tint = 0;
  scene.herds[3].tint = 1;
  scene.herds.push_back(scene.herds[0]);
  scene.herds[4].controller = Controller::loop;
  const Crowd crowd(device(), ground, scene);
  const Crowd::Impl& impl = implOf(crowd);
  ASSERT_EQ(impl.kinds.size(), 2u);
  EXPECT_TRUE(impl.kinds[0].tinted);
  EXPECT_FALSE(impl.kinds[1].tinted);
  const std::vector<glm::vec4> plain = tintsOf(crowd, 0), coloured = tintsOf(crowd, 1),
                               alike = tintsOf(crowd, 2), varied = tintsOf(crowd, 3);
  for (const glm::vec4& tint : plain) EXPECT_EQ(tint, glm::vec4(1, 1, 1, 0));
  for (const glm::vec4& tint : coloured) {
    EXPECT_EQ(tint, coloured.front());
    EXPECT_EQ(tint.w, shared::TINT_LIGHTNESS);
    // Of the model's mean lightness it makes the colour.
    EXPECT_NEAR(tint.x * crowd::meanLightness(impl.kinds[0]), 0.5f, 1e-6f);
    EXPECT_NEAR(tint.z * crowd::meanLightness(impl.kinds[0]), 0.125f, 1e-6f);
  }
  for (const glm::vec4& tint : alike) {
    EXPECT_EQ(tint, alike.front());
    EXPECT_EQ(tint.w, shared::TINT_VARIED);
    EXPECT_NEAR(tint.x, shared::LEAST_VALUE + shared::VALUE_RANGE / 2, 1e-6f);
  }
  std::set<float> values;
  for (const glm::vec4& tint : varied) {
    values.insert(tint.y);
    EXPECT_GE(tint.y, shared::LEAST_VALUE - shared::VALUE_RANGE / 2 - 1e-6f);
    EXPECT_LE(tint.y, shared::LEAST_VALUE + 1.5f * shared::VALUE_RANGE + 1e-6f);
  }
  EXPECT_EQ(values.size(), varied.size());
  EXPECT_GT(*values.rbegin() - *values.begin(), shared::VALUE_RANGE);
  Scene other = scene;
  other.seed = 9;
  EXPECT_NE(tintsOf(Crowd(device(), ground, other), 3), varied);
  const auto hasTints = [](const MemoryUse& use) { return use.name == "tint"; };
  EXPECT_TRUE(std::ranges::any_of(crowd.memoryUse(0), hasTints));
  EXPECT_FALSE(std::ranges::any_of(crowd.memoryUse(4), hasTints));
  const Crowd unseen(device(), ground, scene, {.pose = false});
  EXPECT_FALSE(std::ranges::any_of(unseen.memoryUse(0), hasTints));
}

}  // namespace
}  // namespace skitter::test
