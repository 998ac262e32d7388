#include "skitter/tuning.h"

#include <limits>

#include "public/public.h"

namespace skitter::test {
namespace {

TEST(PublicTuning, TheUsualOneIsSound) {
  EXPECT_NO_THROW(checkTuning(Tuning{}, "usual"));
  for (const TuningInfo& info : allTunings) EXPECT_EQ(Tuning{}.*info.member, info.usual) << info.name;
}

TEST(PublicTuning, RangesAreWrittenWithTheirUnit) {
  for (const TuningInfo& info : allTunings) {
    const std::string range = rangeOf(info), unit = nameOf(info.unit);
    EXPECT_THAT(range, testing::HasSubstr(" to ")) << info.name;
    EXPECT_THAT(range, testing::EndsWith(unit)) << info.name;
    if (std::string(info.name) == "acceleration") {
      EXPECT_EQ(range, "0.1 to 20 leg lengths/s^2");
    }
  }
  EXPECT_STREQ(nameOf(TuningUnit::perSecond), "1/s");
}

TEST(PublicTuning, EachParameterIsRefusedBeyondItsRange) {
  for (const TuningInfo& info : allTunings)
    for (const float value :
         {std::numeric_limits<float>::quiet_NaN(), info.most + 1 + info.most, info.least - 1 - info.most}) {
      Tuning tuning;
      tuning.*info.member = value;
      expectRefused(std::string("mine.") + info.name + " is ", [&] { checkTuning(tuning, "mine"); });
    }
}

TEST(PublicTuning, PairsAreRefusedInTheWrongOrder) {
  Tuning tuning;
  tuning.dutyLeast = 0.7f;
  tuning.dutyStill = 0.6f;
  expectRefused("mine.dutyLeast is 0.7 and dutyStill is 0.6", [&] { checkTuning(tuning, "mine"); });
}

}  // namespace
}  // namespace skitter::test
