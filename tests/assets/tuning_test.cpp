#include "skitter/tuning.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "files.h"
#include "skitter/scene.h"

namespace skitter {
namespace {

using test::inputFault;
using testing::HasSubstr;

Scene sceneWith(const nlohmann::json& tuning) {
  const nlohmann::json herd = {{"tuning", tuning}};
  return parseScene(nlohmann::json{{"herds", {herd}}}.dump(), "a.json", "");
}

// Near the default, so that no order of two parameters is broken.
float otherThanUsual(const TuningInfo& info) {
  return info.usual < info.most ? info.usual + 0.01f * (info.most - info.usual)
                                : info.usual - 0.01f * (info.usual - info.least);
}

TEST(Tuning, EveryKeySetsItsMemberAlone) {
  for (const TuningInfo& info : allTunings) {
    Tuning expected;
    expected.*info.member = otherThanUsual(info);
    EXPECT_NE(expected, Tuning{}) << info.name;
    EXPECT_EQ(sceneWith({{info.name, expected.*info.member}}).herds[0].tuning, expected) << info.name;
  }
  EXPECT_EQ(sceneWith(nlohmann::json::object()).herds[0].tuning, Tuning{});
}

TEST(Tuning, DefaultsAreInTheirRanges) {
  EXPECT_NO_THROW(checkTuning(Tuning{}, "defaults"));
  for (const TuningInfo& info : allTunings) {
    EXPECT_LT(info.least, info.most) << info.name;
    EXPECT_EQ(Tuning{}.*info.member, info.usual) << info.name;
  }
}

TEST(Tuning, RangesAreKeptByFilesAndByTheInterface) {
  EXPECT_EQ(inputFault([] {
              sceneWith({{"stepHeight", 9}});
            }),
            "a.json: herds[0].tuning.stepHeight is 9, expected 0.01 to 1 leg lengths");
  EXPECT_EQ(inputFault([] {
              sceneWith({{"dutyStill", 0}});
            }),
            "a.json: herds[0].tuning.dutyStill is 0, expected 0.5 to 0.85");
  for (const TuningInfo& info : allTunings)
    for (const float outside : {std::nextafter(info.least, -1e9f), std::nextafter(info.most, 1e9f)}) {
      const std::string expected =
          fmt::format("tuning.{} is {}, expected {}", info.name, outside, rangeOf(info));
      EXPECT_THAT(inputFault([&] { sceneWith({{info.name, outside}}); }), HasSubstr(expected));
      Tuning tuning;
      tuning.*info.member = outside;
      EXPECT_EQ(inputFault([&] { checkTuning(tuning, "tuning"); }), expected);
      tuning.*info.member = std::numeric_limits<float>::quiet_NaN();
      EXPECT_THAT(inputFault([&] { checkTuning(tuning, "tuning"); }),
                  HasSubstr(fmt::format("tuning.{} is nan", info.name)));
    }
}

TEST(Tuning, OrdersNameBothKeys) {
  EXPECT_EQ(
      inputFault([] {
        sceneWith({{"stepHeight", 0.4}, {"stepHeightMax", 0.3}});
      }),
      "a.json: herds[0].tuning.stepHeight is 0.4 and stepHeightMax is 0.3, expected stepHeightMax to be "
      "at least stepHeight: the lift of a step lies between them");
  EXPECT_EQ(inputFault([] {
              sceneWith({{"stretchStop", 0.94}});
            }),
            "a.json: herds[0].tuning.stretchSlow is 0.93 and stretchStop is 0.94, expected stretchStop to be "
            "at least stretchSlow + 0.02: the body slows down between them");
  // Both ends of what is asked for.
  EXPECT_NO_THROW(sceneWith({{"stretchStop", 0.95}}));
  EXPECT_NO_THROW(sceneWith({{"stepHeight", 0.3}, {"stepHeightMax", 0.3}}));
  for (const TuningOrder& order : allTuningOrders) {
    Tuning tuning;
    tuning.*order.moreMember = tuning.*order.lessMember + order.apart - 0.001f;
    const auto* info = std::ranges::find(allTunings, order.moreMember, &TuningInfo::member);
    if (tuning.*order.moreMember < info->least) continue;
    EXPECT_THAT(inputFault([&] { checkTuning(tuning, "tuning"); }),
                HasSubstr(fmt::format("tuning.{} is", order.less)));
  }
}

TEST(Tuning, RefusesWhatIsNoKeyAndNoNumber) {
  EXPECT_THAT(
      inputFault([] {
        sceneWith({{"stepHight", 0.2}});
      }),
      HasSubstr(
          "a.json: herds[0].tuning.stepHight is no known key; did you mean stepHeight? Expected one of "));
  EXPECT_EQ(inputFault([] {
              sceneWith({{"stepHeight", "high"}});
            }),
            "a.json: herds[0].tuning.stepHeight is \"high\", expected 0.01 to 1 leg lengths");
  EXPECT_EQ(inputFault([] {
              sceneWith({{"stepHeight", 1e300}});
            }),
            "a.json: herds[0].tuning.stepHeight is 1e+300, expected 0.01 to 1 leg lengths");
  EXPECT_THAT(inputFault([] { sceneWith(0.2); }),
              HasSubstr("a.json: herds[0].tuning is 0.2, expected an object"));
}

// The rows of docs/tuning.md.
std::string documentedTunings() {
  std::string rows;
  for (const TuningInfo& info : allTunings)
    rows += fmt::format("| `{}` | {} | {} | {} | {} to {} | {} | {} |\n", info.name, info.stage,
                        nameOf(info.unit), info.usual, info.least, info.most, info.does, info.breaks);
  return rows;
}
std::string documentedOrders() {
  std::string rows;
  for (const TuningOrder& order : allTuningOrders)
    rows += fmt::format("| `{}` | `{}`{} | {} |\n", order.more, order.less,
                        order.apart > 0 ? fmt::format(" + {}", order.apart) : "", order.why);
  return rows;
}

TEST(Tuning, IsDocumented) {
  const std::vector<uint8_t> bytes = test::readBytes(SKITTER_ROOT "/docs/tuning.md");
  const std::string document(bytes.begin(), bytes.end());
  for (const std::string& rows : {documentedTunings(), documentedOrders()})
    EXPECT_NE(document.find("|---|\n" + rows + "\n"), std::string::npos)
        << "docs/tuning.md lacks this table:\n"
        << rows;
}

}  // namespace
}  // namespace skitter
