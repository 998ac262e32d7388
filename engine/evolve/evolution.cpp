#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <optional>
#include <utility>

#include "base/split_mix.h"
#include "crowd/herd.h"
#include "crowd/regait.h"
#include "crowd/symmetry.h"
#include "evolve/adaptation.h"
#include "evolve/archive.h"
#include "evolve/genes.h"
#include "evolve/map_file.h"
#include "evolve/patterns.h"
#include "evolve/trials.h"
#include "gpu/submit.h"
#include "skitter/error.h"
#include "skitter/evolve.h"

namespace skitter {
namespace {

// Candidates of a pattern that are no children: the gait by rule, and drawn ones.
constexpr uint64_t candidatesAtFirst = 32;

std::vector<uint32_t> searchedPatterns(const Rig& rig) {
  std::vector<uint32_t> patterns = evolve::patternsOf(rig);
  if (patterns.empty())
    throw inputError(
        fmt::format("{}: has {} legs, expected at least 4: on fewer than three a creature lies down",
                    rig.name, rig.legs.size()));
  return patterns;
}

void checkEvolution(const EvolutionOptions& options) {
  if (options.batch < 1 || options.batch > EvolutionOptions::maxBatch)
    throw inputError(
        fmt::format("batch of a search is {}, expected 1 to {}", options.batch, EvolutionOptions::maxBatch));
  if (!(options.dt >= EvolutionOptions::minDt && options.dt <= EvolutionOptions::maxDt))
    throw inputError(fmt::format("dt of a search is {}, expected {:.4g} to {:.4g} s", options.dt,
                                 EvolutionOptions::minDt, EvolutionOptions::maxDt));
}

size_t carriersOf(const Rig& rig, uint32_t idle) {
  return rig.legs.size() - static_cast<size_t>(std::popcount(idle));
}

// A gait of the map, for the legs that it was found for or for their mirror images.
struct KnownGait {
  RigGait gait;
  float fitness;
};

// Everything that the map has: behaviours, and the gaits that lead to them, by the same numbers.
struct KnownGaits {
  evolve::BehaviourMap map;
  std::vector<KnownGait> gaits = {};

  explicit KnownGaits(size_t legs) : map(legs) {}
  void add(const RigGait& gait, std::span<const float> shares, float fitness) {
    map.add(shares, fitness);
    gaits.push_back({gait, fitness});
  }
  // The best fitness of a gait for these legs; 0 where there is none.
  double bestWithout(uint32_t idle) const {
    double best = 0;
    for (const KnownGait& known : gaits)
      if (known.gait.idle == idle) best = std::max(best, double{known.fitness});
    return best;
  }
};

constexpr double nearlyAsGood = 0.9;
constexpr uint64_t mostLost = 3;
constexpr size_t mindsAtOnce = 128;  // each remembers 20 numbers for each gait of the map

uint32_t drawnLoss(base::SplitMix64& random, size_t legs) {
  const auto count = static_cast<int>(1 + random() % mostLost);
  uint32_t lost = 0;
  while (std::popcount(lost) < count) lost |= 1u << random() % legs;
  return lost;
}

}  // namespace

struct Evolution::Impl {
  Impl(Device& madeOn, const Rig& rigOf, const EvolutionOptions& asked)
      : device(&madeOn),
        rig(evolve::bareRig(rigOf)),
        options(asked),
        patterns(searchedPatterns(rig)),
        space(rig, tuning, wantedSpeed),
        state{.seed = asked.seed,
              .batch = asked.batch,
              .dt = asked.dt,
              .archive = evolve::Archive(patterns.size())} {}

  void makeTrials() {
    checkEvolution(options);
    trials = std::make_unique<evolve::Trials>(*device, rig, options.batch, options.dt, options.shader);
    options.shader = {};  // it has been read
  }

  evolve::Genes candidate(uint64_t number) const;
  KnownGaits known() const;
  void adaptAll(const KnownGaits& known, std::span<AdaptationReport> reports) const;
  void enter(uint64_t number, evolve::Genes genes, const evolve::TrialFigures& figures);

  Device* device;
  Rig rig;
  Tuning tuning;
  EvolutionOptions options;
  std::vector<uint32_t> patterns;
  evolve::GeneSpace space;
  evolve::SearchState state;
  std::unique_ptr<evolve::Trials> trials;
};

evolve::Genes Evolution::Impl::candidate(uint64_t number) const {
  const size_t pattern = static_cast<size_t>(number % patterns.size());
  const uint64_t ofPattern = number / patterns.size();
  if (ofPattern == 0)
    return space.encode(crowd::regaitByRule(rig, tuning, {.idle = patterns[pattern]}), patterns[pattern]);
  base::SplitMix64 random(base::SplitMix64::draw(state.seed, number + 1));
  const std::vector<const evolve::Elite*> elites = state.archive.elitesOf(pattern);
  if (ofPattern < candidatesAtFirst || elites.empty()) return space.drawn(random);
  const evolve::Elite& elite = *elites[random() % elites.size()];
  const evolve::Elite& other = *elites[random() % elites.size()];
  return space.varied(elite.genes, other.genes, random);
}

void Evolution::Impl::enter(uint64_t number, evolve::Genes genes, const evolve::TrialFigures& figures) {
  const size_t pattern = static_cast<size_t>(number % patterns.size());
  const uint32_t idle = patterns[pattern];
  const double fitness = evolve::fitnessOf(figures, double{rig.legLength}, carriersOf(rig, idle),
                                           trials->countedSeconds(), wantedSpeed);
  const uint32_t cell = evolve::cellOf(rig, idle, figures.shares);
  state.archive.offer(pattern, cell,
                      {.candidate = number,
                       .fitness = static_cast<float>(fitness),
                       .genes = std::move(genes),
                       .shares = figures.shares});
}

Evolution::Evolution(Device& device, const Rig& rig, const EvolutionOptions& options)
    : impl_(std::make_unique<Impl>(device, rig, options)) {
  impl_->makeTrials();
}

Evolution::Evolution(Device& device, const Rig& rig, const std::string& map, const std::string& name,
                     const TrialShader& shader)
    : impl_(std::make_unique<Impl>(device, rig, EvolutionOptions{.shader = shader})) {
  Impl& search = *impl_;
  search.state = evolve::readMap(map, name, search.rig, search.patterns, search.space.count());
  search.options.seed = search.state.seed;
  search.options.batch = search.state.batch;
  search.options.dt = search.state.dt;
  search.makeTrials();
}

Evolution::~Evolution() = default;
Evolution::Evolution(Evolution&&) noexcept = default;
Evolution& Evolution::operator=(Evolution&&) noexcept = default;

void Evolution::step() {
  Impl& search = *impl_;
  const uint64_t first = search.state.evaluations;
  std::vector<evolve::Genes> candidates;
  std::vector<evolve::TrialTask> tasks;
  for (uint64_t number = first; number < first + search.options.batch; ++number) {
    candidates.push_back(search.candidate(number));
    const uint32_t idle = search.patterns[number % search.patterns.size()];
    const RigGait gait = search.space.decode(candidates.back(), idle);
    tasks.push_back({idle, crowd::regaitOf(search.rig, gait, {.idle = idle})});
  }
  const std::vector<evolve::TrialFigures> figures = search.trials->run(tasks);
  for (size_t i = 0; i < figures.size(); ++i) search.enter(first + i, std::move(candidates[i]), figures[i]);
  search.state.evaluations += search.options.batch;
}

const EvolutionOptions& Evolution::options() const { return impl_->options; }
uint64_t Evolution::evaluations() const { return impl_->state.evaluations; }
uint32_t Evolution::patternCount() const { return static_cast<uint32_t>(impl_->patterns.size()); }
uint64_t Evolution::cellCount() const { return impl_->state.archive.cellCount(); }
uint64_t Evolution::filledCount() const { return impl_->state.archive.filledCount(); }
double Evolution::seconds() const { return impl_->trials->seconds(); }

std::vector<RigGait> Evolution::gaits() const {
  std::vector<RigGait> gaits;
  for (size_t pattern = 0; pattern < impl_->patterns.size(); ++pattern) {
    const evolve::Elite* best = impl_->state.archive.bestOf(pattern);
    if (best == nullptr) continue;
    gaits.push_back(impl_->space.decode(best->genes, impl_->patterns[pattern]));
    gaits.back().fitness = best->fitness;
  }
  return gaits;
}

std::string Evolution::map() const { return evolve::writeMap(impl_->rig, impl_->patterns, impl_->state); }

KnownGaits Evolution::Impl::known() const {
  KnownGaits all(rig.legs.size());
  const std::vector<size_t> mirror = crowd::mirroredLegs(rig);
  for (size_t pattern = 0; pattern < patterns.size(); ++pattern) {
    for (const evolve::Elite* elite : state.archive.elitesOf(pattern)) {
      const RigGait gait = space.decode(elite->genes, patterns[pattern]);
      all.add(gait, elite->shares, elite->fitness);
      if (mirror.empty() || crowd::mirrored(gait.idle, mirror) == gait.idle) continue;
      std::vector<float> shares(elite->shares.size());
      for (size_t leg = 0; leg < shares.size(); ++leg) shares[mirror[leg]] = elite->shares[leg];
      all.add(crowd::mirrorImage(gait, mirror), shares, elite->fitness);
    }
  }
  return all;
}

// All who go on try at once, until nobody does.
void Evolution::Impl::adaptAll(const KnownGaits& known, std::span<AdaptationReport> reports) const {
  std::vector<evolve::Adaptation> minds(reports.size(),
                                        evolve::Adaptation(known.map, evolve::AdaptationOptions{}));
  while (true) {
    std::vector<std::pair<size_t, uint32_t>> tried;
    std::vector<evolve::TrialTask> tasks;
    for (size_t i = 0; i < minds.size(); ++i) {
      const std::optional<uint32_t> next = minds[i].next();
      if (!next) continue;
      const RigGait& gait = known.gaits[*next].gait;
      tried.emplace_back(i, *next);
      tasks.push_back({gait.idle | reports[i].lost, crowd::regaitOf(rig, gait, {.idle = gait.idle})});
    }
    if (tasks.empty()) return;
    const std::vector<evolve::TrialFigures> figures = trials->run(tasks);
    for (size_t t = 0; t < tried.size(); ++t) {
      const auto [i, behaviour] = tried[t];
      const double fitness =
          evolve::fitnessOf(figures[t], double{rig.legLength}, carriersOf(rig, tasks[t].idle),
                            trials->countedSeconds(), wantedSpeed);
      minds[i].tell(behaviour, fitness);
      reports[i].found = minds[i].bestFitness();
      reports[i].used = minds[i].trials();
      const bool isNearlyAsGood = reports[i].found >= nearlyAsGood * reports[i].bestKnown;
      if (isNearlyAsGood && reports[i].trials == 0) reports[i].trials = reports[i].used;
    }
  }
}

std::vector<AdaptationReport> Evolution::adapt(uint32_t creatures, uint64_t seed) const {
  const Impl& search = *impl_;
  const KnownGaits known = search.known();
  base::SplitMix64 random(seed);
  std::vector<AdaptationReport> reports;
  for (uint32_t creature = 0; creature < creatures; ++creature) {
    const uint32_t lost = drawnLoss(random, search.rig.legs.size());
    const double best = known.bestWithout(lost);
    if (best > 0) reports.push_back({.lost = lost, .bestKnown = best});
  }
  const size_t atOnce = std::min<size_t>(mindsAtOnce, search.options.batch);
  for (size_t first = 0; first < reports.size(); first += atOnce)
    search.adaptAll(known, std::span(reports).subspan(first, std::min(atOnce, reports.size() - first)));
  return reports;
}

}  // namespace skitter
