#include "app/run/summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "app/common/law_watch.h"
#include "crowd/herd.h"

namespace skitter::app {
namespace {

struct Spread {
  double min, median, max;
};

std::optional<Spread> spreadOf(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const size_t n = values.size();
  return Spread{values.front(), 0.5 * (values[(n - 1) / 2] + values[n / 2]), values.back()};
}

std::optional<double> cpuMicroseconds(const Summary& summary) {
  const auto ticks = static_cast<double>(summary.times.milliseconds.size());
  if (!summary.cpuTold || summary.agents == 0 || ticks == 0) return {};
  return 1e6 * summary.times.cpuSeconds / (static_cast<double>(summary.agents) * ticks);
}

void printRow(const char* name, const std::string& value) { fmt::print("{:<12}{}\n", name, value); }

void printStages(const std::vector<StageTime>& sums, uint64_t count, const char* each) {
  for (const StageTime& stage : sums) {
    printRow("", fmt::format("{:<10}{:9.4f} ms a {}", stage.stage,
                             stage.milliseconds / static_cast<double>(std::max<uint64_t>(count, 1)), each));
  }
}

void printFidelity(const Fidelity& f, uint32_t watchEvery) {
  printRow("watched", fmt::format("1 agent of {} at a time: {} agent-ticks, {} stances", watchEvery,
                                  f.agentTicks, f.stances));
  printRow("feet", fmt::format("slip {:.3f} % of leg length a stance, penetration {:.3f} %, float {:.3f} %, "
                               "skating {:.3f} % of the time",
                               100 * f.slip, 100 * f.penetration, 100 * f.floating, 100 * f.skating));
  printRow(
      "legs",
      fmt::format("{:.3f} % of leg length below the ground, at most {:.3f} %; {:.3f} % of neighbours cross",
                  100 * f.segmentPenetration, 100 * f.segmentPenetrationMost, 100 * f.crossing));
  printRow("reach error", fmt::format("{:.4f} % of leg length (99th percentile), at most {:.4f} %",
                                      100 * f.reachErrorP99, 100 * f.reachErrorMost));
  printRow("limits", f.limitViolation ? fmt::format("exceeded by at most {:.6f} rad, {:.3f} % of the time",
                                                    *f.limitViolation, 100 * f.limitViolations.value_or(0))
                                      : "not judged: legs move as their clips do");
  printRow("jerk", fmt::format("feet {:.0f}, body {:.0f} (normalised, 0.4 s)", f.footJerk, f.bodyJerk));
  printRow("stability",
           fmt::format("margin {:.2f} % of leg length, least {:.2f} %; unstable {:.3f} % of the time",
                       100 * f.margin, 100 * f.marginLeast, 100 * f.unstable));
}

void printCrowding(const Crowding& crowding, const Jams& jams) {
  if (crowding.overlapMost)
    printRow("crowding",
             fmt::format("agents overlap by at most {:.1f} %, {:.4f} % an agent; {:.4f} pairs an agent",
                         100 * *crowding.overlapMost, 100 * crowding.overlapMean.value_or(0),
                         crowding.pairs.value_or(0)));
  if (jams.stuck)
    printRow("jams",
             fmt::format("{} agents were stuck, {} have arrived; agents are in jams {:.1f} % of the time",
                         *jams.stuck, jams.arrived.value_or(0), 100 * jams.jammed.value_or(0)));
  if (jams.legCrossings)
    printRow("crossings",
             fmt::format("legs cross another's in {:.3f} % of the time, outside of jams in {:.3f} %",
                         100 * *jams.legCrossings, 100 * jams.legCrossingsOutsideJams.value_or(0)));
  if (jams.flow)
    printRow("flow",
             fmt::format("at most {:.2f} agents pass a second and metre, with pauses of up to {:.1f} s",
                         jams.flow->flow, jams.flow->pause));
  if (crowding.droppedNeighbours.value_or(0) > 0)
    printRow("neighbours", fmt::format("{} were in reach beyond the nearest {}", *crowding.droppedNeighbours,
                                       shared::NEIGHBOURS));
}

void printDamage(const DamageFigures& damage) {
  if (damage.agents == 0) return printRow("damage", "nobody was hurt two seconds after the last loss");
  const std::string speed =
      damage.speedKept
          ? fmt::format(
                "{:.1f} % of their speed{}", 100 * *damage.speedKept,
                damage.counts().value_or(false) ? "" : " (which does not count, for feet slide or miss)")
          : "speed not compared";
  printRow("damage", fmt::format("{} agents are hurt: {}, unstable {:.3f} % of the time; slip at most {:.3f} "
                                 "% of leg length a stance, reach error {:.4f} % (99th percentile)",
                                 damage.agents, speed, 100 * damage.unstable.value_or(0),
                                 100 * damage.slip.value_or(0), 100 * damage.reachErrorP99.value_or(0)));
}

nlohmann::ordered_json jsonOf(const Crowding& crowding, const Jams& jams) {
  return {{"overlapMost", orNull(crowding.overlapMost)},
          {"overlapMean", orNull(crowding.overlapMean)},
          {"stuck", orNull(jams.stuck)},
          {"arrived", orNull(jams.arrived)},
          {"legCrossings", orNull(jams.legCrossings)},
          {"legCrossingsOutsideJams", orNull(jams.legCrossingsOutsideJams)},
          {"jammed", orNull(jams.jammed)},
          {"flow", jams.flow ? nlohmann::ordered_json(jams.flow->flow) : nullptr},
          {"pause", jams.flow ? nlohmann::ordered_json(jams.flow->pause) : nullptr},
          {"pairs", orNull(crowding.pairs)},
          {"droppedNeighbours", orNull(crowding.droppedNeighbours)}};
}

nlohmann::ordered_json jsonOf(const std::vector<ReactionFigures>& herds) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const ReactionFigures& herd : herds)
    all.push_back({{"herd", herd.herd},
                   {"falls", herd.falls},
                   {"stands", herd.stands},
                   {"down", herd.down},
                   {"standUpSeconds", orNull(herd.standUpSeconds())}});
  return all;
}

nlohmann::ordered_json jsonOf(const std::vector<SearchFigures>& herds) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const SearchFigures& herd : herds)
    all.push_back({{"herd", herd.herd},
                   {"searching", herd.searching},
                   {"settled", herd.settled},
                   {"trialsMedian", orNull(herd.trialsMedian())},
                   {"trialsMost", orNull(herd.trialsMost())},
                   {"fitness", orNull(herd.fitness())}});
  return all;
}

void printLevels(const std::vector<LevelFigures>& levels) {
  for (const LevelFigures& level : levels)
    printRow(level.rate == 1 ? "levels" : "",
             fmt::format("every {} {}: {} agents, {} agent-ticks{}", level.rate,
                         level.rate == 1 ? "tick" : "ticks", level.agents, level.agentTicks,
                         level.slip ? fmt::format(", slip {:.3f} % of leg length a stance", 100 * *level.slip)
                                    : std::string()));
}

nlohmann::ordered_json jsonOf(const std::vector<LevelFigures>& levels) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const LevelFigures& level : levels)
    all.push_back({{"rate", level.rate},
                   {"agents", level.agents},
                   {"agentTicks", level.agentTicks},
                   {"slip", orNull(level.slip)}});
  return all;
}

void printMemory(const std::vector<MemoryUse>& memory, uint64_t agents) {
  const double each = 1 / static_cast<double>(std::max<uint64_t>(agents, 1));
  uint64_t all = 0;
  std::string parts;
  for (const MemoryUse& use : memory) {
    all += use.bytes;
    const double bytes = each * static_cast<double>(use.bytes);
    if (bytes < 0.05) continue;  // what there is once a page
    parts += fmt::format("{}{} {:.{}f}", parts.empty() ? "" : ", ", use.name, bytes, bytes < 10 ? 1 : 0);
  }
  printRow("memory",
           fmt::format("{:.1f} MiB, {:.0f} bytes an agent: {}", static_cast<double>(all) / (1 << 20),
                       each * static_cast<double>(all), parts));
}

nlohmann::ordered_json jsonOf(const Fidelity& f) {
  return {{"agentTicks", f.agentTicks},
          {"stances", f.stances},
          {"slip", f.slip},
          {"skating", f.skating},
          {"penetration", f.penetration},
          {"penetrationBeyond", f.penetrationBeyond},
          {"float", f.floating},
          {"floatBeyond", f.floatingBeyond},
          {"segmentPenetration", f.segmentPenetration},
          {"segmentPenetrationMost", f.segmentPenetrationMost},
          {"crossing", f.crossing},
          {"reachErrorP99", f.reachErrorP99},
          {"reachErrorMost", f.reachErrorMost},
          {"limitViolation", orNull(f.limitViolation)},
          {"limitViolations", orNull(f.limitViolations)},
          {"footJerk", f.footJerk},
          {"bodyJerk", f.bodyJerk},
          {"margin", f.margin},
          {"marginLeast", f.marginLeast},
          {"unstable", f.unstable},
          {"lastResorts", f.lastResorts},
          {"notFinite", f.notFinite}};
}

}  // namespace

std::optional<double> ReactionFigures::standUpSeconds() const {
  if (stands == 0) return {};
  return seconds / static_cast<double>(stands);
}

std::vector<ReactionFigures> reactionFigures(const Crowd& crowd) {
  std::vector<ReactionFigures> all;
  const Crowd::Impl& impl = implOf(crowd);
  for (uint32_t h = 0; h < crowd.herdCount(); ++h) {
    if (impl.herds[h].isGone() || !impl.herds[h].from.reactions) continue;
    ReactionFigures& herd = all.emplace_back(ReactionFigures{.herd = h});
    for (const Reaction& each : crowd.reactions(h)) {
      herd.falls += each.falls;
      herd.stands += each.stands;
      herd.down += each.phase >= ReactionPhase::falling;
      herd.seconds += double{each.downBefore};
    }
  }
  return all;
}

std::optional<uint32_t> SearchFigures::trialsMedian() const {
  if (trials.empty()) return {};
  return trials[(trials.size() - 1) / 2];
}

std::optional<uint32_t> SearchFigures::trialsMost() const {
  if (trials.empty()) return {};
  return trials.back();
}

std::optional<double> SearchFigures::fitness() const {
  if (settled == 0) return {};
  return sumOfBest / static_cast<double>(settled);
}

std::vector<SearchFigures> searchFigures(const Crowd& crowd) {
  std::vector<SearchFigures> all;
  const Crowd::Impl& impl = implOf(crowd);
  for (uint32_t h = 0; h < crowd.herdCount(); ++h) {
    if (impl.herds[h].isGone() || !impl.herds[h].from.adapts) continue;
    SearchFigures& herd = all.emplace_back(SearchFigures{.herd = h});
    for (const Search& each : crowd.searches(h)) {
      herd.searching += each.phase == SearchPhase::searching;
      if (each.phase != SearchPhase::settled) continue;
      ++herd.settled;
      herd.trials.push_back(each.trials);
      herd.sumOfBest += double{each.best};
    }
    std::ranges::sort(herd.trials);
  }
  return all;
}

void Summary::print() const {
  printRow("device", device);
  printRow("terrain", filledVoids > 0 ? fmt::format("{}, voids filled: {}", terrain, filledVoids) : terrain);
  printRow("agents", fmt::format("{}", agents));
  printRow("ticks", fmt::format("{}{}{}{}", ticks,
                                interrupted && wantedTicks ? fmt::format(" of {}", *wantedTicks) : "",
                                resumedAt ? fmt::format(", of which {} before this run", *resumedAt) : "",
                                interrupted ? ", interrupted" : ""));
  if (sleeping) printRow("asleep", fmt::format("{} agents at the end", *sleeping));
  if (frames > 0) printRow("frames", fmt::format("{}", frames));
  if (const auto tick = spreadOf(times.milliseconds)) {
    printRow("a tick",
             fmt::format("{:.3f} ms median, {:.3f} to {:.3f} ms", tick->median, tick->min, tick->max));
  }
  if (const auto cpu = cpuMicroseconds(*this))
    printRow("CPU", fmt::format("{:.3f} us an agent and tick", *cpu));
  printStages(times.stages, times.milliseconds.size(), "tick");
  printStages(drawing, frames, "frame");
  if (lawSeconds) printStages({{"laws (CPU)", 1e3 * *lawSeconds}}, times.milliseconds.size(), "tick");
  if (!times.stages.empty()) {
    printRow("start", fmt::format("{:.3f} s, {:.3f} s of CPU", startSeconds, startCpuSeconds));
    printMemory(memory, agents);
  }
  printFidelity(fidelity, watchEvery);
  printCrowding(crowding, jams);
  printLevels(levels);
  if (damage) printDamage(*damage);
  for (const ForageFigures& herd : foraging)
    printRow("foraging", fmt::format("herd {}: {} loads carried home, {} returns without one", herd.herd,
                                     herd.done.brought, herd.done.empty));
  for (const ReactionFigures& herd : reactions)
    printRow("reactions",
             fmt::format("herd {}: {} falls, {} stood again after {:.2f} s, {} are down", herd.herd,
                         herd.falls, herd.stands, herd.standUpSeconds().value_or(0), herd.down));
  for (const SearchFigures& herd : searches)
    printRow(
        "adapting",
        fmt::format("herd {}: {} agents try gaits; {} have found one, after {} trials in the median and {} "
                    "at most, of fitness {:.3f}",
                    herd.herd, herd.searching, herd.settled, herd.trialsMedian().value_or(0),
                    herd.trialsMost().value_or(0), herd.fitness().value_or(0)));
  for (size_t i = 0; i < herds.size() && herds.size() > 1; ++i) {
    fmt::print("herd {}: {}, {} agents\n", herds[i].number, herds[i].rig, herds[i].agents);
    printFidelity(herds[i].fidelity, watchEvery);
  }
  if (fidelity.lastResorts > 0)
    printRow("no foothold", fmt::format("{} steps, a last resort", fidelity.lastResorts));
  if (fidelity.notFinite > 0) printRow("not finite", fmt::format("{} foot targets", fidelity.notFinite));
  printRow("state hash", fmt::format("{:016x}", stateHash));
  for (const std::string& file : files) printRow("written", file);
}

nlohmann::ordered_json Summary::json() const {
  const auto tick = spreadOf(times.milliseconds);
  nlohmann::ordered_json milliseconds = {{"min", nullptr}, {"median", nullptr}, {"max", nullptr}};
  if (tick) milliseconds = {{"min", tick->min}, {"median", tick->median}, {"max", tick->max}};
  nlohmann::ordered_json perHerd = nlohmann::ordered_json::array();
  for (const HerdFigures& herd : herds)
    perHerd.push_back({{"number", herd.number},
                       {"rig", herd.rig},
                       {"agents", herd.agents},
                       {"cannotReach", herd.cannotReach},
                       {"fidelity", jsonOf(herd.fidelity)}});
  return {{"device", device},
          {"agents", agents},
          {"sleeping", orNull(sleeping)},
          {"ticks", ticks},
          {"ticksWanted", orNull(wantedTicks)},
          {"resumedAt", orNull(resumedAt)},
          {"interrupted", interrupted},
          {"seed", seed},
          {"tickMilliseconds", milliseconds},
          {"cpuMicrosecondsPerAgentTick", orNull(cpuMicroseconds(*this))},
          {"watchEvery", watchEvery},
          {"fidelity", jsonOf(fidelity)},
          {"crowding", jsonOf(crowding, jams)},
          {"foraging", jsonOf(foraging)},
          {"damage", damage ? jsonOf(*damage) : nlohmann::ordered_json(nullptr)},
          {"reactions", jsonOf(reactions)},
          {"searches", jsonOf(searches)},
          {"levels", jsonOf(levels)},
          {"herds", perHerd},
          {"warnings", warnings ? warningsJson(*warnings) : nlohmann::ordered_json(nullptr)},
          {"stateHash", fmt::format("{:016x}", stateHash)}};
}

}  // namespace skitter::app
