#include <gtest/gtest.h>

#include "skitter/clip.h"

// Which clips a herd plays that names none: lists of clips as model makers ship them.
namespace skitter {
namespace {

struct Named {
  const char* name;
  float speed;
};

std::string chosenOf(std::initializer_list<Named> clips) {
  ClipSet set;
  for (const Named& from : clips) {
    set.clips.emplace_back();
    set.clips.back().name = from.name;
    set.clips.back().speed = from.speed;
  }
  std::string names;
  for (const Clip* clip : set.locomotion()) names += (names.empty() ? "" : ", ") + clip->name;
  return names;
}

TEST(ClipChoice, GaitsFromSlowToFastAndTheFirstThatIdles) {
  EXPECT_EQ(chosenOf({{"Gallop", 3}, {"Eyes", 0}, {"Idle", 0}, {"Idle_2", 0}, {"Walk", 1}}),
            "Walk, Gallop, Idle");
  EXPECT_EQ(chosenOf({{"Survey", 0}, {"Walk", 1}, {"Run", 2}}), "Walk, Run, Survey");
}

TEST(ClipChoice, NeverAnAttackOrADeath) {
  EXPECT_EQ(chosenOf({{"SpiderArmature|Spider_Attack", 0.9f},
                      {"SpiderArmature|Spider_Death", 1},
                      {"SpiderArmature|Spider_Idle", 0},
                      {"SpiderArmature|Spider_Jump", 2},
                      {"SpiderArmature|Spider_Walk", 1.4f}}),
            "SpiderArmature|Spider_Walk, SpiderArmature|Spider_Idle");
  EXPECT_EQ(chosenOf({{"Attack_Headbutt", 0},
                      {"Death", 0.3f},
                      {"Gallop_Jump", 3},
                      {"HitReact_Left", 0.1f},
                      {"Jump_toIdle", 0},
                      {"Dying", 1},
                      {"runAttack", 2}}),
            "");
}

TEST(ClipChoice, AWordMustBeginAsAnActionDoes) {
  // "death" is in no word of these, nor is "eat" or "hit".
  EXPECT_EQ(chosenOf({{"Breathe", 0}, {"White Walker", 1}}), "White Walker, Breathe");
}

TEST(ClipChoice, NamelessClipsOnlyWhereNoneIsNamedAsAGait) {
  EXPECT_EQ(chosenOf({{"A", 1}, {"Take 001", 2}, {"B", 0}}), "A, Take 001, B");
  EXPECT_EQ(chosenOf({{"Wobble", 1}, {"Crawl", 0.5f}, {"Bow", 0}}), "Crawl, Bow");
}

TEST(ClipChoice, AFasterGaitMustBeFaster) {
  EXPECT_EQ(chosenOf({{"Gallop", 0.8f}, {"Walk", 1}, {"Trot", 2}}), "Walk, Trot");
  EXPECT_EQ(chosenOf({{"Gallop", 0.8f}, {"Idle", 0}}), "Gallop, Idle");
}

TEST(ClipChoice, BackwardIsNoWay) { EXPECT_EQ(chosenOf({{"Walk_Back", -1}, {"Walk", 1}}), "Walk"); }

}  // namespace
}  // namespace skitter
