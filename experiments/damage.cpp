#include "experiments/damage.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "base/clock.h"
#include "bench/statistics.h"
#include "skitter/rig.h"

namespace skitter::experiments {
namespace {

constexpr int mostLost = 4;
// An interruption waits for the search's batch, so this one is small.
constexpr uint32_t batch = 1024;

std::vector<uint32_t> patternsOf(const Rig& rig) {
  std::vector<uint32_t> patterns;
  for (uint32_t lost = 0; lost < 1u << rig.legs.size(); ++lost)
    if (std::popcount(lost) <= mostLost) patterns.push_back(lost);
  return patterns;
}

std::vector<LostLegs> judged(Device& device, const Rig& rig, const Settings& settings) {
  const std::vector<uint32_t> patterns = patternsOf(rig);
  const std::vector<GaitJudgement> all =
      judgeGaits(device, rig, patterns, settings.damageSeconds, static_cast<float>(settings.dt));
  const double intact = all.front().speed;
  std::vector<LostLegs> rows;
  for (int legs = 1; legs <= mostLost; ++legs) {
    LostLegs row{.legs = legs};
    std::vector<double> kept;
    for (const GaitJudgement& each : all) {
      if (std::popcount(each.idle) != legs) continue;
      kept.push_back(intact > 0 ? each.speed / intact : 0);
      row.unstable += each.unstable;
    }
    row.patterns = kept.size();
    row.kept = bench::quantile(kept, 0.5);
    row.keptLeast = bench::quantile(kept, 0);
    row.unstable /= static_cast<double>(kept.size());
    rows.push_back(row);
  }
  return rows;
}

}  // namespace

DamageStudy measureDamage(Device& device, const Settings& settings, Course& course) {
  DamageStudy study;
  const Rig rig = spiderRig();
  Rig ruled = rig;
  ruled.gaits = {};
  course.at(0);
  study.byTable = judged(device, rig, settings);
  course.at(0.02);
  study.byRule = judged(device, ruled, settings);
  Evolution search(device, ruled,
                   {.seed = settings.seed,
                    .batch = std::min(batch, settings.damageEvaluations),
                    .dt = static_cast<float>(settings.dt)});
  while (search.evaluations() < settings.damageEvaluations) {
    course.at(0.04 + 0.94 * static_cast<double>(search.evaluations()) / settings.damageEvaluations);
    study.searchSeconds += base::timed([&] { search.step(); }).wall;
  }
  study.evaluations = search.evaluations();
  study.trialSeconds = search.seconds();
  study.cells = search.cellCount();
  study.filled = search.filledCount();
  course.at(0.98);
  study.creatures = search.adapt(settings.damagedCreatures, settings.seed);
  return study;
}

std::vector<uint32_t> DamageStudy::trialsNeeded() const {
  std::vector<uint32_t> needed;
  for (const AdaptationReport& creature : creatures)
    if (creature.trials > 0) needed.push_back(creature.trials);
  std::ranges::sort(needed);
  return needed;
}

Table DamageStudy::table() const {
  Table table{{"lost legs", "patterns", "gaits", "speed kept", "least", "unstable"}};
  for (size_t i = 0; i < byTable.size(); ++i)
    for (const auto& [gaits, row] : {std::pair("evolved", byTable[i]), std::pair("by rule", byRule[i])})
      table.rows.push_back({fmt::format("{}", row.legs), fmt::format("{}", row.patterns), gaits,
                            fmt::format("{:.4f}", row.kept), fmt::format("{:.4f}", row.keptLeast),
                            fmt::format("{:.4f}", row.unstable)});
  return table;
}

}  // namespace skitter::experiments
