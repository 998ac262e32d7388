#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <optional>
#include <vector>

#include "cpu_reference/fields.h"
#include "cpu_reference/limit.h"

// What the stages of docs/stages.md pass to each other, in double precision. Metres, seconds, radians; +Y up,
// a creature faces +Z. "Relative" means relative to the body's position along world axes.
namespace skitter::reference {

// Metres; a body's position is tile * tileSize + local, 0 <= local < tileSize.
inline constexpr double tileSize = 16;

// The tuning values of docs/stages.md, under the names that it uses.
struct Tuning {
  double ticks = 1;  // of the crowd in one of the agent's own, which has the dt
  double dt = 0, legLength = 0, homeRadius = 0, bodyHeight = 0, bodyRadius = 0;
  double halfExtentX = 0, halfExtentZ = 0;
  double edgeMargin = 0, slowRadius = 0;
  double acceleration = 0, braking = 0, turnRate = 0, turnAcceleration = 0, turnGain = 0;
  double stretchSlow = 0, stretchStop = 0, errorStop = 0, followLeast = 0, heightBlend = 0, tiltBlend = 0,
         maxSlope = 0;
  double bellyClearance = 0, ridge = 0;
  double sinkMost = 0, riseMost = 0, climbMost = 0, gapMost = 0;
  double leanGain = 0, leanMost = 0, leanLevel = 0, breathHeight = 0;
  double halfStrideStill = 0, halfStrideMax = 0, swingStill = 0, swingSpeed = 0;
  double dutyStill = 0, dutyGain = 0, dutyLeast = 0, lagShare = 0;
  double cycleMax = 0, windowSlack = 0, windowOpen = 0, liftShare = 0, stretchLift = 0, strayShare = 0;
  double errorLift = 0, rootShare = 0, missLeast = 0;
  double settleTime = 0, sleepTime = 0, reaimDistance = 0, reaimLatest = 0, groundTolerance = 0;
  bool reachTriggered = false;
  double reachMost = 0, reachLeast = 0, reachComfort = 0, slopeLeast = 0, slopeWeight = 0, reachWeight = 0;
  bool nearestOnly = false;
  double stepHeight = 0, stepClearance = 0, stepHeightMax = 0, routeWidth = 0;
  double clipFade = 0, clipIdle = 0, clipHysteresis = 0, clipRateMost = 0, plantStray = 0, plantKeep = 0;
  double poseWalk = 0, springFrequency = 0, springDamping = 0;
  double approachError = 0, restPull = 0, pullError = 0, ikTolerance = 0;
  double fallTime = 0, slideFriction = 0, lieTime = 0, riseTime = 0;
  double gravity = 0, disturbTime = 0, slipMiss = 0, steadySpeed = 0, tumbleRate = 0, tumbleDamping = 0;
  double lieAngle = 0, tiltMost = 0, uprightTilt = 0, restSpeed = 0, restRate = 0, wallSlope = 0;
  double wallLeast = 0, foldTime = 0, foldAside = 0, foldBelow = 0;
  double deadZone = 0, skateSpeed = 0, limitDeadZone = 0, jerkTicks = 24, jerkPath = 0;
};

// Samples of a heightfield, row after row; owned by the caller.
struct Heights {
  const float* samples = nullptr;
  int columns = 0, rows = 0;
  double originX = 0, originZ = 0;                  // world position of column 0, row 0
  double inverseSpacingX = 0, inverseSpacingZ = 0;  // samples a metre
};

struct BoneRest : Limit {
  glm::dmat3 frame{1};        // B_i, model space
  glm::dvec3 along{0, 0, 1};  // o_i: the bone in its frame; other than z for a hinge that it is not square to
  double length = 0;          // share of the limb's reach; 0 pads a short limb
  glm::dvec3 start{0};        // p_i at rest, model space
  double stiffness = 0;       // of the rest pull

  glm::dvec3 direction() const { return frame * along; }  // r_i
};

struct Limb {
  glm::dvec3 root{0}, home{0};  // model space
  double reach = 0;             // metres
  double group = 0;             // whole, but for a gait that was found for a hurt creature
  double lag = 0;               // in its group: 0 lifts first, 1 last
  uint32_t neighbours = 0;      // bit m: leg m must stand while this one is in the air
  std::vector<BoneRest> bones;
  // These differ for a leg that is hurt (cpu_reference/stages/hurt.h).
  bool carries = true, lost = false;
  bool folds = false;      // of a fallen agent: it does not carry, and is solved all the same
  size_t left = SIZE_MAX;  // bones from the root on that it has left
  double slowness = 1;     // how many times as long as others its step lasts

  double stepTicks(double duration) const { return std::floor(slowness * duration + 0.5); }
};

enum class ReactionPhase { steady, stumbling, falling, lying, righting, rising };

#define REFERENCE_MEMBER(type, name, initial, place, roundings) type name = initial;
struct Reaction {
  SKITTER_REACTION_FIELDS(REFERENCE_MEMBER)
  ReactionPhase phase = ReactionPhase::steady;

  bool isFallen() const { return phase >= ReactionPhase::falling && phase <= ReactionPhase::righting; }
  // It does not stand on its legs, not even as it begins to rise.
  bool isLoose() const { return isFallen() || (phase == ReactionPhase::rising && clock == 0); }
};

struct Creature {
  std::vector<Limb> limbs;
  int groups = 0;
  // Where legs are hurt or it reacts: how far its homes are from the rig's, model space, and its share of the
  // speed.
  glm::dvec3 shift{0};
  double speed = 1;
  double load = 0;       // the mass that it carries, times its own
  glm::dvec3 centre{0};  // from its own centre of mass to that of both, model space
  // Where it reacts (cpu_reference/stages/react.h).
  std::optional<Reaction> reaction = {};

  // A push makes the feet go faster by so much, m/s.
  double hurry() const { return reaction && !reaction->isFallen() ? glm::length(reaction->velocity) : 0; }
  bool stumbles() const { return reaction && reaction->phase == ReactionPhase::stumbling; }

  double slowest() const {
    double most = 1;
    for (const Limb& limb : limbs) most = limb.carries ? std::max(most, limb.slowness) : most;
    return most;
  }
};

enum class GoalKind { none, point, cross, velocity, series };

struct Goal {
  SKITTER_GOAL_FIELDS(REFERENCE_MEMBER)
  GoalKind kind = GoalKind::none;
};

struct AgentBody {
  double tileX = 0, tileZ = 0;
  SKITTER_BODY_FIELDS(REFERENCE_MEMBER)
  bool absent = false;  // nobody is in this place

  glm::dvec2 world() const { return {tileX * tileSize + localX, tileZ * tileSize + localZ}; }
  // v_e: how fast the feet must go, turning included.
  double pace(const Tuning& tuning) const { return surfaceSpeed + std::abs(turnRate) * tuning.homeRadius; }
};

struct Gait {
  SKITTER_GAIT_FIELDS(REFERENCE_MEMBER)
  uint32_t idle = 0;  // legs that do not carry, where they can be hurt
};

// Positions are local to the tile in x and z, world in y.
struct Step {
  double tileX = 0, tileZ = 0;
  SKITTER_STEP_FIELDS(REFERENCE_MEMBER)
  SKITTER_ARC_FIELDS(REFERENCE_MEMBER)
  double duration = 1;  // ticks; negative: the landing is a last resort

  // Progress u in [0, 1] at the end of a tick; 1 is stance.
  double progress(double tick) const { return glm::clamp((tick - firstTick) / std::abs(duration), 0.0, 1.0); }
  // A point of this step relative to a body.
  glm::dvec3 relative(const glm::dvec3& point, const AgentBody& body) const {
    return {(tileX - body.tileX) * tileSize + (point.x - body.localX), point.y - body.y,
            (tileZ - body.tileZ) * tileSize + (point.z - body.localZ)};
  }
};

struct Foot {
  SKITTER_FOOT_FIELDS(REFERENCE_MEMBER)
};

struct Chain {
  std::vector<glm::dvec2> directions;  // (d.x, d.y) / (1 + d.z) of each bone in its frame B_i
  SKITTER_TIP_FIELDS(REFERENCE_MEMBER)
  double miss = 0;  // of a planted foot, share of the reach; 0 up to missLeast
};

struct BonePose {
  SKITTER_POSE_FIELDS(REFERENCE_MEMBER)
  bool lost = false;  // all of its skin is at its position
};

// Sums over the ticks in which an agent was watched; metres and radians.
struct Metric {
  SKITTER_METRIC_FIELDS(REFERENCE_MEMBER)
  double largestViolation = 0;
};

// normalize(v) = v / sqrt(max(|v|^2, 1e-20))
template <typename Vector>
Vector normalized(const Vector& v) {
  return v / std::sqrt(std::max(glm::dot(v, v), 1e-20));
}

// Cayley form of a rotation by about `angle`: its cosine and sine, without trigonometry.
struct Turn {
  explicit Turn(double angle) {
    const double t = angle / 2;
    cosine = (1 - t * t) / (1 + t * t);
    sine = 2 * t / (1 + t * t);
  }
  glm::dvec3 operator()(const glm::dvec3& v) const {
    return {cosine * v.x + sine * v.z, v.y, cosine * v.z - sine * v.x};
  }
  double cosine, sine;
};

}  // namespace skitter::reference
