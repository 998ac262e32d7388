#include "base/spelling.h"

#include <gtest/gtest.h>

#include "files.h"
#include "skitter/scene.h"

namespace skitter {
namespace {

using test::inputFault;

const std::vector<std::string> kNames{"agents", "goal", "spawn", "tuning"};

TEST(Spelling, DistanceCountsInsertedDroppedReplacedAndSwappedLetters) {
  EXPECT_EQ(base::editDistance("", ""), 0u);
  EXPECT_EQ(base::editDistance("", "abc"), 3u);
  EXPECT_EQ(base::editDistance("abc", ""), 3u);
  EXPECT_EQ(base::editDistance("speed", "speed"), 0u);
  EXPECT_EQ(base::editDistance("agent", "agents"), 1u);
  EXPECT_EQ(base::editDistance("sspeed", "speed"), 1u);
  EXPECT_EQ(base::editDistance("spaed", "speed"), 1u);
  EXPECT_EQ(base::editDistance("center", "centre"), 1u);
  EXPECT_EQ(base::editDistance("kitten", "sitting"), 3u);
  EXPECT_EQ(base::editDistance("abcd", "badc"), 2u);
  EXPECT_EQ(base::editDistance("ca", "abc"), 3u);  // a swapped pair is not edited once more
}

TEST(Spelling, AMessageNamesTheNearestOfSeveralNames) {
  EXPECT_EQ(base::expectedOneOf("agent", kNames),
            "; did you mean agents? Expected one of agents, goal, spawn, tuning");
  EXPECT_EQ(base::expectedOneOf("spwan", kNames, "\""),
            "; did you mean spawn? Expected one of \"agents\", \"goal\", \"spawn\", \"tuning\"");
  const std::vector<std::string> alike{"minHeights", "minHeight", "maxHeight"};
  EXPECT_EQ(base::expectedOneOf("minHeigt", alike).substr(0, 28), "; did you mean minHeight? Ex");
}

TEST(Spelling, NoNameIsNearWhereMoreThanAThirdOfTheLettersDiffer) {
  EXPECT_EQ(base::expectedOneOf("goat", kNames).substr(0, 20), "; did you mean goal?");
  EXPECT_EQ(base::expectedOneOf("goats", kNames), ", expected one of agents, goal, spawn, tuning");
  EXPECT_EQ(base::expectedOneOf("", kNames), ", expected one of agents, goal, spawn, tuning");
  EXPECT_EQ(base::expectedOneOf(std::string(1000, 'a'), kNames),
            ", expected one of agents, goal, spawn, tuning");
}

TEST(Spelling, ScenesNameTheNearestKeyAndTheNearestName) {
  const std::pair<const char*, const char*> cases[] = {
      {R"({"herds": [{"agent": 5}]})",
       "herds[0].agent is no known key; did you mean agents? Expected one of adapts, agents, avoid"},
      {R"({"herds": [{"goal": {"targets": [0, 0]}}]})",
       "herds[0].goal.targets is no known key; did you mean target? Expected one of agent, herd, kind"},
      {R"({"herds": [{"controller": "adaptiv"}]})",
       R"(controller is "adaptiv"; did you mean adaptive? Expected one of "adaptive", "loop")"},
      {R"({"herds": [{"spawn": {"kind": "lane"}}]})",
       R"(spawn.kind is "lane"; did you mean lanes? Expected one of "lanes", "grid")"},
      {R"({"herds": [{"controller": 5}]})", R"(controller is 5, expected one of "adaptive", "loop")"},
      {R"({"herds": [{"quantity": 5}]})",
       "herds[0].quantity is no known key, expected one of adapts, agents, avoid"},
  };
  for (const auto& [json, expected] : cases) {
    const std::string what = inputFault([&, text = json] { parseScene(text, "bad.json", ""); });
    EXPECT_NE(what.find(expected), std::string::npos) << what << "\nexpected: " << expected;
  }
}

}  // namespace
}  // namespace skitter
