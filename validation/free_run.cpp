#include "validation/free_run.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <optional>
#include <span>
#include <utility>

#include "cpu_reference/stages/adapt.h"
#include "cpu_reference/stages/body.h"
#include "cpu_reference/stages/clip.h"
#include "cpu_reference/stages/foothold.h"
#include "cpu_reference/stages/gait.h"
#include "cpu_reference/stages/gait_key_poses.h"
#include "cpu_reference/stages/gait_loop.h"
#include "cpu_reference/stages/hurt.h"
#include "cpu_reference/stages/ik.h"
#include "cpu_reference/stages/navigate.h"
#include "cpu_reference/stages/pose.h"
#include "cpu_reference/stages/pose_clip.h"
#include "cpu_reference/stages/react.h"
#include "cpu_reference/stages/swing.h"
#include "cpu_reference/stages/swing_clip.h"
#include "cpu_reference/stages/swing_loop.h"
#include "cpu_reference/stages/swing_planted.h"
#include "crowd/record.h"
#include "validation/convert.h"
#include "validation/convert_clip.h"

namespace skitter::validation {
namespace {

// A tick of one agent, a member a stage; what a stage reads it reads from the records.
class Walk {
 public:
  Walk(const Setting& setting, uint64_t tick, size_t agent, HerdState& state)
      : setting_(setting),
        tuning_(setting.tuning),
        hurtCreature_(setting.creature),
        ownCreature_(setting.creature),
        tick_(tick),
        n_(static_cast<double>(tick)),
        agent_(agent),
        legs_(static_cast<size_t>(setting.legs)),
        state_(state) {}

  void all() {
    if (navigate()) return;
    if (!state_.search.empty()) adapt();
    if (!state_.hurt.empty()) hurtCreature_ = ownCreature_ = hurtCreatureOf(setting_, state_, agent_);
    switch (setting_.controller) {
      case Controller::adaptive:
        return adaptive();
      case Controller::loop:
        return loop();
      case Controller::clip:
        return clip();
      case Controller::planted:
        return planted();
      case Controller::keyPoses:
        return keyPoses();
    }
  }

 private:
  void adaptive() {
    const uint32_t idleBefore = gait().idle;
    const std::vector<reference::Step> before = stepsBefore();
    const std::vector<double> misses = missesBefore();
    const bool reacts = !state_.reaction.empty();
    const reference::WatchedGround ground = state_.watched ? &setting_.heights : nullptr;
    if (reacts) {
      putReaction(state_, agent_,
                  reference::react(tuning_, setting_.heights, creature_, body(), reactionOf(state_, agent_),
                                   before, misses, n_, pushOf(state_, agent_, tick_), ground, idleBefore)
                      .reaction);
      ownCreature_ = reactingCreature(body());
    }
    const bool loose = reacts && creature_.reaction->isLoose();
    if (loose) putBody(state_, agent_, reference::looseBody(tuning_, body(), *creature_.reaction));
    if (!loose)
      putBody(state_, agent_,
              reference::body(tuning_, setting_.heights, creature_, body(), desiredOf(state_, agent_), before,
                              misses, n_, gait().phase)
                  .body);
    if (reacts) ownCreature_ = reactingCreature(body());  // whose homes are ahead of the new body
    putGait(
        state_, agent_,
        reference::gait(tuning_, creature_, body(), gait().phase, before, misses, n_, {}, ground, idleBefore)
            .gait);
    for (size_t l = 0; l < legs_; ++l) {
      step(l, before[l]);
      putFoot(state_, leg(l), footOfStep(l));
      solve(l);
    }
    pose();
  }

  reference::Creature reactingCreature(const reference::AgentBody& at) const {
    return reference::reactingCreature(tuning_, hurtCreature_, reactionOf(state_, agent_), at.orientation);
  }

  reference::Foot footOfStep(size_t l) const {
    if (!limb(l).carries && !limb(l).folds) return reference::idleFoot();
    const reference::Foot foot = reference::swing(stepOf(state_, leg(l)), body(), n_);
    if (!limb(l).folds) return foot;
    return reference::foldedFoot(tuning_, setting_.heights, limb(l).root, limb(l).home - creature_.shift,
                                 body(), foot, creature_.reaction->fold);
  }

  void loop() {
    blindBody();
    putGait(
        state_, agent_,
        reference::loopGait(tuning_, creature_.groups, body(), gait().phase, {}, creature_.slowest()).gait);
    for (size_t l = 0; l < legs_; ++l) {
      putFoot(state_, leg(l),
              limb(l).carries ? reference::loopSwing(tuning_, creature_.groups, limb(l), body(), gait()).foot
                              : reference::idleFoot());
      solve(l);
    }
    pose();
  }

  void clip() {
    blindBody();
    play();
    for (size_t l = 0; l < legs_; ++l) {
      const reference::ClipFoot swung = reference::clipSwing(setting_.clips, limb(l), l, body(), played());
      putFoot(state_, leg(l), swung.foot);
      putChain(state_, leg(l), setting_.bones, swung.chain);
    }
    for (size_t joint = 0; joint < joints(); ++joint)
      putMatrix(state_, agent_ * joints() + joint,
                reference::clipPose(setting_.clips, body(), played(), joint));
  }

  void planted() {
    blindBody();
    play();
    for (size_t l = 0; l < legs_; ++l) plantLeg(l);
    for (size_t joint = 0; joint < joints(); ++joint) {
      putMatrix(state_, agent_ * joints() + joint, plantedJoint(joint));
    }
  }

  reference::Affine plantedJoint(size_t joint) const {
    const reference::ClipTable::BoneOf& owner = setting_.clips.bones[joint];
    if (owner.leg < 0) return reference::plantedPose(setting_.clips, body(), played(), joint, {});
    const auto l = static_cast<size_t>(owner.leg), bone = static_cast<size_t>(owner.bone);
    const size_t left = limb(l).left;
    const FixRecord record = fixOf(state_, leg(l), setting_.bones, static_cast<int>(std::min(bone, left)));
    const reference::BoneFix fix{glm::mat3_cast(record.turn), record.move};
    return bone >= left ? reference::stumpPose(setting_.clips, body(), played(), l, left, fix)
                        : reference::plantedPose(setting_.clips, body(), played(), joint, fix);
  }

  void keyPoses() {
    blindBody();
    const double phase = reference::wheelPhase(tuning_, setting_.keyPoses.stride, body(), gait().phase);
    reference::Gait wheel;
    wheel.phase = phase;
    putGait(state_, agent_, wheel);
    for (size_t l = 0; l < legs_; ++l) {
      const reference::SprungLeg sprung = reference::poseSwing(
          tuning_, setting_.keyPoses, limb(l), l, body(), gait().phase,
          chainOf(state_, leg(l), setting_.bones).directions, springOf(state_, leg(l), setting_.bones));
      putFoot(state_, leg(l), sprung.foot);
      putChain(state_, leg(l), setting_.bones, sprung.chain);
      putSpring(state_, leg(l), setting_.bones, sprung.rates);
    }
    pose();
  }

  // Whether the agent sleeps.
  bool navigate() {
    const reference::Rest rest{.gait = gait(),
                               .allowed = state_.sleep,
                               .edited = state_.watched,
                               .breathes = setting_.controller == Controller::adaptive};
    const auto way = reference::navigate(tuning_, body(), goalOf(state_, agent_), rest, {}, setting_.ways,
                                         setting_.wayPlaces);
    putGoal(state_, agent_, way.goal);
    putSteer(state_, agent_, way.desired, way.asleep);
    return way.asleep;
  }
  // Body, feet and chains are still those of the last tick.
  void adapt() {
    std::vector<reference::Foot> feet;
    std::vector<reference::Chain> chains;
    for (size_t l = 0; l < legs_; ++l) {
      feet.push_back(footOf(state_, leg(l)));
      chains.push_back(chainOf(state_, leg(l), setting_.bones));
    }
    const reference::AdaptResult adapted = reference::adapt(
        tuning_, setting_.gaitMap, searchOf(state_, agent_), hurtOf(state_, agent_, setting_.legs), body(),
        feet, chains, desiredOf(state_, agent_));
    putSearch(state_, agent_, adapted.search);
    putHurtGait(state_, agent_, adapted.hurt);
  }
  void blindBody() {
    putBody(
        state_, agent_,
        reference::blindBody(tuning_, setting_.heights, creature_, body(), desiredOf(state_, agent_)).body);
  }
  void play() { putPlay(state_, agent_, reference::clip(tuning_, setting_.clips, body(), played()).play); }
  // foothold, of a leg that gait has listed.
  void step(size_t l, const reference::Step& before) {
    const bool lifts = (gait().lift >> l & 1u) != 0, reaims = (gait().reaim >> l & 1u) != 0;
    if (!lifts && !reaims) return;
    std::optional<glm::dvec3> hanging;
    if (lifts && reaims) hanging = held(l).tip;
    putStep(state_, leg(l),
            reference::foothold(tuning_, setting_.heights, limb(l), body(), gait(), before, lifts, n_, {},
                                hanging)
                .step);
  }
  reference::Chain held(size_t l) const {
    return reference::heldLeg(limb(l), body(), chainOf(state_, leg(l), setting_.bones));
  }
  void solve(size_t l) {
    if (!limb(l).carries && !limb(l).folds) return putChain(state_, leg(l), setting_.bones, held(l));
    const reference::Chain chain = reference::ik(tuning_, limb(l), body(), footOf(state_, leg(l)),
                                                 chainOf(state_, leg(l), setting_.bones), setting_.ik);
    putChain(state_, leg(l), setting_.bones, chain);
    putMiss(state_, agent_, l, setting_.legs, tick_, chain.miss);
  }
  // swing and ik of planted.
  void plantLeg(size_t l) {
    const reference::ClipLeg clipLeg = reference::clipLeg(setting_.clips, limb(l), l, played());
    const reference::PlantedFoot swung =
        limb(l).carries ? reference::plantedSwing(tuning_, setting_.heights, body(), clipLeg.joints.back(),
                                                  clipLeg.stands, plantOf(state_, leg(l)))
                        : reference::idlePlantedFoot(plantOf(state_, leg(l)));
    putFoot(state_, leg(l), swung.foot);
    putPlant(state_, leg(l), swung.plant);
    putStart(state_, leg(l), setting_.bones, {clipLeg.directions, clipLeg.joints.front()});
    const reference::PlantedStart start = startOf(state_, leg(l), setting_.bones);
    const reference::Chain chain =
        limb(l).carries
            ? reference::plantedIk(tuning_, limb(l), body(), footOf(state_, leg(l)), start, setting_.ik)
            : reference::heldLeg(reference::plantedLimb(limb(l), start), body(),
                                 chainOf(state_, leg(l), setting_.bones));
    putChain(state_, leg(l), setting_.bones, chain);
    const auto fixes = reference::boneFixes(reference::plantedLimb(limb(l), start), start,
                                            chainOf(state_, leg(l), setting_.bones).directions);
    for (size_t b = 0; b < fixes.size(); ++b)
      putFix(state_, leg(l), setting_.bones, static_cast<int>(b), fixes[b]);
  }
  void pose() {
    const size_t bones = static_cast<size_t>(setting_.bones), entry = agent_ * (1 + legs_ * bones);
    putBone(state_, entry, reference::bodyPose(body()));
    for (size_t l = 0; l < legs_; ++l) {
      const auto posed = reference::pose(limb(l), body(), chainOf(state_, leg(l), setting_.bones).directions);
      for (size_t b = 0; b < bones; ++b) putBone(state_, entry + 1 + l * bones + b, posed[b]);
    }
  }

  std::vector<reference::Step> stepsBefore() const {
    std::vector<reference::Step> steps;
    for (size_t l = 0; l < legs_; ++l) steps.push_back(stepOf(state_, leg(l)));
    return steps;
  }
  std::vector<double> missesBefore() const {
    std::vector<double> misses;
    for (size_t l = 0; l < legs_; ++l) misses.push_back(missOf(state_, agent_, l, setting_.legs, tick_ - 1));
    return misses;
  }
  reference::AgentBody body() const { return bodyOf(state_, agent_); }
  reference::Gait gait() const { return gaitOf(state_, agent_); }
  reference::Play played() const { return playOf(state_, agent_, setting_.clips); }
  const reference::Limb& limb(size_t l) const { return creature_.limbs[l]; }
  size_t leg(size_t l) const { return agent_ * legs_ + l; }
  size_t joints() const { return setting_.clips.joints(); }

  const Setting& setting_;
  const reference::Tuning& tuning_;
  reference::Creature hurtCreature_;
  reference::Creature ownCreature_;  // as react leaves it
  const reference::Creature& creature_ = ownCreature_;
  uint64_t tick_;
  double n_;
  size_t agent_, legs_;
  HerdState& state_;
};

}  // namespace

void walkAgent(const Setting& setting, uint64_t n, size_t agent, HerdState& state) {
  Walk(setting, n, agent, state).all();
}

FreeRun::FreeRun(const HerdFacts& herd, HerdState start)
    : setting_(settingOf(herd, herd.terrain)), state_(std::move(start)) {}

void FreeRun::tick(bool watched) {
  ++state_.tick;
  state_.watched = watched;
  for (size_t agent = 0; agent < state_.agents; ++agent) walkAgent(setting_, state_.tick, agent, state_);
}

void FreeRun::follow(const HerdState& before, const HerdState& after) {
  for (size_t agent = 0; agent < state_.agents; ++agent) {
    const auto recordOf = [&](auto& state, Record record) {
      auto& all = state.of(record);
      const size_t floats = all.size() / state_.agents;
      return std::span(all).subspan(agent * floats, floats);
    };
    const auto differs = [&](Record record) {
      return !std::ranges::equal(recordOf(before, record), recordOf(after, record));
    };
    const bool isElsewhere = differs(Record::body);
    for (const Record record : allRecords) {
      if (crowd::infoOf(record).per == crowd::Per::watched) continue;
      if (isElsewhere || differs(record))
        std::ranges::copy(recordOf(after, record), recordOf(state_, record).begin());
    }
  }
}

double FreeRun::shareWithin(const HerdState& device, double tolerance) const {
  const double most = tolerance * setting_.tuning.legLength;
  const size_t legs = static_cast<size_t>(setting_.legs);
  size_t within = 0, present = 0;
  for (size_t agent = 0; agent < state_.agents; ++agent) {
    const reference::AgentBody here = bodyOf(state_, agent), there = bodyOf(device, agent);
    if (there.absent) continue;
    ++present;
    const glm::dvec2 apart = there.world() - here.world();
    const glm::dvec3 moved(apart.x, there.y - here.y, apart.y);
    bool close = glm::length(moved) <= most;
    for (size_t l = agent * legs; l < (agent + 1) * legs; ++l)
      close = close && glm::length(footOf(device, l).target + moved - footOf(state_, l).target) <= most;
    within += close ? 1 : 0;
  }
  return present > 0 ? static_cast<double>(within) / static_cast<double>(present) : 1;
}

}  // namespace skitter::validation
