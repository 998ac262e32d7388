#include "skitter/palettes.h"

#include <utility>

#include "public/public.h"
#include "skitter/decode.h"

namespace skitter::test {
namespace {

using PublicPalettes = PublicTest;

TEST_F(PublicPalettes, WriteWhereAgentsAre) {
  Crowd crowd(device(), flatGround(), standingScene(3));
  EXPECT_EQ(Palettes::agentsOf(crowd, 0), 3u);
  EXPECT_EQ(Palettes::entriesOf(crowd, 0), 33u);
  EXPECT_EQ(bytesOf(TransformFormat::matrix), 48u);
  EXPECT_EQ(bytesOf(TransformFormat::quaternion), 32u);
  const OwnBuffer instances(device(), 3 * 48), palettes(device(), 3 * 33 * 48);
  const PaletteTarget target{.instances = {.buffer = instances.handle(), .bytes = instances.bytes()},
                             .palettes = {.buffer = palettes.handle(), .bytes = palettes.bytes()}};
  Palettes first(device(), crowd, 0, {target});
  const Palettes writer = std::move(first);
  const glm::dvec3 origin(5, 1, -2);
  device().run([&](VkCommandBuffer commands) {
    crowd.record(commands, tickSeconds);
    writer.record(commands, origin);
    OwnBuffer::toHost(commands);
  });
  const HerdState state = crowd.download(0);
  for (size_t agent = 0; agent < 3; ++agent) {
    const BodyState body = bodyOf(std::span(state.body).subspan(16 * agent, 16), origin);
    // Rows of a 3x4 matrix: the fourth column is the position. Numbers below 10 in float32.
    for (int row = 0; row < 3; ++row)
      EXPECT_NEAR(instances.floats()[12 * agent + 4 * row + 3], body.position[row], 1e-5) << agent;
    // Every entry turns, and stretches nothing: rows have length 1 but for the rounding of float32.
    for (size_t entry = 0; entry < 33; ++entry) {
      const float* row = palettes.floats() + 12 * (33 * agent + entry);
      EXPECT_NEAR(glm::length(glm::vec3(row[0], row[1], row[2])), 1, 1e-4) << agent << ", " << entry;
    }
  }
}

TEST_F(PublicPalettes, RefuseWhatCannotBe) {
  Scene scene = standingScene(3);
  scene.herds.push_back(scene.herds[0]);
  scene.herds[1].controller = Controller::clip;
  Crowd crowd(device(), flatGround(), scene);
  const OwnBuffer buffer(device(), 1 << 16);
  const TransformRange range{.buffer = buffer.handle(), .bytes = buffer.bytes()};
  const auto refuse = [&](const std::string& text, const Crowd& of, uint32_t herd,
                          const PaletteTarget& target, float unit = 1) {
    expectRefused(text, [&] { Palettes(device(), of, herd, {target}, {.space = {.metresPerUnit = unit}}); });
  };
  const auto with = [&](const auto& change) {
    TransformRange changed = range;
    change(changed);
    return PaletteTarget{.instances = changed, .palettes = {}};
  };
  refuse("herd 7: expected one of the crowd's 2", crowd, 7, {});
  refuse("metresPerUnit 0", crowd, 0, {}, 0);
  refuse("instances: 143 bytes for 3 transforms", crowd, 0, with([](auto& r) { r.bytes = 143; }));
  refuse("instances: offset 8", crowd, 0, with([](auto& r) { r.offset = 8; }));
  refuse("instances: stride 32", crowd, 0, with([](auto& r) { r.stride = 32; }));
  refuse("stride 64 of planar", crowd, 0, with([](auto& r) { r.stride = 64, r.planar = true; }));
  TransformRange quaternions = range;
  quaternions.format = TransformFormat::quaternion;
  refuse("palettes of herd 1: controller clip", crowd, 1, {.instances = {}, .palettes = quaternions});
  const Crowd poseless(device(), flatGround(), standingScene(3), {.pose = false});
  refuse("expected CrowdOptions::pose", poseless, 0, {.instances = {}, .palettes = range});
  expectRefused("herd 7", [&] { Palettes::agentsOf(crowd, 7); });
  expectRefused("herd 7", [&] { Palettes::entriesOf(crowd, 7); });

  const Palettes writer(device(), crowd, 1, {{.instances = range, .palettes = {}}});
  device().run([&](VkCommandBuffer commands) {
    expectRefused("palettes: target 1, expected one of 1", [&] { writer.record(commands, {}, 1); });
  });
  crowd.removeHerd(crowd.herdId(1));
  device().run([&](VkCommandBuffer commands) {
    expectRefused("herd 1 was removed", [&] { writer.record(commands); });
  });
}

}  // namespace
}  // namespace skitter::test
