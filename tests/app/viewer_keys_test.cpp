#include <gmock/gmock.h>

#include <fstream>
#include <set>
#include <sstream>

#include "app/viewer/keys.h"
#include "app/viewer/pace.h"

namespace skitter::app {
namespace {

TEST(Keys, EachDoesOneThing) {
  std::set<int> keys;
  std::set<Action> actions;
  for (const KeyRow& row : keyRows()) {
    EXPECT_EQ(row.key == 0, row.action == Action::none) << row.name;
    if (row.key == 0) continue;
    EXPECT_TRUE(keys.insert(row.key).second) << row.name;
    EXPECT_TRUE(actions.insert(row.action).second) << row.name;
    EXPECT_EQ(actionOf(row.key), row.held ? std::nullopt : std::optional(row.action)) << row.name;
  }
  EXPECT_FALSE(actionOf(0));
  for (int action = 1; action <= static_cast<int>(Action::close); ++action)
    EXPECT_EQ(actions.count(static_cast<Action>(action)), 1u) << action;
}

TEST(Keys, OneToFiveAreTheControllers) {
  for (size_t i = 0; i < allControllers.size(); ++i)
    EXPECT_EQ(controllerOf(actionOf(static_cast<int>('1' + i)).value()), allControllers[i]);
  EXPECT_FALSE(controllerOf(Action::restart));
}

TEST(Keys, TheDocumentHasThemAll) {
  std::ifstream file(SKITTER_ROOT "/docs/viewer.md");
  std::string line;
  std::vector<std::string> documented, rows;
  while (std::getline(file, line))
    if (line.starts_with("| **")) documented.push_back(line);
  for (const KeyRow& row : keyRows())
    rows.push_back(std::string("| **") + row.name + "** | " + row.text + " |");
  EXPECT_EQ(documented, rows);
}

uint64_t ticksIn(Pace& pace, int frames) {
  uint64_t ticks = 0;
  for (int i = 0; i < frames; ++i) ticks += pace.ticks();
  return ticks;
}

TEST(Pace, GoesFromASixteenthToSixteenTimes) {
  Pace pace(1, false);
  EXPECT_EQ(ticksIn(pace, 32), 32u);
  for (int i = 0; i < 9; ++i) pace.slower();
  EXPECT_EQ(pace.speed(), 1.0 / 16);
  EXPECT_EQ(ticksIn(pace, 32), 2u);
  for (int i = 0; i < 19; ++i) pace.faster();
  EXPECT_EQ(pace.speed(), 16);
  EXPECT_EQ(ticksIn(pace, 32), 512u);
}

TEST(Pace, PausesAndSteps) {
  Pace pace(3, true);
  EXPECT_EQ(ticksIn(pace, 5), 0u);
  pace.step();
  pace.step();
  EXPECT_EQ(ticksIn(pace, 5), 2u);
  EXPECT_TRUE(pace.paused());
  pace.pause();
  EXPECT_EQ(ticksIn(pace, 5), 15u);
  pace.step();
  EXPECT_TRUE(pace.paused());
  EXPECT_EQ(ticksIn(pace, 5), 1u);
  pace.step();
  pace.forget();
  EXPECT_EQ(ticksIn(pace, 5), 0u);
}

}  // namespace
}  // namespace skitter::app
