#include "app/evolve/judgement.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "crowd/symmetry.h"
#include "evolve/patterns.h"
#include "skitter/error.h"

namespace skitter::app {
namespace {

// A walk ends within a cycle, which lasts at most 1 s of its 20 s. The mean of a part of a cycle is taken to
// be off by at most a fifth, so a difference below 1/100 may come from where the walk ends.
constexpr double leastGain = 0.01;

// The patterns that a gait is searched for and their mirror images, in ascending order.
std::vector<uint32_t> allPatternsOf(const Rig& rig) {
  std::vector<uint32_t> all = evolve::patternsOf(rig);
  const std::vector<size_t> mirror = crowd::mirroredLegs(rig);
  if (mirror.empty()) return all;
  const size_t searched = all.size();
  for (size_t i = 0; i < searched; ++i)
    if (const uint32_t image = crowd::mirrored(all[i], mirror); image != all[i]) all.push_back(image);
  std::ranges::sort(all);
  return all;
}

bool isInTable(const Rig& rig, uint32_t idle) {
  const std::vector<size_t> mirror = crowd::mirroredLegs(rig);
  const uint32_t image = mirror.empty() ? idle : crowd::mirrored(idle, mirror);
  return std::ranges::any_of(rig.gaits,
                             [&](const RigGait& gait) { return gait.idle == idle || gait.idle == image; });
}

// How creatures got on that lack so many legs.
struct Shares {
  std::vector<double> kept = {};
  double unstable = 0;

  void add(double speedKept, double timeUnstable) {
    kept.push_back(speedKept);
    unstable += timeUnstable;
  }
  std::string text() {
    std::ranges::sort(kept);
    return fmt::format("{:.1f} % (least {:.1f}), unstable {:.1f} %", 100 * kept[(kept.size() - 1) / 2],
                       100 * kept.front(), 100 * unstable / static_cast<double>(kept.size()));
  }
};

}  // namespace

double worthOf(const GaitJudgement& judged) {
  return std::clamp(judged.speed / double{Evolution::wantedSpeed}, 0.0, 1.0) * (1 - judged.unstable);
}

std::vector<RigGait> betterThanRule(std::span<const RigGait> gaits, std::span<const GaitJudgement> found,
                                    std::span<const GaitJudgement> byRule) {
  std::vector<RigGait> better;
  for (size_t i = 0; i < gaits.size(); ++i)
    if (found[i].unstable <= byRule[i].unstable && worthOf(found[i]) >= worthOf(byRule[i]) + leastGain)
      better.push_back(gaits[i]);
  return better;
}

nlohmann::ordered_json jsonOf(const GaitJudgement& judged) {
  return {{"speed", judged.speed},
          {"unstable", judged.unstable},
          {"margin", judged.margin},
          {"slip", judged.slip},
          {"reachErrorMost", judged.reachError}};
}

nlohmann::ordered_json namesOf(const Rig& rig, uint32_t legs) {
  nlohmann::ordered_json names = nlohmann::ordered_json::array();
  for (size_t leg = 0; leg < rig.legs.size(); ++leg)
    if ((legs >> leg & 1u) != 0) names.push_back(rig.legs[leg].name);
  return names;
}

TableReport::TableReport(Device& device, const Rig& rig, float dt) {
  std::vector<uint32_t> idle = allPatternsOf(rig);
  if (idle.empty())
    throw inputError(fmt::format("{}: has {} legs, expected at least 4", rig.name, rig.legs.size()));
  idle.push_back(0);
  Rig ruled = rig;
  ruled.gaits = {};
  const std::vector<GaitJudgement> byTable = judgeGaits(device, rig, idle, judgedSeconds, dt),
                                   byRule = judgeGaits(device, ruled, idle, judgedSeconds, dt),
                                   unadapted = judgeUnadapted(device, ruled, idle, judgedSeconds, dt);
  intact_ = byRule.back();
  for (size_t i = 0; i + 1 < idle.size(); ++i)
    patterns_.push_back(
        {namesOf(rig, idle[i]), isInTable(rig, idle[i]), byTable[i], byRule[i], unadapted[i]});
}

nlohmann::ordered_json TableReport::jsonOfPattern(const Pattern& pattern) const {
  const auto withKept = [&](const GaitJudgement& judged) {
    nlohmann::ordered_json json = {{"speedKept", keptOf(judged)}};
    json.update(jsonOf(judged));
    return json;
  };
  return {{"without", pattern.without},
          {"inTable", pattern.inTable},
          {"byTable", withKept(pattern.byTable)},
          {"byRule", withKept(pattern.byRule)},
          {"unadapted", withKept(pattern.unadapted)}};
}

nlohmann::ordered_json TableReport::json() const {
  nlohmann::ordered_json patterns = nlohmann::ordered_json::array();
  for (const Pattern& pattern : patterns_) patterns.push_back(jsonOfPattern(pattern));
  return {{"judgedSeconds", judgedSeconds}, {"intact", jsonOf(intact_)}, {"judgedPatterns", patterns}};
}

std::string TableReport::lineWithout(int idle) const {
  Shares byTable, byRule, unadapted;
  size_t inTable = 0;
  for (const Pattern& pattern : patterns_) {
    if (std::popcount(pattern.byRule.idle) != idle) continue;
    byTable.add(keptOf(pattern.byTable), pattern.byTable.unstable);
    byRule.add(keptOf(pattern.byRule), pattern.byRule.unstable);
    unadapted.add(keptOf(pattern.unadapted), pattern.unadapted.unstable);
    inTable += pattern.inTable;
  }
  if (byTable.kept.empty()) return {};
  return fmt::format("without {:<7}{} patterns, {} in the table: speed kept {}; by rule {}; unadapted {}\n",
                     idle, byTable.kept.size(), inTable, byTable.text(), byRule.text(), unadapted.text());
}

std::string TableReport::text() const {
  std::string text = fmt::format("intact         {:.3f} leg lengths/s, unstable {:.1f} %, for {} s\n",
                                 intact_.speed, 100 * intact_.unstable, judgedSeconds);
  for (int idle = 1; idle <= static_cast<int>(Rig::maxLegs); ++idle) text += lineWithout(idle);
  return text;
}

}  // namespace skitter::app
