#include "validation/free_run.h"

#include <glm/geometric.hpp>
#include <utility>

#include "cpu_reference/body.h"
#include "cpu_reference/foothold.h"
#include "cpu_reference/gait.h"
#include "cpu_reference/ik.h"
#include "cpu_reference/navigate.h"
#include "cpu_reference/pose.h"
#include "cpu_reference/swing.h"
#include "skitter/error.h"
#include "validation/convert.h"

namespace skitter::validation {

void walkAgent(const Setting& setting, uint64_t tick, size_t agent, HerdState& state) {
  const reference::Tuning& tuning = setting.tuning;
  const reference::Creature& creature = setting.creature;
  const double n = static_cast<double>(tick);
  const size_t legs = static_cast<size_t>(setting.legs), bones = static_cast<size_t>(setting.bones);
  const size_t first = agent * legs, entry = agent * (1 + legs * bones);

  const reference::Rest rest{
      .gait = gaitOf(state, agent), .allowed = state.sleep, .edited = state.watched, .breathes = true};
  const auto way = reference::navigate(tuning, bodyOf(state, agent), goalOf(state, agent), rest);
  putGoal(state, agent, way.goal);
  putSteer(state, agent, way.desired, way.asleep);
  if (way.asleep) return;

  std::vector<reference::Step> steps;
  std::vector<double> misses;
  for (size_t l = 0; l < legs; ++l) {
    steps.push_back(stepOf(state, first + l));
    misses.push_back(missOf(state, agent, l, setting.legs, tick - 1));
  }
  putBody(state, agent,
          reference::body(tuning, setting.heights, creature, bodyOf(state, agent), desiredOf(state, agent),
                          steps, misses, n, gaitOf(state, agent).phase)
              .body);
  const reference::AgentBody body = bodyOf(state, agent);
  putGait(state, agent,
          reference::gait(tuning, creature, body, gaitOf(state, agent).phase, steps, misses, n).gait);
  const reference::Gait gait = gaitOf(state, agent);

  putBone(state, entry, reference::bodyPose(body));
  for (size_t l = 0; l < legs; ++l) {
    const reference::Limb& limb = creature.limbs[l];
    const size_t leg = first + l;
    const bool lifts = (gait.lift >> l & 1u) != 0;
    if (lifts || (gait.reaim >> l & 1u) != 0)
      putStep(state, leg,
              reference::foothold(tuning, setting.heights, limb, body, gait, steps[l], lifts, n).step);
    putFoot(state, leg, reference::swing(stepOf(state, leg), body, n));
    const reference::Chain chain =
        reference::ik(tuning, limb, body, footOf(state, leg), chainOf(state, leg, setting.bones), setting.ik);
    putChain(state, leg, setting.bones, chain);
    putMiss(state, agent, l, setting.legs, tick, chain.miss);
    const auto posed = reference::pose(limb, body, chainOf(state, leg, setting.bones).directions);
    for (size_t b = 0; b < bones; ++b) putBone(state, entry + 1 + l * bones + b, posed[b]);
  }
}

FreeRun::FreeRun(const HerdFacts& herd, HerdState start)
    : terrain_(herd.terrain), setting_(settingOf(herd, terrain_)), state_(std::move(start)) {
  if (herd.controller != crowd::Controller::adaptive)
    throw inputError("a free run is of adaptive herds alone");
}

void FreeRun::tick() {
  ++state_.tick;
  for (size_t agent = 0; agent < state_.agents; ++agent) walkAgent(setting_, state_.tick, agent, state_);
}

double FreeRun::shareWithin(const HerdState& device, double tolerance) const {
  const double most = tolerance * setting_.tuning.legLength;
  const size_t legs = static_cast<size_t>(setting_.legs);
  size_t within = 0;
  for (size_t agent = 0; agent < state_.agents; ++agent) {
    const reference::AgentBody here = bodyOf(state_, agent), there = bodyOf(device, agent);
    const glm::dvec2 apart = there.world() - here.world();
    const glm::dvec3 moved(apart.x, there.y - here.y, apart.y);
    bool close = glm::length(moved) <= most;
    for (size_t l = agent * legs; l < (agent + 1) * legs; ++l)
      close = close && glm::length(footOf(device, l).target + moved - footOf(state_, l).target) <= most;
    within += close ? 1 : 0;
  }
  return state_.agents > 0 ? static_cast<double>(within) / static_cast<double>(state_.agents) : 1;
}

}  // namespace skitter::validation
