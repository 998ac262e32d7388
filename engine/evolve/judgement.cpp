#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "crowd/herd.h"
#include "crowd/regait.h"
#include "evolve/trials.h"
#include "skitter/error.h"
#include "skitter/evolve.h"

namespace skitter {
namespace {

constexpr double judgedSide = 72;  // leg lengths
constexpr double mostJudged = 20;  // seconds that the ground has room for
constexpr uint32_t ticksAtOnce = 64;

double worldZOf(const HerdState& state, size_t agent) {
  const float* body = &state.body[agent * 4 * shared::BODY_STRIDE];
  return double{body[2]} + double{shared::TILE_SIZE} * double{shared::tileZ(body[3])};
}

void checkJudgement(const Rig& rig, std::span<const uint32_t> patterns, double seconds, float dt) {
  if (!(seconds > 0 && seconds <= mostJudged))
    throw inputError(
        fmt::format("seconds of a judgement is {}, expected more than 0, up to {}", seconds, mostJudged));
  if (!(dt >= EvolutionOptions::minDt && dt <= EvolutionOptions::maxDt))
    throw inputError(fmt::format("dt of a judgement is {}, expected {:.4g} to {:.4g} s", dt,
                                 EvolutionOptions::minDt, EvolutionOptions::maxDt));
  for (const uint32_t idle : patterns)
    if (idle >> rig.legs.size() != 0)
      throw inputError(
          fmt::format("pattern of a judgement is {:#x}, expected a mask of {} legs", idle, rig.legs.size()));
}

// The rig's own gait, in which nobody waits for a leg that does not carry.
crowd::Regait unadapted(const Rig& rig, const Tuning& tuning, uint32_t idle) {
  crowd::Regait gait = crowd::regaitByRule(rig, tuning, {});
  for (crowd::LegTurn& turn : gait.legs) turn.neighbours &= ~idle;
  return gait;
}

std::vector<GaitJudgement> judged(Device& device, const Rig& rig, std::span<const uint32_t> patterns,
                                  double seconds, float dt, bool adapts) {
  checkJudgement(rig, patterns, seconds, dt);
  if (patterns.empty()) return {};
  Rig walker = evolve::bareRig(rig);
  walker.gaits = rig.gaits;
  CrowdOptions options{.pose = false, .watchEvery = 1};
  options.rigs = {walker};
  Crowd crowd(device, evolve::flatGround(rig, judgedSide),
              evolve::walkOf(rig, static_cast<uint32_t>(patterns.size()), Evolution::wantedSpeed), options);
  if (!adapts) {
    crowd::Kind& kind = implOf(crowd).kinds.front();
    for (const uint32_t idle : patterns)
      kind.regaits.emplace(crowd::LegPattern{.idle = idle}, unadapted(kind.rig, kind.tuning, idle));
  }
  std::vector<AgentLeg> legs;
  for (uint32_t agent = 0; agent < patterns.size(); ++agent)
    for (uint32_t leg = 0; leg < rig.legs.size(); ++leg)
      if ((patterns[agent] >> leg & 1u) != 0)
        legs.push_back({crowd.agentId(0, agent), leg, LegState::lost, 1u});
  crowd.hurt(legs);
  const HerdState before = crowd.download(0);
  const auto ticks = static_cast<uint32_t>(std::lround(seconds / double{dt}));
  for (uint32_t done = 0; done < ticks; done += ticksAtOnce)
    device.run([&](VkCommandBuffer cmd) {
      for (uint32_t tick = done; tick < std::min(ticks, done + ticksAtOnce); ++tick) crowd.record(cmd, dt);
    });
  const HerdState after = crowd.download(0);
  const std::vector<Fidelity> fidelity = crowd.agentFidelity(0);
  std::vector<GaitJudgement> all;
  for (size_t agent = 0; agent < patterns.size(); ++agent) {
    const double way = worldZOf(after, agent) - worldZOf(before, agent);
    all.push_back({.idle = patterns[agent],
                   .speed = way / (double{rig.legLength} * ticks * double{dt}),
                   .unstable = fidelity[agent].unstable,
                   .margin = fidelity[agent].margin,
                   .slip = fidelity[agent].slip,
                   .reachError = fidelity[agent].reachErrorMost});
  }
  return all;
}

}  // namespace

std::vector<GaitJudgement> judgeGaits(Device& device, const Rig& rig, std::span<const uint32_t> patterns,
                                      double seconds, float dt) {
  return judged(device, rig, patterns, seconds, dt, true);
}

std::vector<GaitJudgement> judgeUnadapted(Device& device, const Rig& rig, std::span<const uint32_t> patterns,
                                          double seconds, float dt) {
  return judged(device, rig, patterns, seconds, dt, false);
}

}  // namespace skitter
