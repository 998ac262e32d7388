#include "reference_herd.h"

#include "shared/ik_batch.h"

#include <cmath>

#include "cpu_reference/heightfield.h"
#include "cpu_reference/stages/measure.h"
#include "skitter/records.h"
#include "validation/convert.h"
#include "validation/free_run.h"

namespace skitter::test {

using namespace validation;

ReferenceHerd::ReferenceHerd(const Heightfield& terrain, uint32_t agents, int padding)
    : rig_(spider()),
      terrain_(terrain),
      parameters_(parametersFor(terrain)),
      rigRecords_(rigRecordsOf(rig_, padding)),
      bones_(4 + padding) {
  // A rig whose longest leg has the padded length, so that the others are padded.
  for (int i = 0; i < padding; ++i) rig_.legs[0].bones.push_back(Bone{});
  spawn(agents);
}

HerdFacts ReferenceHerd::facts() const {
  const crowd::IkPlan ik{shared::SOLVER_FABRIK, plan.approachIterations, plan.polishIterations};
  return {rig_, terrain_, parameters_, rigRecords_, ik};
}

Replay ReferenceHerd::replay() const { return Replay(facts()); }

void ReferenceHerd::spawn(uint32_t agents) {
  const size_t count = agents, legCount = static_cast<size_t>(legs());
  const size_t chain = static_cast<size_t>(shared::chainStride(bones_));
  state_.agents = agents;
  state_.goal.resize(4 * count * shared::GOAL_STRIDE);
  state_.steer.resize(4 * count * shared::STEER_STRIDE);
  state_.body.resize(4 * count * shared::BODY_STRIDE);
  state_.gait.resize(4 * count * shared::GAIT_STRIDE);
  state_.step.resize(4 * count * legCount * shared::STEP_STRIDE);
  state_.arc.resize(4 * count * legCount * shared::ARC_STRIDE);
  state_.foot.resize(4 * count * legCount * shared::FOOT_STRIDE);
  state_.chain.resize(4 * count * legCount * chain);
  state_.tip.resize(4 * count * legCount * shared::TIP_STRIDE);
  state_.miss.resize(4 * count * static_cast<size_t>(shared::missStride(legs())));
  state_.pose.resize(4 * count * (1 + legCount * static_cast<size_t>(bones_)) * shared::POSE_STRIDE);
  state_.metric.resize(4 * count * shared::METRIC_STRIDE);
  state_.watch.resize(4 * count * static_cast<size_t>(shared::watchStride(legs())));

  const reference::Heights heights = heightsOf(terrain_, parameters_);
  const reference::Creature creature = creatureOf(rigRecords_, legs(), bones_, rig_.groupCount());
  for (size_t agent = 0; agent < count; ++agent) {
    // A sunflower: places and ways in all directions, crossing the field's middle.
    const double turned = 2.399963 * static_cast<double>(agent);
    const double away = 2 + 1.1 * std::sqrt(static_cast<double>(agent));
    const double x = away * std::cos(turned), z = away * std::sin(turned);
    reference::AgentBody body = bodyAt(x, z, reference::heightAt(heights, x, z));
    const double facing = 1.7 * static_cast<double>(agent);
    body.heading = {std::sin(facing), std::cos(facing)};
    body.orientation = glm::angleAxis(std::remainder(facing, 6.283185307179586), glm::dvec3(0, 1, 0));
    putBody(state_, agent, body);
    body = bodyOf(state_, agent);
    reference::Goal goal{
        {-x, -z}, {x, z}, 0.3 + 0.2 * static_cast<double>(agent % 8), 0.3, reference::GoalKind::cross};
    if (agent % 7 == 3) goal.kind = reference::GoalKind::point;
    if (agent % 7 == 5) goal.kind = reference::GoalKind::none;
    putGoal(state_, agent, goal);
    reference::Gait gait;
    gait.phase = std::fmod(0.37 * static_cast<double>(agent), 1);
    putGait(state_, agent, gait);
    for (size_t l = 0; l < legCount; ++l) {
      glm::dvec3 home = body.orientation * creature.limbs[l].home;
      const glm::dvec2 world = body.world();
      home.y = reference::heightAt(heights, world.x + home.x, world.y + home.z) - body.y;
      putStep(state_, agent * legCount + l, plantedAt(body, home));
      reference::Chain rest;
      rest.directions.resize(static_cast<size_t>(bones_));
      putChain(state_, agent * legCount + l, bones_, rest);
    }
  }
}

void ReferenceHerd::tick() {
  ++state_.tick;
  for (size_t agent = 0; agent < state_.agents; ++agent) tickAgent(agent);
}

void ReferenceHerd::tickAgent(size_t agent) {
  const Setting setting = settingOf(facts(), terrain_);
  walkAgent(setting, state_.tick, agent, state_);
  std::vector<reference::Foot> feet;
  std::vector<reference::Chain> chains;
  for (size_t l = 0; l < static_cast<size_t>(legs()); ++l) {
    const size_t leg = agent * static_cast<size_t>(legs()) + l;
    feet.push_back(footOf(state_, leg));
    chains.push_back(chainOf(state_, leg, bones_));
  }
  const auto measured =
      reference::measure(setting.tuning, setting.heights, setting.creature, bodyOf(state_, agent), feet,
                         chains, state_.tick - 1, watchedOf(state_, agent, legs()), metricOf(state_, agent));
  putMetric(state_, agent, measured.metric);
  putWatched(state_, agent, measured.watched);
}

}  // namespace skitter::test
