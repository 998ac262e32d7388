#include "reference_herd.h"

#include "shared/ik_batch.h"

#include <cmath>

#include "cpu_reference/heightfield.h"
#include "cpu_reference/stages/measure.h"
#include "crowd/record.h"
#include "gait_maps.h"
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
  HerdFacts facts{rig_, terrain_, parameters_, rigRecords_, ik};
  facts.gaitMap = gaitMap_;
  return facts;
}

Replay ReferenceHerd::replay() const { return Replay(facts()); }

void ReferenceHerd::adapt(const reference::GaitMap& map) {
  gaitMap_ = recordsOf(map);
  for (const Record record : {Record::hurt, Record::carried, Record::search}) make(record);
  const reference::Creature creature = creatureOf(rigRecords_, legs(), bones_, rig_.groupCount());
  reference::Hurt whole;
  whole.groups = creature.groups;
  for (const reference::Limb& limb : creature.limbs)
    whole.legs.push_back({.group = limb.group, .lag = limb.lag, .neighbours = limb.neighbours});
  for (size_t agent = 0; agent < state_.agents; ++agent) putHurtGait(state_, agent, whole);
}

void ReferenceHerd::make(Record record) {
  const int each = crowd::infoOf(record).per == crowd::Per::leg ? legs() : 1;
  const int stride = crowd::strideOf(record, legs(), bones_, 0);
  state_.of(record).resize(4 * size_t{state_.agents} * static_cast<size_t>(each * stride));
}

void ReferenceHerd::spawn(uint32_t agents) {
  const size_t count = agents, legCount = static_cast<size_t>(legs());
  state_.agents = agents;
  for (const Record record : allRecords)
    if (crowd::infoOf(record).kept == crowd::Kept::always) make(record);
  for (const CheckedStage& stage : checkedStages(Controller::adaptive))
    if (stage.stage != crowd::StageId::react && stage.stage != crowd::StageId::adapt)
      for (const Record record : stage.writes) make(record);
  make(Record::metric);
  make(Record::watch);

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
    chains.push_back(validation::chainOf(state_, leg, bones_));
  }
  const reference::Creature creature =
      state_.hurt.empty() ? setting.creature : hurtCreatureOf(setting, state_, agent);
  const auto measured =
      reference::measure(setting.tuning, setting.heights, creature, bodyOf(state_, agent), feet, chains,
                         state_.tick - 1, watchedOf(state_, agent, legs()), metricOf(state_, agent));
  putMetric(state_, agent, measured.metric);
  putWatched(state_, agent, measured.watched);
}

}  // namespace skitter::test
