#include "validation/lockstep/lockstep.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <utility>
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
  std::string name = fmt::format("herd {}", of.number);
  if (of.herd->generation > 0) name += fmt::format(" of generation {}", of.herd->generation);
  if (of.herd->runs.size() > 1) name += fmt::format(", size {}", crowd.kinds[of.run->kind].size);
  return name;
}

// The scene's, and those that its events add.
std::vector<const Herd*> herdsOf(const Scene& scene) {
  std::vector<const Herd*> all;
  for (const Herd& herd : scene.herds) all.push_back(&herd);
  for (const Event& event : scene.events)
    if (const auto* addition = std::get_if<HerdAddition>(&event.what)) all.push_back(&addition->herd);
  return all;
}

}  // namespace

void expectComparable(const Scene& scene, std::span<const crowd::StageId> stages, const char* what) {
  const bool comes = std::ranges::any_of(
      scene.events, [](const Event& event) { return std::holds_alternative<Addition>(event.what); });
  const std::vector<const Herd*> herds = herdsOf(scene);
  const bool areSome = std::ranges::any_of(herds, [](const Herd* herd) { return herd->agents > 0; });
  if (!areSome && !comes)
    throw inputError(fmt::format("{} has no agents, expected at least one to compare", scene.name));
  const auto isCompared = [&](crowd::StageId stage) {
    return std::ranges::any_of(herds, [&](const Herd* herd) {
      const std::vector<CheckedStage> compared = checkedStages(herd->controller);
      return (stage != crowd::StageId::avoid || herd->avoid) &&
             (stage != crowd::StageId::adapt || herd->adapts) &&
             (stage != crowd::StageId::react || herd->reactions) &&
             std::ranges::find(compared, stage, &CheckedStage::stage) != compared.end();
    });
  };
  for (const crowd::StageId stage : stages)
    if (!isCompared(stage))
      throw inputError(fmt::format("{}: no herd of {} has {} compared", what, scene.name, nameOf(stage)));
}

Lockstep::Lockstep(Crowd& crowd, const Scene& scene, float dt, std::vector<crowd::StageId> only)
    : crowd_(crowd), seed_(scene.seed), only_(std::move(only)) {
  crowd::setTick(implOf(crowd_), dt);  // which herds' parameters depend on
  const bool comparesWake = only_.empty() || std::ranges::find(only_, crowd::StageId::wake) != only_.end();
  if (implOf(crowd_).rates && comparesWake) rates_.emplace(implOf(crowd_));
  followHerds();
}

Lockstep::~Lockstep() = default;

const std::vector<HerdState>& Lockstep::begin() {
  hasBegun_ = true;
  letEventsHappen();
  samples_.clear();
  for (const crowd::HerdRun& of : crowd::allRuns(implOf(crowd_)))
    samples_.push_back(sampleAt(seed_, crowd_.tick() + 1, of.run->agents, agentsATick));
  around_ = surroundingsOf(implOf(crowd_));
  if (rates_) rates_->begin();
  return before_ = download();
}

void Lockstep::edit(uint32_t x0, uint32_t z0, uint32_t columns, uint32_t rows,
                    std::span<const float> heights) {
  crowd_.editHeights(x0, z0, columns, rows, heights);
  for (const Compared& each : compared_) each.replay->edit(x0, z0, columns, rows, heights);
}

const std::vector<HerdState>& Lockstep::end() {
  after_ = download();
  if (rates_) rates_->end();
  followWays();
  for (size_t r = 0; r < compared_.size(); ++r)
    compared_[r].replay->tick(crowd_.tick(), before_[r], after_[r], around_);
  return after_;
}

bool Lockstep::hasRefused() const {
  return (rates_ && rates_->hasRefused()) ||
         std::ranges::any_of(compared_, [](const Compared& each) { return each.replay->hasRefused(); });
}

std::vector<StageResult> Lockstep::results() const {
  std::vector<const Compared*> all;
  for (const std::vector<Compared>* list : {&compared_, &gone_})
    for (const Compared& each : *list) all.push_back(&each);
  std::vector<StageResult> sums;
  for (const crowd::StageId stage : crowd::allStages) {
    const char* name = nameOf(stage);
    StageResult* sum = nullptr;
    if (stage == crowd::StageId::wake && rates_) sums.push_back(rates_->result());
    for (const Compared* each : all) {
      if (!each->hasPlaces) continue;
      for (StageResult result : each->replay->results()) {
        // Who is there for a few ticks may begin no step.
        if (result.name != name || (each->isBrief && result.samples + result.kept == 0)) continue;
        if (all.size() > 1) {
          result.worst = fmt::format("{}: {}", each->name, result.worst);
          if (!result.pass) result.why = fmt::format("{}: {}", each->name, result.why);
        }
        if (sum != nullptr)
          add(result, *sum);
        else
          sum = &sums.emplace_back(result);
      }
    }
  }
  return sums;
}

std::vector<HerdState> Lockstep::download() const {
  return crowd::download(implOf(crowd_), crowd::allRuns(implOf(crowd_)), samples_);
}

// The reference begins with it as the tick does.
void Lockstep::letEventsHappen() {
  Crowd::Impl& impl = implOf(crowd_);
  crowd::letEventsHappen(crowd_);
  followHerds();
  const Heightfield& ground = crowd_.terrain();
  for (const Event& event : crowd::eventsAt(impl.events, crowd_.tick() + 1, double{impl.dt})) {
    const crowd::Rectangle at = crowd::groundOf(event, ground);
    std::vector<float> heights;
    for (uint32_t row = at.z; row < at.z + at.rows; ++row) {
      const auto first = ground.heights.begin() + static_cast<std::ptrdiff_t>(row) * ground.columns + at.x;
      heights.insert(heights.end(), first, first + at.columns);
    }
    for (const Compared& each : compared_) each.replay->edit(at.x, at.z, at.columns, at.rows, heights);
  }
  if (crowd::changesWait(impl)) crowd::applyChanges(impl);
}

// The tick has gone by the fields, and by the ground of trails, as they are now.
void Lockstep::followWays() {
  const Crowd::Impl& impl = implOf(crowd_);
  size_t r = 0;
  for (const crowd::HerdRun& of : crowd::allRuns(impl)) {
    Compared& each = compared_[r++];
    const crowd::Kind& kind = impl.kinds[of.run->kind];
    const uint32_t revision = kind.ways ? kind.ways->revision() : kind.trails ? kind.trails->revision() : 0;
    if (revision == each.wayRevision) continue;
    each.replay->setWays(waysOf(kind), wayPlacesOf(kind));
    each.replay->setForage(forageOf(kind, of.run->firstAgent));
    each.wayRevision = revision;
  }
}

// The reference of a herd that has come begins with the ground as it is.
void Lockstep::followHerds() {
  const Crowd::Impl& impl = implOf(crowd_);
  if (!compared_.empty() && impl.revision == revision_) return;
  revision_ = impl.revision;
  std::vector<Compared> before = std::exchange(compared_, {});
  for (const crowd::HerdRun& of : crowd::allRuns(impl)) {
    const auto known = std::ranges::find(before, of.key(), &Compared::key);
    if (known != before.end()) {
      compared_.push_back(std::move(*known));
      before.erase(known);
    } else {
      compared_.push_back({.key = of.key(),
                           .name = nameOf(impl, of),
                           .hasPlaces = of.run->agents > 0,
                           .isBrief = hasBegun_,
                           .replay = std::make_unique<Replay>(herdFacts(impl, of), only_)});
    }
  }
  for (Compared& each : before) {
    each.isBrief = true;
    gone_.push_back(std::move(each));
  }
}

}  // namespace skitter::validation
