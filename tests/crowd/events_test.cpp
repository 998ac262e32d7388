#include "crowd/events.h"

#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <utility>

#include "assets/files.h"
#include "crowd/herd.h"
#include "crowd/simulation.h"
#include "skitter/error.h"
#include "skitter/state.h"

namespace skitter::test {
namespace {

using ::testing::AllOf, ::testing::HasSubstr, ::testing::ThrowsMessage;

class EventsTest : public GpuTest {};

// The message of the Error(input) that the call throws, or "taken".
template <typename Call>
std::string outcomeOf(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::input);
    return error.what();
  }
  return "taken";
}

// The first has a reserve of 3 places, so the two are of two kinds.
Scene twoHerds() {
  Scene scene = sceneOf(20);
  scene.name = "two.json";
  scene.herds.push_back(scene.herds[0]);
  scene.herds[0].reserve = 3;
  return scene;
}
Goal pointAt(float x, float z) { return {.kind = Goal::Kind::point, .target = {x, z}, .speed = 2}; }

// Of two sizes, with places for more.
Herd guests(uint32_t agents = 9, Controller controller = Controller::adaptive) {
  Herd herd = sceneOf(agents, 1, 1, controller).herds[0];
  herd.reserve = 2;
  herd.sizes = {1, 0.6f};
  return herd;
}

TEST(Events, HappenBeforeTheFirstTickThatEndsThenOrLater) {
  std::vector<Event> events;
  for (const float at : {0.0f, 0.05f, 0.1f, 0.1f, 0.11f, 5.0f}) events.push_back({at, Mound{}});
  const auto counts = [&](double dt, uint64_t ticks) {
    std::vector<size_t> each;
    for (uint64_t tick = 1; tick <= ticks; ++tick) each.push_back(crowd::eventsAt(events, tick, dt).size());
    return each;
  };
  EXPECT_EQ(counts(0.1, 4), (std::vector<size_t>{4, 1, 0, 0}));
  EXPECT_EQ(counts(0.05, 4), (std::vector<size_t>{2, 2, 1, 0}));
  // 5 s are 300 ticks of a sixtieth, though neither is exact.
  EXPECT_EQ(crowd::eventsAt(events, 300, double{1.0f / 60}).size(), 1u);
  EXPECT_EQ(crowd::eventsAt(events, 301, double{1.0f / 60}).size(), 0u);
}

// What a scene says happens as if the caller did it.
TEST_F(EventsTest, AreWhatTheCallerCouldDo) {
  const Heightfield ground = rollingGround();
  Scene scene = sceneOf(40);
  Scene plain = scene;
  scene.events = {{0.25f, HeightSamples{60, 70, 2, 1, {1.5f, -1}}},
                  {0.5f, Mound{.centre = {1, 2}, .radius = 3, .height = -0.7f}}};
  Crowd crowd(device(), ground, scene), other(device(), ground, plain);
  const auto both = [&](int ticks) {
    simulate(device(), crowd, ticks);
    simulate(device(), other, ticks);
  };
  both(14);
  EXPECT_EQ(crowd.stateHash(), other.stateHash());
  other.editHeights(60, 70, 2, 1, std::vector<float>{1.5f, -1});
  both(1);
  EXPECT_EQ(crowd.terrain().heights, other.terrain().heights);
  EXPECT_EQ(crowd.terrain().heights[70 * ground.columns + 61], -1);
  both(14);
  EXPECT_EQ(crowd.stateHash(), other.stateHash());
  simulate(device(), crowd, 1);
  const Heightfield& edited = crowd.terrain();
  size_t changed = 0;
  for (uint32_t z = 0; z < ground.rows; ++z)
    for (uint32_t x = 0; x < ground.columns; ++x) {
      const size_t at = size_t{z} * ground.columns + x;
      const float before = other.terrain().heights[at], after = edited.heights[at];
      const double px = double{ground.originX()} + x * double{ground.spacingX} - 1;
      const double pz = double{ground.originZ()} + z * double{ground.spacingZ} - 2;
      const double inside = std::max(0.0, 1 - (px * px + pz * pz) / 9);
      ASSERT_NEAR(after - before, -0.7 * inside * inside, 1e-4) << x << ", " << z;
      changed += after != before;
    }
  EXPECT_GT(changed, 50u);
  EXPECT_TRUE(crowd.download(0).watched);
}

TEST_F(EventsTest, AboutAgentsAreWhatTheCallerCouldDo) {
  const Goal goal = pointAt(6, -3);
  const std::vector<Addition::Arrival> arrivals{{.place = {{4, 5}, 1}},
                                                {.place = {{-4, 5}, 2}, .goal = goal}};
  struct Asked {
    const char* name;
    decltype(Event::what) event;
    std::function<void(Crowd& crowd)> call;
  };
  const std::vector<Asked> cases{
      {"a goal", GoalChange{.herd = 1, .goal = goal}, [&](Crowd& crowd) { crowd.steer(1, goal); }},
      {"a goal of some", GoalChange{.agents = {5, 3}, .goal = goal},
       [&](Crowd& crowd) {
         const std::vector<AgentGoal> goals{{crowd.agentId(0, 5), goal}, {crowd.agentId(0, 3), goal}};
         crowd.steer(goals);
       }},
      {"a speed", SpeedChange{.herd = 1, .speed = 0.5f}, [](Crowd& crowd) { crowd.setSpeed(1, 0.5f); }},
      {"a speed of one", SpeedChange{.agents = {19}, .speed = 0.5f},
       [](Crowd& crowd) {
         const AgentSpeed slow{crowd.agentId(0, 19), 0.5f};
         crowd.setSpeed({&slow, 1});
       }},
      {"a teleport", Teleport{.herd = 1, .moves = {{2, {{7, 8}, 3}}, {11, {{9, -9}, 0}}}},
       [](Crowd& crowd) {
         crowd.teleport(crowd.agentId(1, 2), {{7, 8}, 3});
         crowd.teleport(crowd.agentId(1, 11), {{9, -9}, 0});
       }},
      {"who comes", Addition{.arrivals = arrivals},
       [&](Crowd& crowd) {
         crowd.add(0, arrivals[0].place);
         crowd.add(0, arrivals[1].place, goal);
       }},
      {"who goes", Removal{.agents = {7, 2}},
       [](Crowd& crowd) {
         crowd.remove(crowd.agentId(0, 7));
         crowd.remove(crowd.agentId(0, 2));
       }},
  };
  const Heightfield ground = rollingGround();
  Crowd plain(device(), ground, twoHerds());
  simulate(device(), plain, 14);
  const uint64_t before = plain.stateHash();
  simulate(device(), plain, 1);
  for (const Asked& each : cases) {
    SCOPED_TRACE(each.name);
    Scene scene = twoHerds();
    scene.events = {{0.25f, each.event}};
    Crowd crowd(device(), ground, scene), other(device(), ground, twoHerds());
    for (Crowd* one : {&crowd, &other}) simulate(device(), *one, 14);
    EXPECT_EQ(crowd.stateHash(), before);
    each.call(other);
    for (const int ticks : {1, 20}) {
      for (Crowd* one : {&crowd, &other}) simulate(device(), *one, ticks);
      EXPECT_EQ(crowd.stateHash(), other.stateHash());
      EXPECT_EQ(crowd.agentCount(), other.agentCount());
      if (ticks == 1) {
        EXPECT_NE(crowd.stateHash(), plain.stateHash());
      }
    }
  }
}

// Of events before one tick the later ones find what the earlier ones did, and of goals the last one counts.
TEST_F(EventsTest, HappenOneAfterTheOther) {
  Scene scene = twoHerds();
  scene.events = {{0.1f, Removal{.agents = {4, 6}}},
                  {0.1f, Addition{.arrivals = {{.place = {{3, 3}, 0}}}}},
                  {0.1f, Teleport{.moves = {{4, {{5, -5}, 0}}}}},
                  {0.1f, GoalChange{.goal = {.kind = Goal::Kind::none}}},
                  {0.1f, GoalChange{.agents = {4}, .goal = pointAt(0, 0)}}};
  Crowd crowd(device(), flatGround(), scene);
  simulate(device(), crowd, 6);
  EXPECT_EQ(crowd.agentCount(0), 19u);
  EXPECT_TRUE(crowd.has(AgentId(0, 4, 2)));
  EXPECT_FALSE(crowd.has(AgentId(0, 6, 0)));
  const HerdState state = crowd.download(0);
  EXPECT_NEAR(positionOf(state, 4).x, 5, 0.1);
  EXPECT_NEAR(positionOf(state, 4).z, -5, 0.1);
  for (size_t i = 0; i < 20; ++i)
    EXPECT_EQ(state.goal[8 * i + 6], i == 4   ? shared::GOAL_POINT
                                     : i == 6 ? shared::GOAL_CROSS
                                              : shared::GOAL_NONE)
        << i;
}

// As `skitter validate` has it, for a reference that begins with the state before the tick.
TEST_F(EventsTest, GiveTheSameBitsWhereTheyAreWrittenBeforeTheTick) {
  for (const Controller controller : allControllers) {
    SCOPED_TRACE(nameOf(controller));
    Scene scene = twoHerds();
    for (Herd& herd : scene.herds) herd.controller = controller;
    scene.events = {{0.1f, Mound{.centre = {5, -5}, .radius = 6}},
                    {0.1f, GoalChange{.agents = {2, 3}, .goal = pointAt(6, -3)}},
                    {0.1f, SpeedChange{.herd = 1, .speed = 2}},
                    {0.1f, Teleport{.herd = 1, .moves = {{4, {{5, -5}, 1}}}}},
                    {0.1f, Addition{.arrivals = {{.place = {{3, 3}, 0}}}}},
                    {0.1f, Removal{.agents = {7}}}};
    Crowd crowd(device(), rollingGround(), scene), early(device(), rollingGround(), scene);
    for (Crowd* each : {&crowd, &early}) simulate(device(), *each, 5);
    crowd::letEventsHappen(early);
    crowd::applyChanges(implOf(early));
    EXPECT_NE(early.stateHash(), crowd.stateHash());
    for (const int ticks : {1, 20}) {
      for (Crowd* each : {&crowd, &early}) simulate(device(), *each, ticks);
      EXPECT_EQ(early.stateHash(), crowd.stateHash());
      EXPECT_EQ(early.agentCount(), 40u);
    }
  }
}

TEST_F(EventsTest, OfHerdsAreWhatTheCallerCouldDo) {
  const Goal goal = pointAt(6, -3);
  const Place place{{4, 5}, 1};
  for (const Controller controller : allControllers) {
    SCOPED_TRACE(nameOf(controller));
    Scene scene = twoHerds();
    scene.events = {{0.1f, HerdAddition{guests(9, controller)}},
                    {0.2f, GoalChange{.herd = 2, .goal = goal}},
                    {0.2f, Addition{.herd = 2, .arrivals = {{.place = place}}}},
                    {0.3f, HerdRemoval{2}},
                    {0.3f, HerdAddition{guests(4)}}};
    Crowd crowd(device(), rollingGround(), scene), other(device(), rollingGround(), twoHerds());
    const auto both = [&](int ticks) {
      for (Crowd* each : {&crowd, &other}) simulate(device(), *each, ticks);
      EXPECT_EQ(crowd.stateHash(), other.stateHash()) << crowd.tick();
      EXPECT_EQ(crowd.agentCount(), other.agentCount()) << crowd.tick();
    };
    both(5);
    const HerdId came = other.addHerd(guests(9, controller));
    both(6);
    EXPECT_TRUE(crowd.has(came));
    EXPECT_EQ(crowd.agentCount(2), 9u);
    other.steer(2, goal);
    other.add(2, place);
    both(6);
    EXPECT_EQ(crowd.agentCount(2), 10u);
    other.removeHerd(came);
    const HerdId again = other.addHerd(guests(4));
    both(20);
    EXPECT_FALSE(crowd.has(came));
    EXPECT_TRUE(crowd.has(again));
    EXPECT_EQ(again, (HerdId{2, 2}));
  }
}

// As `skitter validate` has it, also where the tick that a herd comes in does more with it.
TEST_F(EventsTest, OfHerdsGiveTheSameBitsWhereTheyAreWrittenBeforeTheTick) {
  Scene scene = twoHerds();
  scene.events = {{0.1f, HerdAddition{guests()}},
                  {0.1f, Teleport{.herd = 2, .moves = {{1, {{5, -5}, 1}}}}},
                  {0.1f, Removal{.herd = 2, .agents = {0}}},
                  {0.1f, HerdRemoval{1}}};
  Crowd crowd(device(), rollingGround(), scene), early(device(), rollingGround(), scene);
  for (Crowd* each : {&crowd, &early}) simulate(device(), *each, 5);
  crowd::letEventsHappen(early);
  crowd::applyChanges(implOf(early));
  for (const int ticks : {1, 20}) {
    for (Crowd* each : {&crowd, &early}) simulate(device(), *each, ticks);
    EXPECT_EQ(early.stateHash(), crowd.stateHash());
    EXPECT_EQ(early.agentCount(), 28u);
    EXPECT_EQ(crowd.agentCount(), 28u);
  }
}

TEST_F(EventsTest, HerdsTakeTheLowestNumberThatIsFree) {
  Scene scene = twoHerds();
  scene.events = {{0.1f, HerdRemoval{0}},
                  {0.1f, HerdAddition{sceneOf(3).herds[0]}},
                  {0.1f, SpeedChange{.herd = 0, .agents = {2}, .speed = 2}},
                  {0.1f, HerdAddition{guests(4)}},
                  {0.1f, HerdRemoval{1}},
                  {0.2f, HerdRemoval{2}},
                  {0.2f, HerdAddition{guests(5)}}};
  Crowd crowd(device(), flatGround(), scene);
  simulate(device(), crowd, 11);
  EXPECT_EQ(crowd.herdId(0), (HerdId{0, 2}));
  EXPECT_EQ(crowd.agentCount(0), 3u);
  EXPECT_FALSE(crowd.has(HerdId{1, 0}));
  EXPECT_EQ(crowd.agentCount(2), 4u);
  simulate(device(), crowd, 1);
  EXPECT_EQ(crowd.agentCount(1), 5u);
  EXPECT_EQ(crowd.agentCount(), 8u);
  EXPECT_FALSE(crowd.has(HerdId{2, 0}));
}

// No file is read while the crowd runs.
TEST_F(EventsTest, FilesOfHerdsAreReadWhenTheCrowdIsMade) {
  TemporaryFolder folder;
  const std::string model = (folder / "own.glb").string();
  std::filesystem::copy_file(SKITTER_ROOT "/assets/spider.glb", model);
  Scene scene = twoHerds();
  for (const Controller controller : {Controller::adaptive, Controller::planted}) {
    Herd herd = guests(3, controller);
    herd.rig = model;
    scene.events.emplace_back(0.1f, HerdAddition{std::move(herd)});
  }
  Crowd crowd(device(), rollingGround(), scene);
  simulate(device(), crowd, 3);
  const State before = parseState(crowd.saveToMemory(), "a state");
  Crowd resumed(device(), before);
  std::filesystem::remove(model);
  for (Crowd* each : {&crowd, &resumed}) simulate(device(), *each, 10);
  EXPECT_EQ(crowd.agentCount(), 46u);
  EXPECT_EQ(crowd.rig(3).name, "own");
  EXPECT_EQ(resumed.stateHash(), crowd.stateHash());
  const auto names = AllOf(HasSubstr("two.json: events[0].addHerd: "), HasSubstr("own.glb"));
  EXPECT_THAT([&] { Crowd(device(), before); }, ThrowsMessage<Error>(names));
  EXPECT_THAT([&] { Crowd(device(), rollingGround(), scene); }, ThrowsMessage<Error>(names));
}

// It would end the run when the herd comes.
TEST_F(EventsTest, ATickThatIsTooShortForAHerdToComeIsRefusedAtOnce) {
  Scene scene = sceneOf(2, 1, 1, Controller::loop);
  const float dt = 1e-5f;
  Crowd without(device(), flatGround(), scene);
  simulate(device(), without, 1, dt);
  scene.events = {{1, HerdAddition{guests()}}};
  Crowd crowd(device(), flatGround(), scene);
  EXPECT_THROW(simulate(device(), crowd, 1, dt), Error);
  EXPECT_EQ(crowd.tick(), 0u);
}

TEST_F(EventsTest, WhereOneCannotHappenNoneDoes) {
  Scene scene = twoHerds();
  scene.events = {{0.1f, Mound{.radius = 4}},
                  {0.1f, Removal{.agents = {1}}},
                  {0.1f, Addition{.arrivals = std::vector<Addition::Arrival>(5)}},
                  {0.2f, GoalChange{.agents = {8, 9}}}};
  Crowd crowd(device(), flatGround(), scene);
  simulate(device(), crowd, 5);
  EXPECT_THAT([&] { simulate(device(), crowd, 1); },
              ThrowsMessage<Error>(HasSubstr(
                  "two.json: events[2].add[4]: all of the 23 places of herd 0 are taken, expected")));
  EXPECT_EQ(crowd.tick(), 5u);
  EXPECT_EQ(crowd.agentCount(0), 20u);
  EXPECT_EQ(crowd.terrain().heights, flatGround().heights);
  // The host makes room, and it goes on.
  crowd.remove(crowd.agentId(0, 9));
  simulate(device(), crowd, 6);
  EXPECT_EQ(crowd.agentCount(0), 23u);
  EXPECT_NE(crowd.terrain().heights, flatGround().heights);
  EXPECT_TRUE(crowd.has(AgentId(0, 9, 2)));
  crowd.remove(crowd.agentId(0, 9));
  EXPECT_THAT(
      [&] { simulate(device(), crowd, 1); },
      ThrowsMessage<Error>(HasSubstr("two.json: events[3]: herd 0, agent 9: nobody, expected one of 22")));
}

TEST_F(EventsTest, OfAHerdThatTheHostHasRemovedAreRefused) {
  Scene scene = twoHerds();
  scene.events = {{0.1f, SpeedChange{.herd = 1, .speed = 2}}};
  Crowd crowd(device(), flatGround(), scene);
  crowd.removeHerd(crowd.herdId(1));
  simulate(device(), crowd, 5);
  EXPECT_THAT([&] { simulate(device(), crowd, 1); },
              ThrowsMessage<Error>(HasSubstr("two.json: events[0]: herd 1 was removed")));
}

TEST_F(EventsTest, OfHerdsGoByWhatTheHostHasDone) {
  Scene scene = twoHerds();
  scene.events = {{0.1f, HerdAddition{guests()}}, {0.2f, Mound{.radius = 4}}, {0.2f, HerdAddition{guests(1)}},
                  {0.2f, HerdRemoval{2}},         {0.3f, Mound{.radius = 4}}, {0.3f, HerdAddition{guests(1)}},
                  {0.3f, HerdRemoval{3}}};
  Crowd crowd(device(), flatGround(), scene);
  simulate(device(), crowd, 8);
  crowd.removeHerd(crowd.herdId(2));
  // The herd that comes takes the number, and goes at once.
  simulate(device(), crowd, 9);
  EXPECT_EQ(crowd.agentCount(), 40u);
  const std::vector<float> heights = crowd.terrain().heights;
  EXPECT_NE(heights, flatGround().heights);
  EXPECT_THAT([&] { simulate(device(), crowd, 1); },
              ThrowsMessage<Error>(HasSubstr("two.json: events[6]: herd 3: expected one of the crowd's 3")));
  EXPECT_EQ(crowd.tick(), 17u);
  EXPECT_EQ(crowd.agentCount(), 40u);
  EXPECT_EQ(crowd.terrain().heights, heights);
  // The host makes one of that number, and it goes on.
  crowd.addHerd(guests(2));
  simulate(device(), crowd, 1);
  EXPECT_EQ(crowd.agentCount(), 42u);
  EXPECT_EQ(crowd.agentCount(2), 2u);
  EXPECT_FALSE(crowd.has(HerdId{3, 0}));
}

// A run that is saved and goes on has each of them once.
TEST_F(EventsTest, AStateNeitherRepeatsNorLosesThem) {
  Scene scene = twoHerds();
  scene.events = {{0.1f, Mound{.centre = {0, -100}, .radius = 6}},
                  {0.1f, Addition{.arrivals = {{.place = {{3, 3}, 0}}}}},
                  {0.2f, Removal{.agents = {4, 20}}},
                  {0.3f, Addition{.arrivals = {{.place = {{-3, 3}, 0}}}}},
                  {0.3f, Teleport{.herd = 1, .moves = {{4, {{5, -5}, 0}}}}},
                  {0.4f, Mound{.centre = {0, -100}, .radius = 5, .height = -1}},
                  {0.4f, SpeedChange{.speed = 3}}};
  Crowd whole(device(), rollingGround(), scene);
  simulate(device(), whole, 40);
  for (const int saved : {0, 11, 12, 23}) {
    Crowd first(device(), rollingGround(), scene);
    simulate(device(), first, saved);
    Crowd again(device(), parseState(first.saveToMemory(), "a state"));
    simulate(device(), again, 40 - saved);
    EXPECT_EQ(again.stateHash(), whole.stateHash()) << saved;
    EXPECT_EQ(again.terrain().heights, whole.terrain().heights) << saved;
    EXPECT_EQ(again.agentCount(), 40u) << saved;
  }
}

TEST_F(EventsTest, AStateNeitherRepeatsNorLosesThoseOfHerds) {
  Scene scene = twoHerds();
  scene.events = {{0.1f, HerdAddition{guests()}},
                  {0.2f, Addition{.herd = 2, .arrivals = {{.place = {{3, 3}, 0}}}}},
                  {0.3f, HerdRemoval{2}},
                  {0.3f, HerdRemoval{1}},
                  {0.4f, HerdAddition{guests(5, Controller::loop)}},
                  {0.5f, SpeedChange{.herd = 1, .agents = {0}, .speed = 3}}};
  Crowd whole(device(), rollingGround(), scene);
  simulate(device(), whole, 40);
  EXPECT_EQ(whole.agentCount(), 25u);
  for (const int saved : {0, 5, 6, 14, 17, 18, 23, 24, 35}) {
    SCOPED_TRACE(saved);
    Crowd first(device(), rollingGround(), scene);
    simulate(device(), first, saved);
    Crowd again(device(), parseState(first.saveToMemory(), "a state"));
    EXPECT_EQ(again.stateHash(), first.stateHash());
    simulate(device(), again, 40 - saved);
    EXPECT_EQ(again.stateHash(), whole.stateHash());
    EXPECT_EQ(again.agentCount(), 25u);
    EXPECT_TRUE(again.has(whole.herdId(1)));
    EXPECT_FALSE(again.has(HerdId{2, 0}));
  }
}

// Of a state between the events before a tick and the tick.
TEST_F(EventsTest, AStateDoesNotRepeatThoseThatHaveBegun) {
  Scene scene = twoHerds();
  scene.events = {{0.1f, Mound{.centre = {0, -10}, .radius = 6}},
                  {0.1f, Addition{.arrivals = {{.place = {{3, 3}, 0}}}}},
                  {0.1f, HerdAddition{guests()}},
                  {0.2f, Mound{.centre = {0, 10}, .radius = 6}}};
  Crowd whole(device(), rollingGround(), scene), first(device(), rollingGround(), scene);
  for (Crowd* each : {&whole, &first}) simulate(device(), *each, 5);
  crowd::letEventsHappen(first);
  Crowd again(device(), parseState(first.saveToMemory(), "a state"));
  for (Crowd* each : {&whole, &again}) simulate(device(), *each, 20);
  EXPECT_EQ(again.terrain().heights, whole.terrain().heights);
  EXPECT_EQ(again.agentCount(), whole.agentCount());
  EXPECT_EQ(again.stateHash(), whole.stateHash());
}

TEST_F(EventsTest, BeyondTheMapAreRefusedOrChangeNothing) {
  const Heightfield ground = flatGround();
  const auto fault = [&](Event event) -> std::string {
    Scene scene = sceneOf(2);
    scene.name = "late.json";
    scene.events = {{0, Mound{}}, std::move(event)};
    return outcomeOf([&] {
      Crowd crowd(device(), ground, scene);
      simulate(device(), crowd, 2);
    });
  };
  EXPECT_THAT(fault({0, HeightSamples{ground.columns - 1, 0, 2, 1, {0, 0}}}),
              HasSubstr("late.json: events[1].edit"));
  EXPECT_THAT(fault({std::numeric_limits<float>::quiet_NaN(), Mound{}}), HasSubstr("events[1].at is nan"));
  EXPECT_THAT(fault({0, Mound{.radius = 0}}), HasSubstr("events[1].mound"));
  EXPECT_EQ(fault({0, Mound{.centre = {4000, 4000}}}), "taken");
}

TEST_F(EventsTest, AboutNobodyAreRefusedWhenTheCrowdIsMade) {
  const auto faultOf = [&](const decltype(Event::what)& what) -> std::string {
    Scene scene = twoHerds();
    scene.events = {{0, Mound{}}, {9, what}};
    return outcomeOf([&] { Crowd(device(), flatGround(), scene); });
  };
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::string event = "two.json: events[1]";
  EXPECT_EQ(faultOf(GoalChange{.herd = 2}), event + ".herd is 2, expected less than 2, the number of herds");
  EXPECT_EQ(faultOf(GoalChange{.agents = {22, 23}}),
            event + ".agents[1] is 23, expected less than 23, the places of its herd");
  EXPECT_EQ(faultOf(GoalChange{.goal = {.speed = nan}}),
            event + ": goal.speed is nan m/s, expected 0 to 1000");
  EXPECT_EQ(faultOf(SpeedChange{.herd = 1, .agents = {20}, .speed = 1}),
            event + ".agents[0] is 20, expected less than 20, the places of its herd");
  EXPECT_EQ(faultOf(SpeedChange{.speed = -1}), event + ": the speed is -1 m/s, expected 0 to 1000");
  EXPECT_EQ(faultOf(Teleport{.moves = {{0, {}}, {}}}),
            event + ".teleport[1].agent is 4294967295, expected less than 23, the places of its herd");
  EXPECT_EQ(faultOf(Teleport{.moves = {{3, {{33, 0}, 0}}}}),
            event + ".teleport[0]: x is 33 m, expected -32 to 32");
  EXPECT_EQ(faultOf(Teleport{}), event + ".teleport has 0 agents, expected 1 to 65536");
  EXPECT_EQ(faultOf(Addition{.arrivals = {{}, {.place = {{0, 0}, nan}}}}),
            event + ".add[1]: the heading is nan radians, expected -1000 to 1000");
  EXPECT_EQ(faultOf(Addition{.arrivals = {{.goal = pointAt(0, 5000)}}}),
            event + ".add[0]: goal.target z is 5000 m, expected -4096 to 4096");
  const std::string noReserve =
      event + ": herd 1: its reserve is 0, expected at least 1 where agents come and go";
  EXPECT_EQ(faultOf(Addition{.herd = 1, .arrivals = {{}}}), noReserve);
  EXPECT_EQ(faultOf(Removal{.herd = 1, .agents = {0}}), noReserve);
  EXPECT_EQ(faultOf(Removal{.agents = {4, 1, 4}}), event + ".remove has agent 4 twice, expected once");
  EXPECT_EQ(faultOf(Removal{.agents = {4, 22}}), "taken");
}

TEST_F(EventsTest, OfHerdsThatCannotBeAreRefusedWhenTheCrowdIsMade) {
  const auto faultIn = [&](Scene scene, const std::vector<decltype(Event::what)>& events) -> std::string {
    for (const auto& what : events) scene.events.push_back({1, what});
    return outcomeOf([&] { Crowd(device(), flatGround(), scene); });
  };
  const auto faultOf = [&](const std::vector<decltype(Event::what)>& events) {
    return faultIn(twoHerds(), events);
  };
  const HerdAddition ten{sceneOf(10).herds[0]};
  const std::string first = "two.json: events[0]", second = "two.json: events[1]";
  EXPECT_EQ(faultOf({SpeedChange{.herd = 2}, ten}),
            first + ".herd is 2, expected less than 2, the number of herds");
  EXPECT_EQ(faultOf({ten, SpeedChange{.herd = 3}}),
            second + ".herd is 3, expected less than 3, the number of herds");
  EXPECT_EQ(faultOf({HerdRemoval{2}}), first + ".removeHerd is 2, expected less than 2, the number of herds");
  EXPECT_EQ(faultOf({HerdRemoval{1}, GoalChange{.herd = 1}}),
            second + ".herd is 1, a herd that was removed, expected one that is there");
  EXPECT_EQ(faultOf({HerdRemoval{1}, HerdRemoval{1}}),
            second + ".removeHerd is 1, a herd that was removed, expected one that is there");
  EXPECT_EQ(faultOf({ten, SpeedChange{.herd = 2, .agents = {10}}}),
            second + ".agents[0] is 10, expected less than 10, the places of its herd");
  EXPECT_EQ(faultOf({ten, Removal{.herd = 2, .agents = {1}}}),
            second + ": herd 2: its reserve is 0, expected at least 1 where agents come and go");
  EXPECT_EQ(faultOf({HerdRemoval{1}, ten, SpeedChange{.herd = 1, .agents = {9}}, HerdRemoval{1}}), "taken");

  const auto faultOfHerd = [&](const std::function<void(Herd&)>& spoil) {
    HerdAddition addition = ten;
    spoil(addition.herd);
    return faultOf({addition});
  };
  EXPECT_EQ(
      faultOfHerd([](Herd& herd) { herd.agents = Scene::maxAgents; }),
      first + ".addHerd: 16777216 agents and reserve beside 43 places, expected at most 16777216 in all");
  EXPECT_EQ(faultOfHerd([](Herd& herd) {
              herd.sizes = {1, 30};
            }),
            first + ".addHerd.sizes[1] is 30, expected 0.05 to 20");
  EXPECT_EQ(faultOfHerd([](Herd& herd) { herd.goal.speed = std::nanf(""); }),
            first + ".addHerd: goal.speed is nan m/s, expected 0 to 1000");
  EXPECT_EQ(faultOfHerd([](Herd& herd) { herd.spawn.spacing = 0; }),
            first + ".addHerd: spawn.spacing is 0 m, expected 0.01 to 4096");
  EXPECT_THAT(faultOfHerd([](Herd& herd) { herd.tuning.stepHeight = 1e9f; }),
              HasSubstr(first + ".addHerd.tuning.stepHeight"));
  EXPECT_THAT(faultOfHerd([](Herd& herd) { herd.rig = "nowhere.glb"; }),
              AllOf(HasSubstr(first + ".addHerd: "), HasSubstr("nowhere.glb")));

  HerdAddition sizes = ten;
  for (int size = 0; size < 16; ++size) sizes.herd.sizes.push_back(0.5f + 0.1f * static_cast<float>(size));
  EXPECT_EQ(
      faultOf(std::vector<decltype(Event::what)>(7, sizes)),
      "two.json: events[6].addHerd: 16 kinds of its own, one a size, beside 98, expected at most 100 in "
      "all");
  Scene equal = twoHerds();
  equal.herds[0].reserve = 0;
  EXPECT_EQ(faultIn(equal, {HerdRemoval{0}}),
            first +
                ".removeHerd: herd 0: shares pages with other herds, expected a herd of another kind or "
                "one with a reserve");
  equal.herds.push_back(ten.herd);
  equal.herds.back().controller = Controller::loop;
  EXPECT_EQ(faultIn(equal, {HerdRemoval{2}}), "taken");
}

// assets/scenes/events.json.
TEST_F(EventsTest, ExampleRuns) {
  const Scene scene = loadScene(SKITTER_ROOT "/assets/scenes/events.json");
  const Heightfield ground = scene.loadTerrain();
  Crowd crowd(device(), ground, scene);
  ASSERT_EQ(scene.events.size(), 3u);
  std::vector<float> before = ground.heights;
  for (const Event& event : scene.events) {
    const auto due = static_cast<int>(std::lround(60 * event.at)) - 1;
    simulate(device(), crowd, due - static_cast<int>(crowd.tick()));
    EXPECT_EQ(crowd.terrain().heights, before) << event.at;
    simulate(device(), crowd, 1);
    EXPECT_NE(crowd.terrain().heights, before) << event.at;
    before = crowd.terrain().heights;
  }
  EXPECT_LT(crowd.fidelity().penetration, 0.01);
}

// assets/scenes/steered.json.
TEST_F(EventsTest, ExampleOfAgentsRuns) {
  const Scene scene = loadScene(SKITTER_ROOT "/assets/scenes/steered.json");
  Crowd crowd(device(), scene.loadTerrain(), scene);
  simulate(device(), crowd, 90);
  EXPECT_EQ(crowd.agentCount(), 36u);
  const glm::dvec3 teleported = positionOf(crowd.download(0), 3);
  EXPECT_NEAR(teleported.x, 12, 0.1);
  EXPECT_NEAR(teleported.z, -12, 0.1);
  simulate(device(), crowd, 30);
  EXPECT_EQ(crowd.agentCount(), 33u);
  EXPECT_FALSE(crowd.has(AgentId(1, 11, 2)));
  EXPECT_LT(crowd.fidelity().penetration, 0.01);
}

// assets/scenes/waves.json.
TEST_F(EventsTest, ExampleOfHerdsRuns) {
  const Scene scene = loadScene(SKITTER_ROOT "/assets/scenes/waves.json");
  Crowd crowd(device(), scene.loadTerrain(), scene);
  const auto agentsAfter = [&](int tick) {
    simulate(device(), crowd, tick - static_cast<int>(crowd.tick()));
    return crowd.agentCount();
  };
  EXPECT_EQ(agentsAfter(29), 8u);
  EXPECT_EQ(agentsAfter(30), 24u);
  EXPECT_EQ(agentsAfter(60), 25u);
  EXPECT_EQ(agentsAfter(89), 25u);
  EXPECT_EQ(agentsAfter(90), 14u);
  EXPECT_EQ(crowd.herdId(1), (HerdId{1, 2}));
  EXPECT_EQ(agentsAfter(120), 14u);
  EXPECT_LT(crowd.fidelity().penetration, 0.01);
}

}  // namespace
}  // namespace skitter::test
