// Random calls over many ticks: the same calls give the same bits, also where the crowd is saved and loaded
// in between, memory stays as it is, and everybody who is there walks soundly.
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <random>
#include <string>

#include "crowd/herd.h"
#include "crowd/simulation.h"
#include "gpu/submit.h"
#include "skitter/state.h"

namespace skitter::test {
namespace {

using SoakTest = GpuTest;

// Calls for each tick, every so many ticks a herd that comes or goes, and one call in so many that saves the
// crowd and goes on with one that is made of its state.
constexpr int kCallsATick = 5;
constexpr int kHerdEvery = 500;
constexpr size_t kSaveOneIn = 500;

// SKITTER_SOAK_TICKS; 20,000 are 100,000 calls and take some minutes.
int ticksToSoak() {
  const char* given = std::getenv("SKITTER_SOAK_TICKS");
  return given != nullptr ? std::atoi(given) : 1500;
}

long residentPages() {
  long all = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> all >> resident;
  return resident;
}

struct Soaked {
  uint64_t hash = 0, calls = 0;
  Fidelity fidelity;
  long pagesHalfway = 0, pages = 0;
  uint64_t bytes = 0;  // of records, at the most
};

// A small crowd, and whoever calls it.
class Soak {
 public:
  Soak(Device& device, Controller other, bool saves)
      : device_(device),
        crowd_(device, rollingGround(), sceneFor(other), CrowdOptions{.sleep = true}),
        saves_(saves) {
    for (uint32_t h = 0; h < crowd_.herdCount(); ++h)
      for (uint32_t i = 0; i < crowd_.places(h); ++i)
        if (crowd_.has(AgentId(h, i))) here_.push_back(AgentId(h, i));
  }

  Soaked run(int ticks) {
    Soaked soaked;
    gpu::CommandRing ring(device_.context());
    for (int tick = 0; tick < ticks; ++tick) {
      for (int call = 0; call < kCallsATick; ++call) callAny();
      if (tick % kHerdEvery == kHerdEvery / 2) changeHerds();
      crowd_.record(ring.begin(), kTick);
      ring.submit();
      soaked.bytes = std::max(soaked.bytes, crowd_.memoryBytes());
      if (tick == ticks / 2) soaked.pagesHalfway = residentPages();
    }
    ring.waitAll();
    soaked.pages = residentPages();
    soaked.hash = crowd_.stateHash();
    soaked.calls = calls_;
    soaked.fidelity = crowd_.fidelity(0);  // feet of the other herd, which plays clips, may skate
    EXPECT_EQ(crowd_.agentCount(), here_.size());
    for (const AgentId id : here_) EXPECT_TRUE(crowd_.has(id));
    for (const AgentId id : gone_) EXPECT_FALSE(crowd_.has(id));
    return soaked;
  }

 private:
  static Scene sceneFor(Controller other) {
    Scene scene = sceneOf(24);
    scene.herds[0].reserve = 16;
    scene.herds.push_back(scene.herds[0]);
    scene.herds[0].sizes = {0.8f, 1.2f};
    scene.herds[1].controller = other;
    for (Herd& herd : scene.herds) herd.spawn = {.kind = Spawn::Kind::grid, .spacing = 2};
    return scene;
  }

  float drawn(float least, float most) { return std::uniform_real_distribution<float>(least, most)(random_); }
  size_t below(size_t count) { return random_() % count; }
  Place anyPlace() { return {{drawn(-30, 30), drawn(-30, 30)}, drawn(-3, 3)}; }
  Goal anyGoal() {
    switch (below(4)) {
      case 0:
        return {.speed = drawn(0, 2)};
      case 1:
        return {.kind = Goal::Kind::point, .target = {drawn(-30, 30), drawn(-30, 30)}, .speed = drawn(0, 2)};
      case 2:
        return {.kind = Goal::Kind::none};
      default:
        return {.kind = Goal::Kind::velocity, .velocity = {drawn(-1, 1), drawn(-1, 1)}};
    }
  }

  void callAny() {
    ++calls_;
    if (below(kSaveOneIn) == 0) return saveAndLoad();
    const auto herd = static_cast<uint32_t>(below(2));
    if (here_.empty()) return come(herd);
    const size_t who = below(here_.size());
    switch (below(8)) {
      case 0:
        return come(herd);
      case 1:
        return leave(who);
      case 2:
        return crowd_.teleport(here_[who], anyPlace());
      case 3:
        return crowd_.steer(herd, anyGoal());
      case 4:
        return edit();
      case 5:
        return crowd_.setSpeed(herd, drawn(0, 1.5f));
      default: {
        const AgentGoal goal{here_[who], anyGoal()};
        return crowd_.steer({&goal, 1});
      }
    }
  }
  void saveAndLoad() {
    if (saves_) crowd_ = Crowd(device_, parseState(crowd_.saveToMemory(), "the soak's state"));
  }
  void come(uint32_t herd) {
    if (crowd_.agentCount(herd) == crowd_.places(herd)) return;
    here_.push_back(crowd_.add(herd, anyPlace(), anyGoal()));
  }
  void leave(size_t who) {
    if (guest_ && here_[who].herd() == guest_->index) return;  // has no reserve
    crowd_.remove(here_[who]);
    if (gone_.size() < 1000) gone_.push_back(here_[who]);
    here_.erase(here_.begin() + static_cast<ptrdiff_t>(who));
  }
  // The ground is never more than two centimetres from where it was.
  void edit() {
    std::vector<float> heights;
    const uint32_t x = static_cast<uint32_t>(below(480)), z = static_cast<uint32_t>(below(480)), side = 8;
    for (uint32_t row = z; row < z + side; ++row)
      for (uint32_t column = x; column < x + side; ++column)
        heights.push_back(ground_.heights[size_t{row} * ground_.columns + column] + drawn(0, 0.02f));
    crowd_.editHeights(x, z, side, side, heights);
  }
  void changeHerds() {
    if (guest_) {
      const uint32_t number = guest_->index;
      crowd_.removeHerd(*guest_);
      std::erase_if(here_, [&](AgentId id) { return id.herd() == number; });
      guest_.reset();
      return;
    }
    Herd herd;
    herd.agents = 6;
    herd.controller = Controller::loop;
    herd.sizes = {1, 0.7f};
    guest_ = crowd_.addHerd(herd);
    for (uint32_t i = 0; i < 6; ++i) here_.push_back(crowd_.agentId(guest_->index, i));
  }

  Device& device_;
  Heightfield ground_ = rollingGround();
  Crowd crowd_;
  bool saves_;
  std::mt19937_64 random_{7};
  std::vector<AgentId> here_, gone_;
  std::optional<HerdId> guest_;
  uint64_t calls_ = 0;
};

TEST_F(SoakTest, RandomCallsRepeatAndLeaveNothingBehind) {
  const int ticks = ticksToSoak();
  const Soaked first = Soak(device(), Controller::clip, false).run(ticks);
  // The layer keeps a little of every object that there ever was, which would hide what calls keep.
  DeviceRequest request = validatedRequest();
  request.validation = false;
  Device bare = Device::create(request);
  const Soaked again = Soak(bare, Controller::clip, true).run(ticks);
  EXPECT_EQ(first.hash, again.hash);
  EXPECT_EQ(first.calls, static_cast<uint64_t>(ticks) * kCallsATick);
  EXPECT_EQ(first.bytes, again.bytes);
  const auto mebibytes = [](long pages) {
    return static_cast<double>(pages) * static_cast<double>(sysconf(_SC_PAGESIZE)) / (1 << 20);
  };
  // What the driver keeps of pipelines that came and went is some; what calls keep would be more.
  EXPECT_LT(mebibytes(again.pages - again.pagesHalfway), 32);
  EXPECT_EQ(first.fidelity.notFinite, 0u);
  EXPECT_LT(first.fidelity.reachErrorP99, 0.05);
  EXPECT_LT(first.fidelity.penetration, 0.05);
  EXPECT_LT(first.fidelity.skating, 0.1);
  RecordProperty("ticks", ticks);
  std::printf(
      "%d ticks, %llu calls: hash %016llx, %.1f MiB halfway, %.1f MiB at the end; reach error p99 %.2g, "
      "penetration %.2g, skating %.2g\n",
      ticks, static_cast<unsigned long long>(first.calls), static_cast<unsigned long long>(first.hash),
      mebibytes(again.pagesHalfway), mebibytes(again.pages), first.fidelity.reachErrorP99,
      first.fidelity.penetration, first.fidelity.skating);
}

}  // namespace
}  // namespace skitter::test
