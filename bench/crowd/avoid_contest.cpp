#include "bench/crowd/avoid_contest.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <span>
#include <thread>

#include "base/split_mix.h"
#include "bench/cpu_crowd/avoid/orca_check.h"
#include "bench/cpu_crowd/avoid/walkers.h"
#include "crowd/frame.h"
#include "crowd/grid.h"
#include "crowd/herd.h"
#include "crowd/kinds.h"
#include "crowd/page.h"
#include "crowd/radius.h"
#include "crowd/readback.h"
#include "gpu/barrier.h"
#include "gpu/submit.h"
#include "gpu/timer.h"
#include "skitter/records.h"
#include "validation/herd_facts.h"
#include "validation/replay.h"

namespace skitter::bench {
namespace {

using cpu_avoid::Avoider;
using cpu_avoid::Walkers;

// Points that know nothing of each other would have so many others in reach. Bodies keep apart, and agents at
// the crowd's edge have fewer, so that ten are left.
constexpr double pointsInReach = 11.2;
// Rows are farther apart than agents of a row (engine/crowd/spawn.cpp).
constexpr double rowSpacing = 1.2;
constexpr double slowest = 0.7, fastest = 1.3;  // leg lengths a second
// Agents are compared with the reference, which looks at everybody for each of them.
constexpr uint32_t agentsJudged = 256;
// m/s. Each of 48 steps of a solve errs by 4 roundings (6e-8) of 3 m/s, and multipliers of up to 20 m/s by 8
// roundings of their normals: 5e-5 m/s. Two solves may differ by twice as much, and by ten times that where a
// normal follows from a short vector.
constexpr double sameVelocity = 1e-3;
// Where rounding decides which side somebody is passed on, velocities are others.
constexpr double mostOtherSides = 1e-3;  // of the agents

// Who computes velocities that keep clear, again and again of the same agents.
class AvoidRunner : public Runner {
 public:
  // A part of the agents looks around in each tick, everybody in a round of so many.
  explicit AvoidRunner(int round) : parts_(static_cast<size_t>(round)) {}
  void tick() final { look(ticks_++ % parts_); }
  // The last tick goes on to a whole round, so that everybody has looked around.
  std::vector<float> recordsOfARound() {
    for (size_t i = 1; i < parts_; ++i) tick();
    finish();
    return records();
  }
  // So that a tick that computes nothing is found out.
  virtual void forget() = 0;

 protected:
  size_t parts() const { return parts_; }
  virtual void look(size_t part) = 0;
  // All agents have four numbers each, as in the avoid record.
  virtual std::vector<float> records() const = 0;

 private:
  size_t parts_, ticks_ = 0;
};

class DeviceAvoid final : public AvoidRunner {
 public:
  DeviceAvoid(Device& device, const Crowd& crowd, int round)
      : AvoidRunner(round),
        crowd_(implOf(crowd)),
        ring_(device.context()),
        timer_(device.context(), mostStages) {}

  std::string name() const override { return "device"; }
  int threads() const override { return 0; }
  void look(size_t part) override {
    const vk::CommandBuffer cmd = ring_.begin();
    timer_.reset(cmd);
    timer_.next(cmd, "grid");
    crowd_.grid->record(crowd_, cmd);
    timer_.next(cmd, "avoid");
    crowd::Frame(crowd_, crowd_.kinds, crowd_.tick + part, cmd).record(crowd::StageId::avoid);
    timer_.end(cmd, "avoid");
    gpu::computeToCompute(cmd);
    ring_.submit();
    if (!timed_) return;
    finish();
    for (const gpu::StageTime& time : timer_.milliseconds()) add(times_, time.stage, time.milliseconds);
  }
  void finish() override { ring_.waitAll(); }
  void timeStages(bool on) override {
    finish();
    timer_.measure(on);
    timed_ = on;
  }
  std::vector<StageTime> stageTimes() const override { return times_; }
  std::vector<float> records() const override {
    constexpr std::array wanted = {Record::avoid};
    return crowd::downloadRecords(crowd_, 0, wanted).avoid;
  }
  void forget() override {
    constexpr uint32_t notANumber = UINT32_MAX;
    finish();
    gpu::submitAndWait(*crowd_.context, [&](vk::CommandBuffer cmd) {
      for (const crowd::Kind& kind : crowd_.kinds)
        for (const crowd::Page& page : kind.pages)
          cmd.fillBuffer(page.avoid.handle(), 0, VK_WHOLE_SIZE, notANumber);
      gpu::allToAll(cmd);
    });
  }

 private:
  static constexpr uint32_t mostStages = 2;
  const Crowd::Impl& crowd_;
  bool timed_ = true;
  gpu::CommandRing ring_;
  gpu::StageTimer timer_;
  std::vector<StageTime> times_;
};

class CpuAvoid final : public AvoidRunner {
 public:
  CpuAvoid(const char* method, int threads, int round, std::unique_ptr<Avoider> avoider)
      : AvoidRunner(round),
        name_(fmt::format("{}, {} thread{}", method, threads, threads == 1 ? "" : "s")),
        threads_(threads),
        avoider_(std::move(avoider)) {}

  std::string name() const override { return name_; }
  int threads() const override { return threads_; }
  void look(size_t part) override { avoider_->tick(part, parts()); }
  void timeStages(bool on) override { avoider_->timeStages(on); }
  std::vector<StageTime> stageTimes() const override {
    std::vector<StageTime> times;
    for (const cpu_crowd::StageSeconds& stage : avoider_->stageSeconds())
      add(times, stage.stage, 1e3 * stage.seconds);
    return times;
  }
  std::vector<float> records() const override { return avoider_->records(); }
  void forget() override { avoider_->forget(); }

 private:
  std::string name_;
  int threads_;
  std::unique_ptr<Avoider> avoider_;
};

// One of those who compete, and whether it does what the stage does.
struct Entrant {
  std::unique_ptr<AvoidRunner> runner;
  bool isTheStage;
  std::vector<float> records = {};  // of the tick that was witnessed
};

Walkers walkersOf(const Crowd& crowd) {
  const Crowd::Impl& impl = implOf(crowd);
  const crowd::Kind& kind = impl.kinds.front();
  const crowd::Quanta quanta = crowd::quantaOf(impl);
  constexpr std::array wanted = {Record::body, Record::steer};
  const HerdState state = crowd::downloadRecords(impl, 0, wanted);
  Walkers walkers;
  walkers.quanta = quanta.inMetre;
  walkers.look = static_cast<int32_t>(quanta.lookOf(kind));
  walkers.legLength = kind.parameters.legLength;
  walkers.dt = kind.parameters.dt;
  walkers.tick = static_cast<int64_t>(impl.tick);
  walkers.round = static_cast<int>(crowd::roundTicksOf(impl.dt));
  for (size_t agent = 0; agent < state.agents; ++agent) {
    const reference::AgentBody body = validation::bodyOf(state, agent);
    const glm::dvec2 desired = validation::desiredOf(state, agent);
    const auto push = [](std::vector<float>& to, double value) { to.push_back(static_cast<float>(value)); };
    push(walkers.tileX, body.tileX);
    push(walkers.tileZ, body.tileZ);
    push(walkers.localX, body.localX);
    push(walkers.localZ, body.localZ);
    push(walkers.headingX, body.heading.x);
    push(walkers.headingZ, body.heading.y);
    push(walkers.speed, body.speed);
    push(walkers.wantedX, desired.x);
    push(walkers.wantedZ, desired.y);
    walkers.radius.push_back(static_cast<int32_t>(quanta.radiusOf(kind)));
    walkers.share.push_back(0.5f);
  }
  return walkers;
}

std::vector<Entrant> entrantsOf(Device& device, const Crowd& crowd, const Walkers& walkers,
                                const ContestOptions& options) {
  using cpu_crowd::Width;
  const int all = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  std::vector<Entrant> entrants;
  entrants.push_back({std::make_unique<DeviceAvoid>(device, crowd, walkers.round), true});
  const auto enter = [&](const char* method, int threads, bool isTheStage, std::unique_ptr<Avoider> avoider) {
    entrants.push_back(
        {std::make_unique<CpuAvoid>(method, threads, walkers.round, std::move(avoider)), isTheStage});
  };
  const auto soft = [&](Width width, int threads) {
    enter(width == Width::simd ? "CPU SIMD" : "CPU scalar", threads, true,
          cpu_avoid::softAvoider(walkers, width, threads));
  };
  const auto orca = [&](int threads) {
    enter("ORCA", threads, false, cpu_avoid::orcaAvoider(walkers, threads));
  };
  if (all > 1) soft(Width::simd, all);
  soft(Width::simd, 1);
  if (options.scalar) soft(Width::scalar, 1);
  if (all > 1) orca(all);
  orca(1);
  return entrants;
}

// Of what the stage computes, a sample is held against the reference.
validation::StageResult againstReference(const Crowd& crowd, const std::vector<float>& records,
                                         uint64_t seed) {
  const Crowd::Impl& impl = implOf(crowd);
  const crowd::HerdRun of = crowd::allRuns(impl).front();
  const AgentSample sample = validation::sampleAt(seed, crowd.tick(), of.run->agents, agentsJudged);
  HerdState before = crowd::download(impl, *of.run, sample), after = before;
  after.avoid.clear();
  for (uint32_t i = 0; i < after.agents; ++i) {
    const size_t agent = size_t{sample.first} + size_t{i} * sample.stride;
    const auto record = std::span(records).subspan(4 * agent, 4);
    after.avoid.insert(after.avoid.end(), record.begin(), record.end());
  }
  before.avoid = after.avoid;
  validation::Replay replay(validation::herdFacts(impl, of), {crowd::StageId::avoid});
  // In each tick of a round, which is within a turn, others have looked around.
  const uint64_t round = crowd::roundTicksOf(impl.dt), first = crowd.tick() - crowd.tick() % round;
  for (uint64_t part = 0; part < round; ++part)
    replay.tick(first + part, before, after, validation::surroundingsOf(impl));
  return replay.results().front();
}

// All of it is held against what the device has computed.
validation::StageResult againstDevice(const std::vector<float>& device, const std::vector<float>& records) {
  validation::StageResult result;
  result.name = "as the device";
  result.tolerance = sameVelocity;
  for (size_t i = 0; i + 3 < device.size(); i += 4) {
    ++result.samples;
    const double apart = std::hypot(double{records[i]} - device[i], double{records[i + 1]} - device[i + 1]);
    if (result.why.empty() && records[i + 2] != device[i + 2])
      result.why =
          fmt::format("agent {}: {} in reach, the device has {}", i / 4, -records[i + 2], -device[i + 2]);
    // Times for a metre, for a speed errs much where hardly anything bounds it.
    const double slowness = 1 / double{device[i + 3]};
    const double slower = std::abs(1 / double{records[i + 3]} - slowness);
    if (apart <= sameVelocity && slower <= sameVelocity * (1 + slowness))
      result.maxError = std::max(result.maxError, apart);
    else
      ++result.ties;
  }
  // One may be otherwise in however few.
  const double most = std::max(1.0, mostOtherSides * static_cast<double>(result.samples));
  if (result.why.empty() && static_cast<double>(result.ties) > most)
    result.why = fmt::format(
        "velocities of {} of {} agents are farther from the device's than {} m/s, expected at most {:g} %",
        result.ties, result.samples, sameVelocity, 100 * mostOtherSides);
  result.pass = result.why.empty();
  return result;
}

// Of the linear programs' answers, a sample is held against the half-planes.
validation::StageResult againstHalfPlanes(const Walkers& walkers, const std::vector<float>& records,
                                          uint64_t tick, uint64_t seed) {
  const auto agents = static_cast<uint32_t>(walkers.size());
  const AgentSample sample = validation::sampleAt(seed, tick, agents, agentsJudged);
  validation::Judge verdict("half-planes");
  for (size_t agent = sample.first; agent < agents; agent += sample.stride) {
    const cpu_avoid::Velocity v{records[4 * agent], records[4 * agent + 1]};
    validation::Sample compared;
    compared.finite("ORCA's velocity", std::span(records).subspan(4 * agent, 4));
    compared.compare("violation beyond the least, m/s",
                     std::max(0.0, cpu_avoid::orcaFault(walkers, agent, v)), cpu_avoid::orcaTolerance,
                     glm::dvec4(0), {v.x, v.z, 0, 0});
    verdict.add(tick, agent, -1, compared);
  }
  return verdict.result();
}

std::vector<validation::StageResult> checksOf(const Crowd& crowd, const Walkers& walkers,
                                              const Entrant& entrant, const std::vector<float>& device,
                                              uint64_t seed) {
  if (!entrant.isTheStage) return {againstHalfPlanes(walkers, entrant.records, crowd.tick(), seed)};
  std::vector<validation::StageResult> checks = {againstReference(crowd, entrant.records, seed)};
  if (&entrant.records != &device) checks.push_back(againstDevice(device, entrant.records));
  return checks;
}

// Everybody goes somewhere else at a speed of its own, drawn by the seed.
std::vector<Goal> goalsOf(uint32_t agents, double legLength, uint64_t seed) {
  std::vector<Goal> goals(agents);
  base::SplitMix64 random(seed);
  for (Goal& goal : goals) {
    const double angle = 2 * std::numbers::pi * random.uniform();
    const double speed = legLength * (slowest + (fastest - slowest) * random.uniform());
    goal.kind = Goal::Kind::velocity;
    goal.velocity = {static_cast<float>(speed * std::sin(angle)),
                     static_cast<float>(speed * std::cos(angle))};
  }
  return goals;
}

// False where `stopped` ended it early.
bool walk(Device& device, Crowd& crowd, const ContestOptions& options,
          const std::function<void(double)>& step, const std::function<bool()>& stopped) {
  const std::unique_ptr<Contestant> walker = deviceContestant(device, crowd, static_cast<float>(options.dt));
  walker->timeStages(false);
  for (uint32_t i = 0; i < options.warmUp; ++i) {
    if (stopped()) return false;
    walker->tick();
    walker->finish();
    step(0.3 * (i + 1) / options.warmUp);
  }
  return true;
}

double meanOf(const std::vector<float>& records, double most) {
  double sum = 0;
  for (size_t i = 2; i < records.size(); i += 4) sum += std::min(double{-records[i]}, most);
  return sum / static_cast<double>(records.size() / 4);
}

}  // namespace

AvoidCrowd avoidCrowdOf(const Scene& from, uint32_t agents) {
  AvoidCrowd made;
  made.scene.name = "neighbours";
  made.scene.seed = from.seed;
  Herd herd;
  if (!from.herds.empty()) herd.rig = from.herds.front().rig;
  herd.agents = agents;
  herd.avoid = true;
  const Rig rig = crowd::rigOf(herd);
  const double legLength = rig.legLength;
  const double reach = 2 * double{crowd::footprintRadius(rig)} + double{crowd::lookLegLengths} * legLength;
  made.spacing = reach * std::sqrt(std::numbers::pi / (rowSpacing * pointsInReach));
  herd.spawn = {.kind = Spawn::Kind::grid, .spacing = static_cast<float>(made.spacing)};
  herd.goal = {.kind = Goal::Kind::velocity};
  made.scene.herds = {herd};
  // Room for all rows, and for the way that agents go.
  constexpr uint32_t samples = 129;
  const double side = 1.5 * rowSpacing * made.spacing * std::ceil(std::sqrt(agents)) + 40 * legLength;
  const TerrainNoise flat{.columns = samples,
                          .rows = samples,
                          .spacing = static_cast<float>(side / (samples - 1)),
                          .amplitude = 0};
  made.scene.terrain = flat;
  made.ground = generateHeightfield(flat);
  return made;
}

AvoidMatch avoidContest(Device& device, const AvoidCrowd& made, const ContestOptions& options,
                        const std::function<void(double)>& step, const std::function<bool()>& stopped) {
  Crowd crowd(device, made.ground, made.scene,
              {.pose = false, .measure = false, .shaders = options.crowd.shaders});
  const Rig& rig = crowd.rig(0);
  crowd.steer(0, goalsOf(crowd.places(0), rig.legLength, options.seed));
  if (!walk(device, crowd, options, step, stopped)) return {};

  const double radius = crowd::footprintRadius(rig);
  AvoidMatch match{
      .agents = crowd.agentCount(),
      .spacing = made.spacing,
      .density = std::numbers::pi * radius * radius / (rowSpacing * made.spacing * made.spacing)};
  const Walkers walkers = walkersOf(crowd);
  std::vector<Entrant> entrants = entrantsOf(device, crowd, walkers, options);
  std::vector<Corner> corners;
  for (const Entrant& entrant : entrants)
    corners.push_back({*entrant.runner, ticksATurn(*entrant.runner, options.turnSeconds)});
  if (!takeTurns(
          corners, {options.rounds, options.seed}, [&](size_t i) { entrants[i].runner->forget(); },
          [&](size_t i) { entrants[i].records = entrants[i].runner->recordsOfARound(); },
          [&](double share) { step(0.3 + 0.6 * share); }, stopped))
    return {};
  for (size_t i = 0; i < corners.size(); ++i) {
    if (stopped()) return {};
    Result& result = match.results.emplace_back(resultOf(corners[i], options.rounds));
    result.checkedTick = crowd.tick();
    addChecks(result, checksOf(crowd, walkers, entrants[i], entrants.front().records, options.seed));
    step(0.9 + 0.1 * static_cast<double>(i + 1) / static_cast<double>(corners.size()));
  }
  match.inReach = meanOf(entrants.front().records, 1e9);
  match.keptClear = meanOf(entrants.front().records, shared::NEIGHBOURS);
  return match;
}

std::vector<Growth> growthOf(const std::vector<AvoidMatch>& matches, bool cpu) {
  std::vector<Growth> all;
  if (matches.size() < 2) return all;
  const AvoidMatch &few = matches.front(), &many = matches.back();
  const auto cost = [&](const Result& result, const AvoidMatch& match) {
    return (cpu ? result.cpu : result.wall).median / static_cast<double>(match.agents);
  };
  for (const Result& result : many.results) {
    const auto same = std::ranges::find(few.results, result.name, &Result::name);
    if (same != few.results.end())
      all.push_back({result.name, few.agents, many.agents, cost(result, many) / cost(*same, few)});
  }
  return all;
}

}  // namespace skitter::bench
