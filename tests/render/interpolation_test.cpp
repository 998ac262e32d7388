// How slow agents are shown between their ticks, held against docs/levels.md, Pictures: a straight way at an
// even speed from where the last tick found an agent to where it left it.
#include "render/interpolation.h"

#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <numbers>
#include <numeric>
#include <random>

#include "gpu/submit.h"
#include "gpu/transfer.h"
#include "render/clip_poses.h"
#include "render/pictures.h"
#include "skitter/records.h"
#include "support/gpu_fixture.h"
#include "support/rounding.h"

namespace skitter::render {
namespace {

constexpr uint32_t kPalette = 3;
constexpr float kMostTurn = 0.1f;  // radians, from one tick to the next

// An agent's state after one of its ticks. Its bones turn about one axis each, so that angles can be added.
struct State {
  glm::dvec3 place;  // world
  std::array<double, kPalette> angles;
  std::array<glm::dvec3, kPalette> starts;
};

State operator+(const State& a, const State& b) {
  State sum = a;
  sum.place += b.place;
  for (size_t i = 0; i < kPalette; ++i) sum.angles[i] += b.angles[i], sum.starts[i] += b.starts[i];
  return sum;
}
State operator*(double share, const State& s) {
  State part{share * s.place, {}, {}};
  for (size_t i = 0; i < kPalette; ++i)
    part.angles[i] = share * s.angles[i], part.starts[i] = share * s.starts[i];
  return part;
}

// An agent as the crowd and the test know it.
struct Agent {
  State now{};
  int level = 0;
  uint64_t tick = 0;  // its last one
  uint64_t put = 0;   // before that tick it was put where it is
  // The way that it is on in pictures.
  State from{};
  uint64_t left = 0, arrives = 0;
  std::optional<uint64_t> shown;  // the last picture's tick that it was in

  bool isHidden() const { return put > tick; }
  State at(uint64_t picture) const {
    if (picture >= arrives) return now;
    const double share = double(picture - left) / double(arrives - left);
    return from + share * (now + -1.0 * from);
  }
};

// A row of the matrix that the entry has in a palette of matrices. It is linear in the state, as places are.
glm::dvec4 rowOf(const State& state, size_t entry, int row) {
  return double(row + 1) * glm::dvec4(state.starts[entry], state.angles[entry]);
}

glm::dvec3 axisOf(size_t entry) {
  return glm::normalize(glm::dvec3(0.3, 1.0 - 0.4 * double(entry), 0.2 + 0.5 * double(entry)));
}

class InterpolationTest : public test::GpuLoadTest {
 protected:
  static std::string named(uint32_t seed, int picture, uint32_t agent) {
    return "seed " + std::to_string(seed) + ", picture " + std::to_string(picture) + ", agent " +
           std::to_string(agent);
  }

  struct Random {
    std::mt19937 draw;
    double operator()(double from, double to) {
      return std::uniform_real_distribution<double>(from, to)(draw);
    }
  };

  // `pictures` pictures of so many agents, some ticks after each other; those that are in a picture change.
  void expectEvenWays(uint32_t count, int pictures, uint32_t seed, bool matrices) {
    const int stride = matrices ? shared::MATRIX_STRIDE : shared::POSE_STRIDE;
    Random random{std::mt19937(seed)};
    std::vector<Agent> agents(count);
    for (Agent& agent : agents) {
      // About the corner of four tiles far from the origin.
      agent.now.place = glm::dvec3(-800 + random(-1, 1), random(-9, 9), 1600 + random(-1, 1));
      for (size_t i = 0; i < kPalette; ++i) {
        agent.now.angles[i] = random(-3, 3);
        agent.now.starts[i] = {random(-1, 1), random(-1, 1), random(-1, 1)};
      }
    }
    const gpu::Buffer body(context(), count * shared::BODY_STRIDE * sizeof(glm::vec4), "bodies");
    const gpu::Buffer pose(context(), count * kPalette * uint32_t(stride) * sizeof(glm::vec4), "poses");
    const gpu::Buffer rate(context(), count * shared::RATE_STRIDE * sizeof(glm::vec4), "rates");
    const Interpolation interpolation(context());
    const Interpolation::Source live{body, pose, rate, matrices};
    Interpolation::Page page = interpolation.makePage(context(), live);
    CulledPage culled;
    culled.agents = count;
    culled.listsShown = true;
    culled.instances =
        gpu::Buffer(context(), uint64_t(count) * shared::INSTANCE_LISTS * sizeof(uint32_t), "lists");
    culled.commands = gpu::Buffer(context(), shared::INSTANCE_LISTS * sizeof(ListDispatch), "commands",
                                  gpu::BufferUse::indirect);
    interpolation.bindLists(context(), live, culled, page);

    uint64_t tick = 0;
    std::optional<uint64_t> before;
    for (int picture = 0; picture < pictures; ++picture) {
      const uint64_t ticks = uint64_t(random(0, 3.99));
      for (uint64_t t = 0; t < ticks; ++t) {
        ++tick;
        for (uint32_t a = 0; a < count; ++a) tickOf(agents[a], a, tick, random);
      }
      std::vector<uint32_t> list;
      for (uint32_t a = 0; a < count; ++a)
        if (random(0, 1) < 0.8 && !agents[a].isHidden()) list.push_back(a);
      const std::vector<glm::vec4> records = upload(agents, body, pose, rate, matrices);
      std::vector<uint32_t> instances(size_t(count) * shared::INSTANCE_LISTS);
      std::ranges::copy(list, instances.begin() + long(count) * shared::SHOWN);
      std::vector<ListDispatch> commands(shared::INSTANCE_LISTS);
      commands[shared::SHOWN].agents = uint32_t(list.size());
      commands[shared::SHOWN].groups.x = gpu::groupsFor(uint32_t(list.size()), shared::WORK_GROUP);
      gpu::upload(context(), culled.instances, instances);
      gpu::upload(context(), culled.commands, commands);
      const shared::InterpolationConstants constants{.agents = count,
                                                     .palette = kPalette,
                                                     .tick = float(tick),
                                                     .before = before ? float(*before) : -1.0f};
      gpu::submitAndWait(context(), [&](vk::CommandBuffer cmd) {
        interpolation.recordBodies(cmd, page, constants);
        gpu::computeToIndirectAndCompute(cmd);
        interpolation.recordPoses(cmd, page, culled, constants);
        gpu::allToAll(cmd);
      });

      const auto bodies = gpu::download<glm::vec4>(context(), page.body);
      const auto poses = gpu::download<glm::vec4>(context(), page.pose);
      for (uint32_t a = 0; a < count; ++a) {
        Agent& agent = agents[a];
        // An agent that was not in the last picture is where its tick left it.
        if (!before || agent.shown != before) agent.left = agent.arrives = 0;
        const size_t at = size_t(a) * shared::BODY_STRIDE;
        if (agent.isHidden()) {
          EXPECT_EQ(bodies[at].y, shared::ABSENT_HEIGHT) << named(seed, picture, a);
          continue;
        }
        if (tick >= agent.arrives) {
          EXPECT_EQ(bodies[at], records[at]) << named(seed, picture, a);
        }
        expectPlace(agent.at(tick), bodies[size_t(a) * shared::BODY_STRIDE], seed, picture, a);
      }
      for (const uint32_t a : list) {
        const glm::vec4* entries = &poses[size_t(a) * kPalette * size_t(stride)];
        if (matrices) {
          expectMatrices(agents[a].at(tick), entries, seed, picture, a);
        } else {
          expectPose(agents[a].at(tick), entries, seed, picture, a);
        }
        agents[a].shown = tick;
      }
      before = tick;
      if (HasFailure()) return;
    }
  }

 private:
  // A tick of the crowd, in which the agent has a turn or not, as wake says.
  static void tickOf(Agent& agent, uint32_t number, uint64_t tick, Random& random) {
    if (random(0, 1) < 0.02) {
      agent.now.place += glm::dvec3(random(-9, 9), 0, random(-9, 9));
      agent.put = tick;
      agent.shown.reset();
      agent.left = agent.arrives = 0;
    }
    const uint64_t turn = tick + number / shared::BLOCK;
    if (turn % (uint64_t{1} << agent.level) != 0) return;
    int level = int(random(0, 3.99));
    while (turn % (uint64_t{1} << level) != 0) --level;
    // It sets out from where the last picture showed it, when that was.
    const uint64_t picture = agent.shown.value_or(0);
    agent.from = agent.at(picture);
    agent.left = picture;
    agent.arrives = tick + (uint64_t{1} << level) - 1;
    agent.level = level;
    agent.tick = tick;
    agent.now.place += glm::dvec3(random(-0.2, 0.2), random(-0.1, 0.1), random(-0.2, 0.2));
    for (size_t i = 0; i < kPalette; ++i) {
      agent.now.angles[i] += random(-double(kMostTurn), double(kMostTurn));
      agent.now.starts[i] += glm::dvec3(random(-0.1, 0.1), random(-0.1, 0.1), random(-0.1, 0.1));
    }
  }

  // Returns the bodies.
  std::vector<glm::vec4> upload(const std::vector<Agent>& agents, const gpu::Buffer& body,
                                const gpu::Buffer& pose, const gpu::Buffer& rate, bool matrices) {
    std::vector<glm::vec4> bodies(agents.size() * shared::BODY_STRIDE), rates(agents.size()), poses;
    for (size_t a = 0; a < agents.size(); ++a) {
      const Agent& agent = agents[a];
      const glm::dvec3 tile = glm::floor(agent.now.place / double(shared::TILE_SIZE));
      bodies[a * shared::BODY_STRIDE] = {
          glm::vec3(agent.now.place - glm::dvec3(tile.x, 0, tile.z) * double(shared::TILE_SIZE)),
          shared::packedTile(float(tile.x), float(tile.z))};
      rates[a] = {float(agent.level), 0, float(agent.tick), float(agent.put)};
      for (size_t i = 0; i < kPalette; ++i) {
        if (matrices) {
          for (int r = 0; r < shared::MATRIX_STRIDE; ++r) poses.emplace_back(rowOf(agent.now, i, r));
          continue;
        }
        // The host does not care which of a rotation's two quaternions it gives.
        const double half = 0.5 * agent.now.angles[i], sign = (agent.tick + i) % 2 == 0 ? 1 : -1;
        poses.emplace_back(sign * glm::dvec4(axisOf(i) * std::sin(half), std::cos(half)));
        poses.emplace_back(glm::vec3(agent.now.starts[i]), 0.0f);
      }
    }
    gpu::upload(context(), body, bodies);
    gpu::upload(context(), pose, poses);
    gpu::upload(context(), rate, rates);
    return bodies;
  }

  // Numbers below 32 are rounded by at most 2^-20 in each of a few operations; what earlier pictures rounded
  // fades with the way that is left.
  static constexpr double kRounding = 8e-6;

  static void expectPlace(const State& expected, const glm::vec4& shown, uint32_t seed, int picture,
                          uint32_t agent) {
    const glm::dvec3 place =
        glm::dvec3(shown) +
        double(shared::TILE_SIZE) * glm::dvec3(shared::tileX(shown.w), 0, shared::tileZ(shown.w));
    EXPECT_LT(glm::distance(place, expected.place), kRounding) << named(seed, picture, agent);
  }

  static void expectMatrices(const State& expected, const glm::vec4* rows, uint32_t seed, int picture,
                             uint32_t agent) {
    for (size_t i = 0; i < kPalette; ++i)
      for (int r = 0; r < shared::MATRIX_STRIDE; ++r)
        EXPECT_LT(glm::distance(glm::dvec4(*rows++), rowOf(expected, i, r)), kRounding)
            << named(seed, picture, agent) << ", entry " << i << ", row " << r;
  }

  static void expectPose(const State& expected, const glm::vec4* entries, uint32_t seed, int picture,
                         uint32_t agent) {
    // Normalised means of quaternions a turn of x apart stray from an even turn by at most 0.004 x^3. A way
    // has at most eight parts, and is at most as long as the turns of three ticks and of the way that was
    // left. The cosine of an angle is rounded by 2^-23.
    const double stray = 8 * 0.004 * std::pow(4 * double(kMostTurn), 3) + 2 * std::sqrt(2 * 0x1p-23);
    for (size_t i = 0; i < kPalette; ++i) {
      const glm::dvec4 rotation(entries[i * shared::POSE_STRIDE]);
      const double half = 0.5 * expected.angles[i];
      const glm::dvec4 wanted(axisOf(i) * std::sin(half), std::cos(half));
      EXPECT_NEAR(glm::length(rotation), 1, 1e-6) << named(seed, picture, agent);
      EXPECT_LT(2 * std::acos(std::min(1.0, std::abs(glm::dot(rotation, wanted)))), stray)
          << named(seed, picture, agent) << ", entry " << i;
      EXPECT_LT(glm::distance(glm::dvec3(entries[i * shared::POSE_STRIDE + 1]), expected.starts[i]),
                kRounding)
          << named(seed, picture, agent) << ", entry " << i;
    }
  }
};
INSTANTIATE_TEST_SUITE_P(Loads, InterpolationTest, test::bothLoadPaths(), test::loadPathName);

TEST_P(InterpolationTest, waysBetweenTicksAreEven) {
  for (const bool matrices : {false, true})
    for (const uint32_t count : {1u, 9u, 131u}) expectEvenWays(count, 60, 40 + count, matrices);
}

// A block at an eighth of the rate, which ticks in every eighth tick of the crowd. It sets out at the first
// of them in sight.
class SlowAgentsTest : public test::GpuTest, public ::testing::WithParamInterface<Controller> {};
INSTANTIATE_TEST_SUITE_P(, SlowAgentsTest, ::testing::ValuesIn(allControllers), [](const auto& each) {
  std::string name(nameOf(each.param));
  std::erase(name, '-');
  return name;
});

TEST_P(SlowAgentsTest, moveInEveryPicture) {
  Scene scene = test::smallScene(shared::BLOCK);
  scene.herds[0].controller = GetParam();
  scene.herds[0].spawn = Spawn{.kind = Spawn::Kind::grid, .spacing = 2};
  scene.levels = Levels{.distances = {0, 0, 0}, .most = {0, 0, 0}};
  const View view{.eye = {2, 5, -13}, .target = {0, 0, 1}};
  for (const bool pose : {true, false}) {
    if (!pose && Renderer::needsPoses(scene)) continue;
    SCOPED_TRACE(pose ? "with poses" : "without");
    test::Stage stage(device(), scene, scene.loadTerrain(), 160, 90, {}, {.pose = pose});
    stage.crowd.lookFrom(view.eye);
    stage.tick(24);
    test::Picture last = stage.draw(view);
    EXPECT_EQ(test::differing(last, stage.draw(view)), 0u);
    std::vector<double> differences;
    for (int picture = 0; picture < 40; ++picture) {
      stage.tick(1);
      const test::Picture next = stage.draw(view);
      double sum = 0;
      for (size_t i = 0; i < next.rgba.size(); ++i) sum += std::abs(int(next.rgba[i]) - int(last.rgba[i]));
      if (picture >= 8) differences.push_back(sum);
      last = next;
    }
    std::ranges::sort(differences);
    const double median = differences[differences.size() / 2];
    // Planted feet stand still, and then all of a group go on: the walk itself is less even. So are clips
    // that are shown at times of their own, as they are at full rate. A GPU's samples show 2.03 medians.
    EXPECT_GT(differences.front(), (!pose ? 0.3 : GetParam() == Controller::planted ? 0.4 : 0.5) * median);
    EXPECT_LT(differences.back(), (context().isCpu() ? 2 : 2.5) * median);
  }
}

// Where the crowd keeps poses of agents that play clips, pictures are of these, else they are made for each
// picture: the same, also while agents fade from a clip to another. What slow agents' poses are on the way
// differs, for the one is a mean of matrices and the other a time of the clip.
TEST_P(InterpolationTest, clipsArePosedAsTheCrowdPosesThem) {
  Scene scene = test::smallScene(40);
  scene.herds[0].controller = Controller::clip;
  scene.herds[0].spawn = Spawn{.kind = Spawn::Kind::grid, .spacing = 2};
  scene.herds[0].colour = glm::vec3(0.1f, 0.3f, 0.6f);
  const View view{.eye = {2, 5, -9}, .target = {0, 0, 1}};
  test::Stage with(device(), scene, scene.loadTerrain(), 320, 180);
  test::Stage without(device(), scene, scene.loadTerrain(), 320, 180, {}, {.pose = false});
  // Where kernels round differently, an edge may take another pixel.
  const size_t most = test::kernelsRoundAlike(device()) ? 0 : 320 * 180 / 200;
  for (int picture = 0; picture < 12; ++picture) {
    for (test::Stage* stage : {&with, &without}) stage->tick(picture % 3);
    EXPECT_LE(test::differing(with.draw(view), without.draw(view)), most) << picture;
  }
}

// The clips of a kind, as docs/stages/clip.md plays them, in doubles.
class PlayedClips {
 public:
  explicit PlayedClips(const crowd::ClipRecords& clips) : clips_(clips) {}

  // A row of a joint's matrix at a time of a clip.
  glm::dvec4 row(int clip, double time, int joint, int r) const {
    const double seconds = clips_.heads[size_t(clip) * 4 + 2];
    if (seconds > 0) time -= std::floor(time / seconds) * seconds;
    const auto first = size_t(clips_.heads[size_t(clip) * 4]),
               frames = size_t(clips_.heads[size_t(clip) * 4 + 1]);
    const auto timeOf = [&](size_t frame) { return double(clips_.times[(first + frame) * 4]); };
    size_t f = 0;
    while (f + 1 < frames && timeOf(f + 1) <= time) ++f;
    const auto rowAt = [&](size_t frame) {
      const float* from =
          &clips_.rows[(((first + frame) * size_t(clips_.joints) + size_t(joint)) * 3 + size_t(r)) * 4];
      return glm::dvec4(from[0], from[1], from[2], from[3]);
    };
    if (f + 1 == frames) return rowAt(f);
    return glm::mix(rowAt(f), rowAt(f + 1), (time - timeOf(f)) / (timeOf(f + 1) - timeOf(f)));
  }
  int joints() const { return clips_.joints; }

 private:
  const crowd::ClipRecords& clips_;
};

// Agents of every rate that begin to walk, so that they fade from clip to clip, and turn: each picture shows
// each at a time between two of its ticks (docs/levels.md, Pictures).
TEST_P(InterpolationTest, clipsAreShownAtTimesBetweenTicks) {
  constexpr uint32_t agents = 41;
  Scene scene = test::smallScene(agents);
  scene.herds[0].controller = Controller::clip;
  scene.herds[0].spawn = Spawn{.kind = Spawn::Kind::grid, .spacing = 2};
  scene.levels = Levels{.distances = {5, 10, 15}, .most = {16, 16, 1000}};
  Crowd crowd(device(), scene.loadTerrain(), scene, {.pose = false, .measure = false});
  const crowd::Kind& kind = implOf(crowd).kinds.front();
  const crowd::Page& page = kind.pages.front();
  const Interpolation interpolation(context());
  const Interpolation::Source live{page.body, page.pose, page.rate};
  const Interpolation::Page shown = interpolation.makePage(context(), live);
  CulledPage culled;
  culled.agents = agents;
  culled.instances = gpu::Buffer(context(), agents * shared::INSTANCE_LISTS * sizeof(uint32_t), "lists");
  culled.commands = gpu::Buffer(context(), shared::INSTANCE_LISTS * sizeof(ListDispatch), "commands",
                                gpu::BufferUse::indirect);
  std::vector<uint32_t> instances(size_t(agents) * shared::INSTANCE_LISTS);
  std::iota(instances.begin() + long(agents) * shared::SHOWN,
            instances.begin() + long(agents) * (shared::SHOWN + 1), 0u);
  std::vector<ListDispatch> commands(shared::INSTANCE_LISTS);
  commands[shared::SHOWN].agents = agents;
  commands[shared::SHOWN].groups.x = 1;
  gpu::upload(context(), culled.instances, instances);
  gpu::upload(context(), culled.commands, commands);
  const ClipPoses clipPoses(context(), kind, true);
  const gpu::Buffer poses = clipPoses.makePoses(context(), agents);
  const gpu::Bindings bindings = clipPoses.bind(context(), kind, page, shown.body, culled, poses);

  const PlayedClips played(kind.clips);
  const double dt = 1.0 / 60, fade = dt / scene.herds[0].tuning.fadeTime;
  std::vector<double> ticks(agents);  // at which each was shown
  std::vector<glm::dquat> turns(agents, glm::dquat(1, 0, 0, 0));
  std::optional<uint64_t> before;
  size_t between = 0, fading = 0;
  for (int picture = 0; picture < 70; ++picture) {
    for (int tick = 0; tick < picture % 3; ++tick) {
      crowd.lookFrom({12 * std::sin(0.02f * float(crowd.tick())), 3, -9});
      device().run([&](VkCommandBuffer cmd) { crowd.record(cmd, float(dt)); });
    }
    const uint64_t now = crowd.tick();
    const shared::InterpolationConstants constants{
        .agents = agents, .palette = 0, .tick = float(now), .before = before ? float(*before) : -1.0f};
    gpu::submitAndWait(context(), [&](vk::CommandBuffer cmd) {
      interpolation.recordBodies(cmd, shown, constants);
      gpu::computeToIndirectAndCompute(cmd);
      clipPoses.record(cmd, bindings, kind, culled, now);
      gpu::allToAll(cmd);
    });
    const auto bodies = gpu::download<glm::vec4>(context(), page.body),
               rates = gpu::download<glm::vec4>(context(), page.rate),
               plays = gpu::download<glm::vec4>(context(), page.play),
               rows = gpu::download<glm::vec4>(context(), poses);
    for (uint32_t a = 0; a < agents; ++a) {
      const double last = rates[a].z, arrives = last + std::exp2(double(rates[a].x)) - 1;
      const bool goes = before && double(now) < arrives;
      const double share = goes ? double(now - *before) / (arrives - double(*before)) : 1;
      const glm::vec4& q = bodies[a * shared::BODY_STRIDE + 2];
      const glm::dquat turn(q.w, q.x, q.y, q.z);
      ticks[a] = std::lerp(ticks[a], last, share);
      turns[a] =
          glm::normalize((1 - share) * (glm::dot(turns[a], turn) < 0 ? -turns[a] : turns[a]) + share * turn);
      const glm::vec4 *play = &plays[a * shared::PLAY_STRIDE], &rate = play[1];
      const double back = last - ticks[a], weight = std::max(0.0, double(rate.x) - back * fade);
      between += back > 0;
      fading += weight > 0 && weight < 1;
      const glm::dmat3 axes = glm::mat3_cast(turns[a]);
      for (int joint = 0; joint < played.joints(); ++joint) {
        glm::dmat4x3 moved;
        for (int r = 0; r < 3; ++r) {
          const glm::dvec4 to = played.row(int(play[0].x), play[0].y - back * dt * double(rate.y), joint, r),
                           from =
                               played.row(int(play[0].z), play[0].w - back * dt * double(rate.z), joint, r),
                           row = glm::mix(from, to, weight);
          for (int c = 0; c < 4; ++c) moved[c][r] = row[c];
        }
        moved = axes * moved;
        for (int r = 0; r < 3; ++r) {
          const glm::vec4& got = rows[(size_t(a) * size_t(played.joints()) + size_t(joint)) * 3 + size_t(r)];
          // Matrices turn by at most some 10 radians a second, and times are rounded to 1e-6 of a second.
          EXPECT_LT(
              glm::distance(glm::dvec4(got), glm::dvec4(moved[0][r], moved[1][r], moved[2][r], moved[3][r])),
              3e-5)
              << named(0, picture, a) << ", joint " << joint << ", row " << r;
        }
      }
      if (HasFailure()) return;
    }
    before = now;
  }
  EXPECT_GT(between, 500u);
  EXPECT_GT(fading, 100u);
}

}  // namespace
}  // namespace skitter::render
