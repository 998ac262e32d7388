#include "cpu_reference/stages/react.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cpu_reference/heightfield.h"

namespace skitter::reference {
namespace {

constexpr size_t fewestThatFall = 3;
constexpr double leastPendulum = 0.25;  // of bodyHeight

// One tick of one agent.
class Reacting {
 public:
  Reacting(const Tuning& tuning, const Heights& heights, const Creature& creature, const AgentBody& body,
           const Reaction& before, ReactFlips flips)
      : tuning_(tuning),
        heights_(heights),
        creature_(creature),
        body_(body),
        rotation_(glm::mat3_cast(body.orientation)),
        flips_(flips),
        next_(before) {
    result_.margins.fill(std::numeric_limits<double>::infinity());
  }

  void disturb(std::span<const Step> steps, std::span<const double> misses, double tick,
               const std::optional<glm::dvec2>& push, WatchedGround watched, uint32_t idleBefore) {
    bool disturbed = push.has_value();
    if (push) next_.velocity += *push / (1 + creature_.load);
    double lost = -std::numeric_limits<double>::infinity();
    for (size_t l = 0; l < steps.size(); ++l) {
      const bool carries = creature_.limbs[l].carries;
      const bool planted = steps[l].progress(tick - 1) >= 1;
      carriers_ += carries;
      standing_ += carries && planted;
      if (carries && !planted) air_ |= 1u << l;
      if (carries && planted) planted_ |= 1u << l;
      disturbed = disturbed || (!carries && (idleBefore >> l & 1u) == 0);
      if (!carries || !planted) continue;
      disturbed = disturbed || misses[l] > tuning_.slipMiss;
      if (watched == nullptr) continue;
      const glm::dvec3 landing = steps[l].relative(steps[l].landing, body_);
      const glm::dvec2 at = body_.world() + glm::dvec2(landing.x, landing.z);
      const double below = body_.y + landing.y - heightAt(*watched, at.x, at.y);
      lost = std::max(lost, below - tuning_.groundTolerance);
    }
    if (std::isfinite(lost) && decide(ReactDecision::losesGround, lost)) disturbed = true;
    next_.disturbed = disturbed ? tuning_.disturbTime : std::max(0.0, next_.disturbed - tuning_.dt);
  }

  void stand() {
    const double fade = pendulumTime(tuning_, creature_.centre);
    const glm::dvec2 velocity = body_.speed * body_.heading + next_.velocity;
    const glm::dvec3 off = rotation_ * creature_.centre;
    const bool held = isCaught(velocity * fade + glm::dvec2(off.x, off.z)) || next_.disturbed <= 0;
    const double counted = tuning_.dt / tuning_.ticks;
    next_.over = held ? 0 : next_.over + counted;
    next_.clock += tuning_.dt;
    next_.fold = 0;
    const bool rises = next_.phase == ReactionPhase::rising;
    double left = 0;
    if (rises) {
      const double share =
          carriers_ > 0 ? static_cast<double>(standing_) / static_cast<double>(carriers_) : 1;
      left = next_.drop - share * tuning_.dt * height() / tuning_.riseTime;
      next_.drop = std::max(0.0, left);
      next_.down += tuning_.dt;
    }
    if (next_.over > 0 && decide(ReactDecision::falls, next_.over - tuning_.fallTime + counted / 2))
      return fall(velocity);
    if (held) next_.velocity /= 1 + tuning_.dt / fade;
    const double rest = glm::length(next_.velocity);
    if (rest == 0 || !decide(ReactDecision::isFree, rest - tuning_.steadySpeed)) next_.velocity = {0, 0};
    next_.velocity = withinEdges(next_.velocity);
    if (rises) {
      const bool ready = 2 * standing_ >= carriers_;
      if (!ready || !decide(ReactDecision::hasRisen, -left)) return;
      next_.drop = 0;
      next_.stands += 1;
      next_.downBefore += next_.down;
      next_.down = 0;
    }
    const bool calm = next_.disturbed <= 0 && next_.velocity == glm::dvec2(0);
    enter(calm ? ReactionPhase::steady : ReactionPhase::stumbling);
  }

  void tumble() {
    next_.ground = normalized(glm::mix(next_.ground, groundBelow(), tuning_.tiltBlend));
    const glm::dvec3& n = next_.ground;
    if (next_.over > 0) {
      next_.velocity += tuning_.dt * tuning_.gravity * n.y * glm::dvec2(n.x, n.z);
      const double speed = glm::length(next_.velocity);
      const double lost = tuning_.dt * tuning_.slideFriction * tuning_.gravity * n.y;
      next_.velocity *= std::max(0.0, 1 - lost / std::max(speed, 1e-6));
    }
    next_.velocity = withinEdges(next_.velocity);

    const double goal = next_.phase == ReactionPhase::righting ? 0 : tuning_.lieAngle;
    const double spring = tuning_.tumbleRate;
    next_.tiltRate = (next_.tiltRate + tuning_.dt * spring * spring * (goal - next_.tilt)) /
                     (1 + 2 * tuning_.tumbleDamping * spring * tuning_.dt);
    next_.tilt = std::clamp(next_.tilt + tuning_.dt * next_.tiltRate, 0.0, tuning_.tiltMost);
    result_.frame = tippedFrame(n, body_.heading, next_.way, next_.tilt);

    const double here = hullFloor(body_.world());
    double floor = hullFloor(body_.world() + tuning_.dt * next_.velocity);
    const double steepest = tuning_.wallSlope * glm::length(next_.velocity) * tuning_.dt + tuning_.wallLeast;
    if (decide(ReactDecision::isBlocked, floor - here - steepest)) {
      next_.velocity = {0, 0};
      floor = here;
    }
    const double falling = std::min(next_.sink, 0.0) - tuning_.gravity * tuning_.dt;
    const double resting = (floor - body_.y) / tuning_.dt;
    next_.sink = std::max(falling, resting);
    const bool touches = decide(ReactDecision::touches, (resting - falling) * tuning_.dt);
    next_.over = touches ? 1 : 0;
    next_.fold = std::min(1.0, next_.fold + tuning_.dt / tuning_.foldTime);
    next_.clock += tuning_.dt;
    next_.down += tuning_.dt;
    comeToRest(touches);
  }

  ReactResult result() {
    result_.reaction = next_;
    return result_;
  }
  bool isFallen() const { return next_.isFallen(); }

 private:
  bool decide(ReactDecision decision, double above) {
    const auto d = static_cast<size_t>(decision);
    result_.margins[d] = std::abs(above);
    return (above >= 0) != ((flips_ >> d & 1u) != 0);
  }

  double height() const { return std::max(0.0, tuning_.bodyHeight - tuning_.bellyClearance); }

  bool isCaught(const glm::dvec2& ahead) {
    if (carriers_ < fewestThatFall) return true;
    const glm::dvec3 centre = tuning_.bodyHeight * rotation_[1];
    double nearest = std::numeric_limits<double>::infinity();
    for (size_t l = 0; l < creature_.limbs.size(); ++l) {
      const Limb& limb = creature_.limbs[l];
      const bool flies = (air_ >> l & 1u) != 0, stands = (planted_ >> l & 1u) != 0;
      if (!flies && !(stands && (limb.neighbours & air_) == 0)) continue;
      const glm::dvec3 home = rotation_ * limb.home - centre;
      const glm::dvec2 spoke(home.x, home.z);
      const double t = std::clamp(glm::dot(ahead, spoke) / std::max(glm::dot(spoke, spoke), 1e-12), 0.0, 1.0);
      nearest = std::min(nearest, glm::length(ahead - t * spoke));
    }
    if (!std::isfinite(nearest)) return false;
    return decide(ReactDecision::isCaught, tuning_.halfStrideMax - nearest);
  }

  glm::dvec2 withinEdges(glm::dvec2 velocity) const {
    const glm::dvec2 extent{tuning_.halfExtentX, tuning_.halfExtentZ}, at = body_.world();
    for (int axis = 0; axis < 2; ++axis) {
      if (velocity[axis] > 0)
        velocity[axis] = std::min(velocity[axis], std::max(0.0, extent[axis] - at[axis]) / tuning_.dt);
      else
        velocity[axis] = std::max(velocity[axis], std::min(0.0, -extent[axis] - at[axis]) / tuning_.dt);
    }
    return velocity;
  }

  void fall(const glm::dvec2& velocity) {
    const double speed = glm::length(velocity);
    if (next_.phase != ReactionPhase::rising) {
      next_.falls += 1;
      next_.down = 0;
    }
    Reaction fallen = next_;
    fallen.phase = ReactionPhase::falling;
    fallen.clock = fallen.over = fallen.sink = fallen.drop = fallen.tilt = fallen.fold = 0;
    fallen.velocity = velocity;
    fallen.way =
        speed < tuning_.steadySpeed ? glm::dvec2(body_.heading.y, -body_.heading.x) : velocity / speed;
    fallen.tiltRate = std::min(speed / tuning_.bodyHeight, 2 * tuning_.tumbleRate * tuning_.lieAngle);
    fallen.ground = rotation_[1];
    next_ = fallen;
  }

  // The up axis of the ground around the hull's middle.
  glm::dvec3 groundBelow() {
    const double r = tuning_.bodyRadius;
    const glm::dvec2 middle = body_.world() + tuning_.bodyHeight * glm::dvec2(rotation_[1].x, rotation_[1].z);
    const auto fallAlong = [&](const glm::dvec2& way) { return look(middle - way) - look(middle + way); };
    return normalized(glm::dvec3(fallAlong({r, 0}), 2 * r, fallAlong({0, r})));
  }

  double look(const glm::dvec2& at) {
    if (result_.lookups < result_.looked.size()) result_.looked[result_.lookups++] = at;
    return heightAt(heights_, at.x, at.y);
  }

  double hullFloor(const glm::dvec2& at) {
    double floor = -std::numeric_limits<double>::infinity();
    for (int k = -1; k <= 1; ++k) {
      const glm::dvec3 q = result_.frame * glm::dvec3(0, tuning_.bodyHeight, k * tuning_.bodyRadius);
      floor = std::max(floor, look(at + glm::dvec2(q.x, q.z)) + tuning_.bellyClearance - q.y);
    }
    return floor;
  }

  void comeToRest(bool touches) {
    using enum ReactionPhase;
    const auto isSlow = [&] {
      return touches && decide(ReactDecision::isSlow, tuning_.restSpeed - glm::length(next_.velocity));
    };
    switch (next_.phase) {
      case falling:
        if (isSlow() && decide(ReactDecision::isCalm, tuning_.restRate - std::abs(next_.tiltRate)))
          return enter(lying);
        return;
      case lying:
        if (!isSlow()) return enter(falling);
        if (decide(ReactDecision::hasLain, next_.clock - tuning_.lieTime + tuning_.dt / 2)) enter(righting);
        return;
      default:
        if (!touches || !decide(ReactDecision::isUpright, tuning_.uprightTilt - next_.tilt)) return;
        next_.drop = height();
        next_.over = 0;
        enter(rising);
    }
  }

  void enter(ReactionPhase phase) {
    if (phase != next_.phase) next_.clock = 0;
    next_.phase = phase;
  }

  const Tuning& tuning_;
  const Heights& heights_;
  const Creature& creature_;
  const AgentBody& body_;
  glm::dmat3 rotation_;
  ReactFlips flips_;
  Reaction next_;
  ReactResult result_;
  size_t carriers_ = 0, standing_ = 0;
  uint32_t air_ = 0, planted_ = 0;
};

}  // namespace

double pendulumTime(const Tuning& tuning, const glm::dvec3& centre) {
  const double height = std::max(tuning.bodyHeight + centre.y, leastPendulum * tuning.bodyHeight);
  return std::sqrt(height / tuning.gravity);
}

Reaction pushed(const Tuning& tuning, const Creature& creature, const Reaction& before,
                const glm::dvec2& push) {
  Reaction after = before;
  after.velocity += push / (1 + creature.load);
  after.disturbed = tuning.disturbTime;
  return after;
}

ReactResult react(const Tuning& tuning, const Heights& heights, const Creature& creature,
                  const AgentBody& body, const Reaction& before, std::span<const Step> steps,
                  std::span<const double> misses, double tick, const std::optional<glm::dvec2>& push,
                  WatchedGround watched, uint32_t idleBefore, ReactFlips flips) {
  Reacting reacting(tuning, heights, creature, body, before, flips);
  reacting.disturb(steps, misses, tick, push, watched, idleBefore);
  if (!reacting.isFallen()) reacting.stand();
  if (reacting.isFallen()) reacting.tumble();
  return reacting.result();
}

glm::dmat3 tippedFrame(const glm::dvec3& up, const glm::dvec2& heading, const glm::dvec2& way, double tilt) {
  const glm::dvec3 forward =
      normalized(glm::dvec3(heading.x, -(up.x * heading.x + up.z * heading.y) / up.y, heading.y));
  const glm::dvec3 level(way.x, 0, way.y);
  const glm::dvec3 toward = normalized(level - glm::dot(level, up) * up);
  const glm::dvec3 axis = glm::cross(up, toward);
  const Turn turn(tilt);
  const auto tip = [&](const glm::dvec3& a) {
    return turn.cosine * a + turn.sine * glm::cross(axis, a) + (1 - turn.cosine) * glm::dot(axis, a) * axis;
  };
  return {tip(glm::cross(up, forward)), tip(up), tip(forward)};
}

AgentBody looseBody(const Tuning& tuning, const AgentBody& previous, const Reaction& reaction) {
  AgentBody body = previous;
  body.orientation =
      glm::quat_cast(tippedFrame(reaction.ground, previous.heading, reaction.way, reaction.tilt));
  if (glm::dot(body.orientation, previous.orientation) < 0) body.orientation = -body.orientation;
  body.localX += reaction.velocity.x * tuning.dt;
  body.localZ += reaction.velocity.y * tuning.dt;
  body.y += reaction.sink * tuning.dt;
  const double overX = std::floor(body.localX / tileSize), overZ = std::floor(body.localZ / tileSize);
  body.tileX += overX;
  body.tileZ += overZ;
  body.localX -= overX * tileSize;
  body.localZ -= overZ * tileSize;
  body.speed = body.turnRate = body.still = body.surfaceSpeed = 0;
  body.follow = tuning.followLeast;
  return body;
}

Creature reactingCreature(const Tuning& tuning, const Creature& hurt, const Reaction& reaction,
                          const glm::dquat& orientation) {
  Creature creature = hurt;
  creature.reaction = reaction;
  if (reaction.isFallen()) {
    for (Limb& limb : creature.limbs) {
      limb.folds = limb.carries;
      limb.carries = false;
    }
    return creature;
  }
  const glm::dvec3 velocity =
      glm::conjugate(orientation) * glm::dvec3(reaction.velocity.x, 0, reaction.velocity.y);
  const glm::dvec3 ahead = pendulumTime(tuning, hurt.centre) * glm::dvec3(velocity.x, 0, velocity.z);
  creature.shift += ahead;
  for (Limb& limb : creature.limbs) limb.home += ahead;
  return creature;
}

Foot foldedFoot(const Tuning& tuning, const Heights& heights, const glm::dvec3& root, const glm::dvec3& home,
                const AgentBody& body, const Foot& foot, double fold) {
  const glm::dvec3 share(tuning.foldAside, tuning.foldBelow, tuning.foldAside);
  Foot folded;
  folded.target = glm::mix(foot.target, body.orientation * (root + share * (home - root)), fold);
  const glm::dvec2 at = body.world() + glm::dvec2(folded.target.x, folded.target.z);
  folded.target.y =
      std::max(folded.target.y, heightAt(heights, at.x, at.y) + fold * tuning.stepClearance - body.y);
  folded.progress = 0;
  return folded;
}

}  // namespace skitter::reference
