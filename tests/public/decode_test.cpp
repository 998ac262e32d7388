#include "skitter/decode.h"

#include <array>

#include "public/public.h"
#include "skitter/records.h"

namespace skitter::test {
namespace {

using glm::dvec3;

// In tile (2, -3), facing +x at 1.5 m/s, turned a half about y.
constexpr std::array<float, 16> bodyRecord{
    1, 2, 3, shared::packedTile(2, -3), 1, 0, 1.5f, 0, 0, 1, 0, 0, 0, 0.5f, 1, 0};
const dvec3 bodyPlace{2 * 16 + 1, 2, -3 * 16 + 3};

TEST(PublicDecode, ABody) {
  const BodyState state = bodyOf(bodyRecord);
  EXPECT_EQ(state.position, bodyPlace);
  EXPECT_EQ(state.rotation, glm::quat(0, 0, 1, 0));
  EXPECT_EQ(state.heading, glm::vec2(1, 0));
  EXPECT_EQ(state.velocity, glm::vec3(1.5f, 0, 0));
  EXPECT_EQ(state.turnRate, 0);
  EXPECT_TRUE(state.present);
  EXPECT_EQ(bodyOf(bodyRecord, bodyPlace).position, dvec3(0));
  std::array<float, 16> empty = bodyRecord;
  empty[7] = 1;
  EXPECT_FALSE(bodyOf(empty).present);
}

// Landing in the body's own tile; of seven ticks from the 90th on.
TEST(PublicDecode, AStep) {
  const float packed = shared::packedTicks(7, shared::stepTile(2, -3));
  const std::array<float, 8> record{4, 5, 6, 90, 1, 0, 2, packed};
  const StepState step = stepOf(record, bodyRecord);
  EXPECT_EQ(step.landing, dvec3(2 * 16 + 4, 5, -3 * 16 + 6));
  EXPECT_EQ(step.liftOff, dvec3(2 * 16 + 1, 0, -3 * 16 + 2));
  EXPECT_EQ(step.firstTick, 90);
  EXPECT_EQ(step.ticks, 7);
  EXPECT_FALSE(step.lastResort);
  std::array<float, 8> resort = record;
  resort[7] = -packed;
  EXPECT_TRUE(stepOf(resort, bodyRecord).lastResort);
  EXPECT_EQ(stepOf(resort, bodyRecord, bodyPlace).landing, dvec3(3, 3, 3));
}

TEST(PublicDecode, AFootAndATip) {
  const BodyState at = bodyOf(bodyRecord);
  const FootState foot = footOf(std::array<float, 4>{1, -1, 2, 0.25f}, at);
  EXPECT_EQ(foot.place, bodyPlace + dvec3(1, -1, 2));
  EXPECT_EQ(foot.progress, 0.25f);
  EXPECT_FALSE(foot.planted());
  EXPECT_TRUE(footOf(std::array<float, 4>{0, 0, 0, 1}, at).planted());
  const TipState tip = tipOf(std::array<float, 4>{1, -1, 2, 0.125f}, at);
  EXPECT_EQ(tip.place, foot.place);
  EXPECT_EQ(tip.error, 0.125f);
}

TEST(PublicDecode, EntriesOfAPose) {
  std::array<float, 24> pose{};
  for (size_t i = 0; i < pose.size(); ++i) pose[i] = static_cast<float>(i);
  const BonePose bone = bonePoseOf(pose, 2);
  EXPECT_EQ(bone.rotation, glm::quat(19, 16, 17, 18));
  EXPECT_EQ(bone.position, glm::vec3(20, 21, 22));
  const glm::mat3x4 joint = jointRowsOf(pose, 1);
  EXPECT_EQ(joint[0], glm::vec4(12, 13, 14, 15));
  EXPECT_EQ(joint[2], glm::vec4(20, 21, 22, 23));
}

TEST(PublicDecode, AFootfall) {
  const std::array<float, 8> event{1, 2, 3, 0.5f, 17, 4, 120, 0};
  const Footfall footfall = footfallOf(event, 10, 0.5);
  EXPECT_EQ(footfall.agent, 7u);
  EXPECT_EQ(footfall.leg, 4u);
  EXPECT_EQ(footfall.tick, 120u);
  EXPECT_EQ(footfall.seconds, 60);
  EXPECT_EQ(footfall.place, glm::vec3(1, 2, 3));
  EXPECT_EQ(footfall.speed, 0.5f);
  // Another herd's, before the one that was asked for.
  EXPECT_GT(footfallOf(event, 18, 0.5).agent, 1000u);
}

TEST(PublicDecode, TooFewFloatsAreRefused) {
  const std::span<const float> short15(bodyRecord.data(), 15), short7(bodyRecord.data(), 7),
      short3(bodyRecord.data(), 3);
  expectRefused("a record of 15 floats, expected at least 16", [&] { bodyOf(short15); });
  expectRefused("a record of 7 floats, expected at least 8", [&] { stepOf(short7, bodyRecord); });
  expectRefused("a record of 3 floats, expected at least 4", [&] { stepOf(bodyRecord, short3); });
  expectRefused("a record of 3 floats, expected at least 4", [&] { footOf(short3, {}); });
  expectRefused("a record of 3 floats, expected at least 4", [&] { tipOf(short3, {}); });
  expectRefused("a record of 7 floats, expected at least 8", [&] { bonePoseOf(short7, 0); });
  expectRefused("a record of 16 floats", [&] { bonePoseOf(bodyRecord, UINT32_MAX); });
  expectRefused("a record of 15 floats, expected at least 16", [&] { jointRowsOf(short15, 1); });
  expectRefused("a record of 7 floats, expected at least 8", [&] { footfallOf(short7, 0, 1); });
}

}  // namespace
}  // namespace skitter::test
