#include "validation/replay.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "base/split_mix.h"
#include "cpu_reference/stages/rate.h"
#include "crowd/controller.h"
#include "crowd/record.h"
#include "shared/ik_batch.h"
#include "skitter/error.h"
#include "skitter/records.h"
#include "validation/checks.h"
#include "validation/convert.h"
#include "validation/convert_clip.h"

namespace skitter::validation {
namespace {

void expectSize(const char* what, size_t found, size_t expected) {
  if (found == expected) return;
  throw inputError(std::string(what) + ": found " + std::to_string(found) + " floats, expected " +
                   std::to_string(expected));
}

// Records that may be left out are all here or none is.
void expectSizes(const Setting& setting, const HerdState& state) {
  const size_t agents = state.agents;
  for (const Record record : allRecords) {
    const crowd::RecordInfo info = crowd::infoOf(record);
    if (info.per == crowd::Per::watched || (info.kept != crowd::Kept::always && state.of(record).empty()))
      continue;
    const int stride =
        crowd::strideOf(record, setting.legs, setting.bones, static_cast<int>(setting.clips.joints()));
    const size_t count = info.per == crowd::Per::leg ? static_cast<size_t>(setting.legs) : 1;
    expectSize((std::string(info.name) + " records").c_str(), state.of(record).size(),
               4 * agents * count * static_cast<size_t>(stride));
  }
  if (state.metric.empty() || agents == 0) return;
  const auto floats = static_cast<size_t>(4 * shared::watchStride(setting.legs));
  const size_t last = state.sample.first + (agents - 1) * state.sample.stride;
  if (state.watch.size() % floats != 0 ||
      state.watch.size() / floats <= (state.watchOffset + last) / state.watchEvery)
    throw inputError("watch records: found " + std::to_string(state.watch.size()) + " floats, " +
                     std::to_string(floats) + " an agent that is watched, and agent " + std::to_string(last) +
                     " is not among them");
}

// The records that the stage writes of sleepers, too, but not of those whose turn it is not.
std::vector<Record> writtenOfSleepers(crowd::StageId stage) {
  if (stage == crowd::StageId::navigate) return {Record::goal, Record::steer, Record::forager};
  if (stage == crowd::StageId::avoid) return {Record::avoid};
  return {};
}

// Whether the agent, of a herd that avoids, does so in that tick.
bool looksAround(const Setting& setting, const Moment& moment) {
  return reference::looksAround(setting.firstInKind + static_cast<int64_t>(moment.number()), moment.n,
                                reference::roundTicks(setting.tuning.dt));
}

// How many ticks the agent's last one was.
uint64_t spanOf(const HerdState& after, size_t agent) {
  if (after.rate.empty()) return 1;
  return uint64_t{1} << static_cast<int>(after.rate[4 * shared::RATE_STRIDE * agent + 1]);
}

}  // namespace

AgentSample sampleAt(uint64_t seed, uint64_t n, uint32_t agents, uint32_t most) {
  using base::SplitMix64;
  const uint32_t stride = agents / most + 1;
  return {static_cast<uint32_t>(SplitMix64::draw(seed ^ SplitMix64::draw(n)) % stride), stride};
}

bool hasTurn(uint64_t n, const HerdState& after, size_t agent) {
  return after.rate.empty() || after.rate[4 * shared::RATE_STRIDE * agent + 2] == static_cast<float>(n);
}

HerdState sampled(const HerdState& whole, const AgentSample& sample) {
  HerdState part;
  part.tick = whole.tick;
  part.sample = sample;
  part.watched = whole.watched;
  part.sleep = whole.sleep;
  part.trail = whole.trail;
  for (size_t agent = sample.first; agent < whole.agents; agent += sample.stride) ++part.agents;
  for (const Record record : allRecords) {
    if (crowd::infoOf(record).per == crowd::Per::watched) continue;
    const std::vector<float>& from = whole.of(record);
    const size_t each = from.size() / std::max(1u, whole.agents);
    for (size_t agent = sample.first; agent < whole.agents; agent += sample.stride)
      part.of(record).insert(part.of(record).end(), from.begin() + static_cast<ptrdiff_t>(agent * each),
                             from.begin() + static_cast<ptrdiff_t>((agent + 1) * each));
  }
  return part;
}

Setting settingOf(const HerdFacts& herd, const Heightfield& terrain) {
  const Rig& rig = herd.rig;
  size_t bones = 0;
  for (const Leg& leg : rig.legs) bones = std::max(bones, leg.bones.size());
  Setting setting;
  setting.controller = herd.controller;
  setting.legs = rig.legCount();
  setting.bones = static_cast<int>(bones);
  expectSize("rig records", herd.rigRecords.size(),
             4 * rig.legs.size() * static_cast<size_t>(shared::rigStride(setting.bones)));
  setting.tuning = tuningOf(herd.parameters);
  setting.heights = heightsOf(terrain, herd.parameters);
  setting.creature = creatureOf(herd.rigRecords, setting.legs, setting.bones, rig.groupCount());
  setting.extent = std::max({std::abs(setting.heights.originX), std::abs(setting.heights.originZ),
                             setting.tuning.halfExtentX, setting.tuning.halfExtentZ});
  // The reference has no `automatic`.
  setting.ik = {static_cast<reference::IkSolver>(herd.ik.solver - shared::SOLVER_FABRIK), herd.ik.approach,
                herd.ik.polish};
  setting.avoid = herd.avoid;
  setting.firstNumber = herd.firstNumber;
  setting.firstInKind = herd.firstInKind;
  setting.ways = herd.ways;
  setting.wayPlaces = herd.wayPlaces;
  setting.forage = herd.forage;
  setting.gaitMap = gaitMapOf(herd.gaitMap, setting.legs);
  if (crowd::traitsOf(herd.controller).playsClips)
    setting.clips = clipTableOf(herd.clips, setting.legs, setting.bones);
  if (herd.controller == Controller::keyPoses)
    setting.keyPoses = keyPosesOf(herd.keyPoses, setting.legs, setting.bones);
  return setting;
}

reference::Creature hurtCreatureOf(const Setting& herd, const HerdState& state, size_t agent) {
  reference::Creature creature = reference::hurtCreature(herd.creature, hurtOf(state, agent, herd.legs));
  creature.load = carriedMassOf(state, agent);
  creature.centre = centreOf(state, agent, herd.tuning.legLength);
  return creature;
}

reference::Step Moment::stepOf(const HerdState& state, size_t leg) const {
  reference::Step step = validation::stepOf(state, leg);
  step.firstTick /= static_cast<double>(span);
  step.duration /= static_cast<double>(span);
  return step;
}

const Setting& Replay::settingFor(const HerdState& after, size_t agent, crowd::StageId stage, uint64_t span) {
  const bool isHurt = !after.hurt.empty();
  if (span == 1 && !isHurt) return setting_;
  const auto [found, isNew] = made_.try_emplace(span, setting_);
  Setting& made = found->second;
  if (isNew && span > 1) {
    const auto ticks = static_cast<int>(span);
    made.tuning = reference::overTicks(setting_.tuning, ticks);
    made.ik = reference::overTicks(setting_.ik, ticks);
    if (made.forage) made.forage->tuning = reference::overTicks(setting_.forage->tuning, ticks);
  }
  if (!isHurt) return made;
  made.creature = hurtCreatureOf(setting_, after, agent);
  if (stage != crowd::StageId::react && !after.reaction.empty())
    made.creature = reference::reactingCreature(setting_.tuning, made.creature, reactionOf(after, agent),
                                                bodyOf(after, agent).orientation);
  return made;
}

Replay::Replay(const HerdFacts& herd, std::vector<crowd::StageId> only)
    : terrain_(herd.terrain), setting_(settingOf(herd, terrain_)), only_(std::move(only)) {
  for (const Check* check : checksOf(herd.controller, only_))
    judges_.emplace_back(nameOf(check->stage), herd.firstAgent);
}

void Replay::tick(uint64_t n, const HerdState& before, const HerdState& after, const Surroundings& around) {
  if (before.agents != after.agents) {
    throw inputError("replay: found " + std::to_string(after.agents) + " agents after the tick, expected " +
                     std::to_string(before.agents));
  }
  expectSizes(setting_, before);
  expectSizes(setting_, after);
  const std::vector<const Check*> checks = checksOf(setting_.controller, only_);
  if (leftOut_.empty()) leftOut_.assign(checks.size(), true);
  for (size_t c = 0; c < checks.size(); ++c) {
    const Check& check = *checks[c];
    if (isLeftOut(check.stage, before, after)) continue;
    leftOut_[c] = false;
    for (const Record record : check.writes)
      if (after.agents > 0 && crowd::infoOf(record).kept == crowd::Kept::bound && after.of(record).empty())
        throw inputError(std::string("replay: found no ") + crowd::infoOf(record).name + " records");
    if (check.stage == crowd::StageId::navigate && std::exchange(waysAreNew_, false))
      for (const reference::WayField& field : setting_.ways)
        judges_[c].add(n, before.sample.first, -1, compareWay(field));
    if (check.stage == crowd::StageId::navigate && setting_.forage)
      checkTrail(setting_, n, before, after, judges_[c]);
    const std::vector<Record> early = writtenOfSleepers(check.stage);
    for (size_t agent = 0; agent < before.agents; ++agent) {
      const bool isOver = check.stage != crowd::StageId::measure;  // the agents' own ticks; measure has all
      const uint64_t span = isOver ? spanOf(after, agent) : 1;
      const Moment moment{n, before, after, agent, around, span};
      const bool ticks = (!isOver || hasTurn(n, after, agent)) &&
                         (check.stage != crowd::StageId::avoid || looksAround(setting_, moment));
      const bool asleep = asleepOf(after, agent) || !ticks;
      if (!ticks && !early.empty()) {
        for (const Record record : early) checkKept(setting_, moment, record, judges_[c]);
        continue;
      }
      // Nobody is there: measure adds nothing.
      if (check.stage == crowd::StageId::measure && bodyOf(after, agent).absent) {
        checkKept(setting_, moment, Record::metric, judges_[c]);
        continue;
      }
      if (!asleep || check.writes.empty())
        check.check(settingFor(after, agent, check.stage, span), moment, judges_[c]);
      if (!asleep) continue;
      const auto push = check.stage == crowd::StageId::react ? pushOf(after, agent, n) : std::nullopt;
      if (push) {
        checkPushed(settingFor(after, agent, check.stage, span), moment, *push, judges_[c]);
        continue;
      }
      for (const Record record : check.writes) checkKept(setting_, moment, record, judges_[c]);
    }
  }
}

void Replay::edit(uint32_t x0, uint32_t z0, uint32_t columns, uint32_t rows, std::span<const float> heights) {
  for (uint32_t z = 0; z < rows; ++z)
    for (uint32_t x = 0; x < columns; ++x)
      terrain_.heights[size_t{z0 + z} * terrain_.columns + x0 + x] = heights[size_t{z} * columns + x];
}

std::vector<StageResult> Replay::results() const {
  std::vector<StageResult> results;
  for (size_t s = 0; s < judges_.size(); ++s)
    if (leftOut_.empty() || !leftOut_[s]) results.push_back(judges_[s].result());
  return results;
}

bool Replay::pass() const {
  const std::vector<StageResult> all = results();
  return std::all_of(all.begin(), all.end(), [](const StageResult& result) { return result.pass; });
}

bool Replay::hasRefused() const {
  return std::ranges::any_of(judges_, [](const Judge& judge) { return judge.hasRefused(); });
}

std::vector<CheckedStage> checkedStages(Controller controller) {
  std::vector<CheckedStage> stages;
  for (const Check* check : checksOf(controller)) stages.push_back({check->stage, check->writes});
  return stages;
}

std::string table(const std::vector<StageResult>& results) {
  std::string text = "stage        samples       kept   max error   tolerance    ties  result\n";
  for (const StageResult& result : results) {
    char line[160];
    std::snprintf(line, sizeof line, "%-10s %9llu  %9llu  %10.3g  %10.3g  %6llu  %s\n", result.name.c_str(),
                  static_cast<unsigned long long>(result.samples),
                  static_cast<unsigned long long>(result.kept), result.maxError, result.tolerance,
                  static_cast<unsigned long long>(result.ties), result.pass ? "pass" : "FAIL");
    text += line;
    if (!result.pass) text += "           " + result.why + "\n";
  }
  return text;
}

}  // namespace skitter::validation
