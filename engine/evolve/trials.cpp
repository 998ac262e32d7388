#include "evolve/trials.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>
#include <utility>

#include "crowd/changes.h"
#include "crowd/damage.h"
#include "crowd/herd.h"
#include "crowd/page.h"
#include "crowd/record.h"
#include "embedded/trial_comp_storage.h"
#include "embedded/trial_comp_texel.h"
#include "gpu/barrier.h"
#include "gpu/context.h"
#include "gpu/submit.h"
#include "gpu/transfer.h"
#include "shared/bindings.h"
#include "shared/trial.h"

namespace skitter::evolve {
namespace {

constexpr double groundSide = 24;  // leg lengths: a trial goes a quarter of it
constexpr uint32_t samplesOfGround = 3;

// The fitness is 0 where so much goes wrong.
constexpr double worstError = 0.05;  // leg lengths
constexpr double worstSlip = 0.05;   // share of the way
constexpr double fewestCycles = 3;
constexpr double leastWay = 0.1;  // share of the wanted one, that slip is a share of

Crowd trialCrowd(Device& device, const Rig& rig, uint32_t agents) {
  CrowdOptions options{.pose = false, .measure = false, .feet = true};
  options.rigs = {bareRig(rig)};
  return Crowd(device, flatGround(rig, groundSide), walkOf(rig, agents, Evolution::wantedSpeed), options);
}

uint32_t wholeTicks(double seconds, float dt) {
  return static_cast<uint32_t>(std::lround(seconds / double{dt}));
}

// Puts the first agent's record in the place of everyone's.
std::vector<std::byte> replicated(std::span<const std::byte> all, crowd::Per per, uint32_t agents, int legs,
                                  size_t bytes) {
  std::vector<std::byte> made(all.begin(), all.end());
  for (uint32_t agent = 0; agent < agents; ++agent) {
    const int count = per == crowd::Per::leg ? legs : 1;
    for (int leg = 0; leg < count; ++leg) {
      const auto place = [&](uint32_t of) {
        return bytes * static_cast<size_t>(per == crowd::Per::leg
                                               ? shared::legRecord(static_cast<int>(of), leg, legs)
                                               : static_cast<int>(of));
      };
      std::memcpy(made.data() + place(agent), all.data() + place(0), bytes);
    }
  }
  return made;
}

// Whether agents of a trial begin with it: what a tick depends on, less what says who they are.
bool isBeginning(Record record, const crowd::Kind& kind) {
  return crowd::isHashed(record, kind.controller) && record != Record::hurt;
}

TrialFigures figuresOf(const float* record, size_t legs) {
  TrialFigures figures{.samples = double{record[0]},
                       .distance = double{record[1]},
                       .cycles = double{record[2]},
                       .unstable = double{record[3]},
                       .slip = double{record[4]},
                       .error = double{record[5]},
                       .least = double{record[6]}};
  for (size_t leg = 0; leg < legs; ++leg) {
    const float stood = std::floor(record[4 * (shared::TRIAL_LEGS + leg) + 3] / 2);
    figures.shares.push_back(stood / std::max(record[0], 1.0f));
  }
  return figures;
}

}  // namespace

Rig bareRig(const Rig& rig) {
  Rig bare = rig;
  bare.vertices = {};
  bare.indices = {};
  bare.look = {};
  bare.gaits = {};
  return bare;
}

Heightfield flatGround(const Rig& rig, double side) {
  const auto spacing = static_cast<float>(side * double{rig.legLength} / (samplesOfGround - 1));
  Heightfield ground;
  ground.columns = ground.rows = samplesOfGround;
  ground.spacingX = ground.spacingZ = spacing;
  ground.heights.assign(size_t{samplesOfGround} * samplesOfGround, 0.0f);
  return ground;
}

Scene walkOf(const Rig& rig, uint32_t agents, double speed) {
  Herd herd;
  herd.agents = agents;
  herd.spawn = {.kind = Spawn::Kind::grid, .spacing = 0.01f};
  herd.goal.kind = Goal::Kind::velocity;
  herd.goal.velocity = {0, static_cast<float>(speed * double{rig.legLength})};
  herd.phase = 0.0f;
  herd.hurt = true;
  Scene scene;
  scene.name = "trials";
  scene.herds = {herd};
  return scene;
}

double fitnessOf(const TrialFigures& figures, double legLength, size_t legs, double seconds, double wanted) {
  if (figures.cycles < fewestCycles) return 0;
  const double way = wanted * legLength * seconds;
  const double progress = std::clamp(figures.distance / way, 0.0, 1.0);
  const double error = figures.error / (worstError * legLength);
  const double slip =
      figures.slip / (static_cast<double>(legs) * worstSlip * std::max(figures.distance, leastWay * way));
  const double fitness = progress * (1 - figures.unstable / figures.samples) * std::max(0.0, 1 - error) *
                         std::max(0.0, 1 - slip);
  return std::isfinite(fitness) ? fitness : 0;
}

Trials::Trials(Device& device, const Rig& rig, uint32_t agents, float dt, const TrialShader& shader)
    : context_(&device.context()),
      dt_(dt),
      settleTicks_(wholeTicks(settleSeconds, dt)),
      samples_(wholeTicks(wantedSeconds / ticksOfSample, dt)),
      crowd_(trialCrowd(device, rig, agents)) {
  standAtTheOrigin();
  makePages(shader);
}

double Trials::seconds() const { return double{dt_} * settleTicks_ + countedSeconds(); }
double Trials::countedSeconds() const { return double{dt_} * samples_ * ticksOfSample; }

void Trials::standAtTheOrigin() {
  crowd_.teleport(crowd_.agentId(0, 0), Place{});
  crowd::applyChanges(implOf(crowd_));
}

void Trials::makePages(const TrialShader& shader) {
  using namespace shared;
  using enum gpu::BindingKind;
  const gpu::Context& context = *context_;
  const crowd::Kind& kind = implOf(crowd_).kinds.front();
  const gpu::ShaderCode builtin{embedded::trial_comp_texel(), embedded::trial_comp_storage()};
  const gpu::ShaderCode given{shader.texel, shader.storage};
  kernel_ = gpu::Kernel(context, {.name = "trial",
                                  .code = shader.texel.empty() ? builtin : given,
                                  .bindings = {{BINDING_BODY, load4},
                                               {BINDING_GAIT, load4},
                                               {BINDING_FOOT, load4},
                                               {BINDING_TIP, load4},
                                               {BINDING_TRIAL, load4},
                                               {BINDING_TRIAL_OUT, store}},
                                  .pushBytes = sizeof(TrialConstants),
                                  .constants = {{CONSTANT_LEGS, kind.legs}}});
  const auto bytesOfRecord = [&](Record record) {
    return 16 * static_cast<size_t>(crowd::strideOf(record, kind.legs, kind.bones, 0));
  };
  const crowd::Page& firstPage = kind.pages.front();
  for (const crowd::Page& page : kind.pages) {
    Page made;
    made.agents = page.agents;
    for (const Record record : allRecords) {
      if (!isBeginning(record, kind) || !crowd::keeps(kind, implOf(crowd_).options, record)) continue;
      // Everyone is where the first agent of all is.
      std::vector<std::byte> bytes(page.of(record).size());
      const size_t known = std::min(bytes.size(), size_t{firstPage.of(record).size()});
      gpu::downloadBytes(context, firstPage.of(record), std::span(bytes).first(known));
      bytes = replicated(bytes, crowd::infoOf(record).per, page.agents, kind.legs, bytesOfRecord(record));
      Beginning beginning{&page.of(record), gpu::Buffer(context, bytes.size(), "beginning")};
      gpu::uploadBytes(context, beginning.from, bytes);
      made.beginnings.push_back(std::move(beginning));
    }
    const uint64_t trialBytes = uint64_t{16} * static_cast<uint64_t>(trialStride(kind.legs)) * page.agents;
    made.trial = gpu::Buffer(context, trialBytes, "trial");
    gpu::clear(context, made.trial);  // the first sample multiplies by 0 what was there before
    made.read = gpu::HostBuffer(context, trialBytes, gpu::HostUse::readback, "trial");
    made.hurts = gpu::HostBuffer(context, bytesOfRecord(Record::hurt) * page.agents, gpu::HostUse::upload,
                                 "gaits of trials");
    pages_.push_back(std::move(made));
  }
  // Bindings know where buffers are, so these have their places first.
  for (size_t p = 0; p < pages_.size(); ++p) {
    const crowd::Page& page = kind.pages[p];
    pages_[p].bindings = kernel_.bind(context, {{BINDING_BODY, &page.body},
                                                {BINDING_GAIT, &page.gait},
                                                {BINDING_FOOT, &page.foot},
                                                {BINDING_TIP, &page.tip},
                                                {BINDING_TRIAL, &pages_[p].trial},
                                                {BINDING_TRIAL_OUT, &pages_[p].trial}});
  }
}

void Trials::write(std::span<const TrialTask> tasks) {
  // Everybody begins anew, time too: records hold ticks as floats.
  implOf(crowd_).tick = 0;
  const crowd::Kind& kind = implOf(crowd_).kinds.front();
  size_t task = 0;
  for (Page& page : pages_) {
    const std::span<float> records = page.hurts.as<float>();
    const size_t floats = records.size() / page.agents;
    for (uint32_t agent = 0; agent < page.agents; ++agent, ++task) {
      std::vector<float> record = kind.wholeRecord;  // where there is nothing to try
      if (task < tasks.size()) {
        crowd::Damage damage;
        for (uint32_t leg = 0; leg < static_cast<uint32_t>(kind.legs); ++leg)
          if ((tasks[task].idle >> leg & 1u) != 0) damage.set(leg, LegState::lost, 1);
        record = crowd::hurtRecord(damage, tasks[task].gait);
      }
      std::ranges::copy(record, records.begin() + static_cast<std::ptrdiff_t>(agent * floats));
    }
  }
}

void Trials::recordBeginning(vk::CommandBuffer cmd) const {
  gpu::allToAll(cmd);
  const std::vector<crowd::Page>& pages = implOf(crowd_).kinds.front().pages;
  for (size_t p = 0; p < pages_.size(); ++p) {
    for (const Beginning& beginning : pages_[p].beginnings) {
      const vk::BufferCopy copy{.size = beginning.from.size()};
      cmd.copyBuffer(beginning.from.handle(), beginning.to->handle(), copy);
    }
    const vk::BufferCopy copy{.size = pages_[p].hurts.size()};
    cmd.copyBuffer(pages_[p].hurts.handle(), pages[p].hurt.handle(), copy);
  }
  gpu::allToAll(cmd);
}

void Trials::recordSample(vk::CommandBuffer cmd, bool begins) const {
  const Rig& rig = crowd_.rig(0);
  for (const Page& page : pages_) {
    const shared::TrialConstants constants{.count = page.agents,
                                           .begins = begins ? 1u : 0u,
                                           .legLength = rig.legLength,
                                           .bodyHeight = rig.bodyHeight,
                                           .safe = static_cast<float>(safeMargin) * rig.legLength};
    kernel_.dispatch(cmd, page.bindings, gpu::bytesOf(constants),
                     gpu::groupsFor(page.agents, shared::WORK_GROUP));
  }
  gpu::computeToCompute(cmd);
}

void Trials::recordReading(vk::CommandBuffer cmd) const {
  gpu::computeToTransfer(cmd);
  for (const Page& page : pages_) {
    const vk::BufferCopy copy{.size = page.trial.size()};
    cmd.copyBuffer(page.trial.handle(), page.read.handle(), copy);
  }
  gpu::transferToHost(cmd);
}

std::vector<float> Trials::readBack() const {
  std::vector<float> all;
  for (const Page& page : pages_) {
    const std::span<float> read = page.read.as<float>();
    all.insert(all.end(), read.begin(), read.end());
  }
  return all;
}

void Trials::begin(std::span<const TrialTask> tasks) {
  write(tasks);
  gpu::submitAndWait(*context_, [&](vk::CommandBuffer cmd) { recordBeginning(cmd); });
  begins_ = true;
}

void Trials::tick() {
  gpu::submitAndWait(*context_, [&](vk::CommandBuffer cmd) { crowd_.record(cmd, dt_); });
}

void Trials::sample() {
  gpu::submitAndWait(*context_, [&](vk::CommandBuffer cmd) {
    gpu::allToAll(cmd);
    recordSample(cmd, std::exchange(begins_, false));
  });
}

std::vector<float> Trials::records() const {
  gpu::submitAndWait(*context_, [&](vk::CommandBuffer cmd) {
    gpu::allToAll(cmd);
    recordReading(cmd);
  });
  return readBack();
}

std::vector<TrialFigures> Trials::run(std::span<const TrialTask> tasks) {
  assert(tasks.size() <= crowd_.places(0));
  write(tasks);
  gpu::submitAndWait(*context_, [&](vk::CommandBuffer cmd) {
    recordBeginning(cmd);
    for (uint32_t tick = 0; tick < settleTicks_; ++tick) crowd_.record(cmd, dt_);
    recordSample(cmd, true);
    for (uint32_t sample = 0; sample < samples_; ++sample) {
      for (uint32_t tick = 0; tick < ticksOfSample; ++tick) crowd_.record(cmd, dt_);
      recordSample(cmd, false);
    }
    recordReading(cmd);
  });
  const std::vector<float> all = readBack();
  const auto legs = static_cast<size_t>(crowd_.rig(0).legCount());
  std::vector<TrialFigures> figures;
  for (size_t task = 0; task < tasks.size(); ++task)
    figures.push_back(figuresOf(
        all.data() + task * 4 * static_cast<size_t>(shared::trialStride(static_cast<int>(legs))), legs));
  return figures;
}

}  // namespace skitter::evolve
