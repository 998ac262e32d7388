#include "validation/lockstep/lockstep.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <variant>

#include "crowd/changes.h"
#include "crowd/events.h"
#include "crowd/readback.h"
#include "crowd/setup.h"
#include "skitter/error.h"
#include "validation/herd_facts.h"

namespace skitter::validation {
namespace {

void add(const StageResult& result, StageResult& sum) {
  const bool worse = result.pass == sum.pass ? result.ratio() > sum.ratio() : !result.pass;
  if (worse) {
    sum.maxError = result.maxError;
    sum.tolerance = result.tolerance;
    sum.worst = result.worst;
  }
  sum.samples += result.samples;
  sum.kept += result.kept;
  sum.ties += result.ties;
  sum.pass = sum.pass && result.pass;
  if (!result.pass) sum.why += (sum.why.empty() ? "" : "; ") + result.why;
}

std::string nameOf(const Crowd::Impl& crowd, const crowd::HerdRun& of) {
  if (of.herd->runs.size() == 1) return fmt::format("herd {}", of.number);
  return fmt::format("herd {}, size {}", of.number, crowd.kinds[of.run->kind].size);
}

}  // namespace

void expectComparable(const Scene& scene, std::span<const crowd::StageId> stages, const char* what) {
  const bool comes = std::ranges::any_of(
      scene.events, [](const Event& event) { return std::holds_alternative<Addition>(event.what); });
  if (scene.agentCount() == 0 && !comes)
    throw inputError(fmt::format("{} has no agents, expected at least one to compare", scene.name));
  const auto isCompared = [&](crowd::StageId stage) {
    return std::ranges::any_of(scene.herds, [&](const Herd& herd) {
      const std::vector<CheckedStage> compared = checkedStages(herd.controller);
      return std::ranges::find(compared, stage, &CheckedStage::stage) != compared.end();
    });
  };
  for (const crowd::StageId stage : stages)
    if (!isCompared(stage))
      throw inputError(fmt::format("{}: no herd of {} has {} compared", what, scene.name, nameOf(stage)));
}

Lockstep::Lockstep(Crowd& crowd, const Scene& scene, float dt, std::vector<crowd::StageId> only)
    : crowd_(crowd), seed_(scene.seed) {
  Crowd::Impl& impl = implOf(crowd_);
  crowd::setTick(impl, dt);  // which herds' parameters depend on
  for (const crowd::HerdRun& of : crowd::allRuns(impl))
    replays_.push_back(std::make_unique<Replay>(herdFacts(impl, of), only));
}

Lockstep::~Lockstep() = default;

const std::vector<HerdState>& Lockstep::begin() {
  letEventsHappen();
  samples_.clear();
  for (const crowd::HerdRun& of : crowd::allRuns(implOf(crowd_)))
    samples_.push_back(sampleAt(seed_, crowd_.tick() + 1, of.run->agents, agentsATick));
  return before_ = download();
}

void Lockstep::edit(uint32_t x0, uint32_t z0, uint32_t columns, uint32_t rows,
                    std::span<const float> heights) {
  crowd_.editHeights(x0, z0, columns, rows, heights);
  for (const auto& replay : replays_) replay->edit(x0, z0, columns, rows, heights);
}

const std::vector<HerdState>& Lockstep::end() {
  after_ = download();
  for (size_t r = 0; r < replays_.size(); ++r) replays_[r]->tick(crowd_.tick(), before_[r], after_[r]);
  return after_;
}

std::vector<StageResult> Lockstep::results() const {
  const Crowd::Impl& impl = implOf(crowd_);
  const std::vector<crowd::HerdRun> runs = crowd::allRuns(impl);
  std::vector<StageResult> all;
  for (const crowd::StageId stage : crowd::allStages) {
    const char* name = nameOf(stage);
    StageResult* sum = nullptr;
    for (size_t r = 0; r < replays_.size(); ++r) {
      if (runs[r].run->agents == 0) continue;
      for (StageResult result : replays_[r]->results()) {
        if (result.name != name) continue;
        if (replays_.size() > 1) {
          result.worst = fmt::format("{}: {}", nameOf(impl, runs[r]), result.worst);
          if (!result.pass) result.why = fmt::format("{}: {}", nameOf(impl, runs[r]), result.why);
        }
        if (sum != nullptr)
          add(result, *sum);
        else
          sum = &all.emplace_back(result);
      }
    }
  }
  return all;
}

std::vector<HerdState> Lockstep::download() const {
  std::vector<HerdState> states;
  for (const crowd::HerdRun& of : crowd::allRuns(implOf(crowd_)))
    states.push_back(crowd::download(implOf(crowd_), *of.run, samples_[states.size()]));
  return states;
}

// The reference begins with it as the tick does.
void Lockstep::letEventsHappen() {
  Crowd::Impl& impl = implOf(crowd_);
  crowd::letEventsHappen(crowd_);
  const Heightfield& ground = crowd_.terrain();
  for (const Event& event : crowd::eventsAt(impl.events, crowd_.tick() + 1, double{impl.dt})) {
    const crowd::Rectangle at = crowd::groundOf(event, ground);
    std::vector<float> heights;
    for (uint32_t row = at.z; row < at.z + at.rows; ++row) {
      const auto first = ground.heights.begin() + static_cast<std::ptrdiff_t>(row) * ground.columns + at.x;
      heights.insert(heights.end(), first, first + at.columns);
    }
    for (const auto& replay : replays_) replay->edit(at.x, at.z, at.columns, at.rows, heights);
  }
  if (crowd::changesWait(impl)) crowd::applyChanges(impl);
}

}  // namespace skitter::validation
