#include "crowd/tuning.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "shared/ik_batch.h"
#include "skitter/error.h"

namespace skitter::crowd {
namespace {

// Each may take as long as the approach and the polish of the plan that ships.
constexpr int kComparedIterations = 4;

// A solver's number in shaders.
constexpr int numberOf(Solver solver) { return static_cast<int>(solver); }
static_assert(numberOf(Solver::fabrik) == shared::SOLVER_FABRIK);
static_assert(numberOf(Solver::activeSet) == shared::SOLVER_ACTIVE_SET);

// E of a tick; damping below 1.
void setSpring(shared::Parameters& p, float frequency, float damping) {
  p.springFrequency = frequency;
  p.springDamping = damping;
  const double decay = double{damping} * frequency;
  const double swing = std::sqrt(double{frequency} * frequency - decay * decay);
  const double fade = std::exp(-decay * p.dt);
  const double c = fade * std::cos(swing * p.dt), s = fade * std::sin(swing * p.dt) / swing;
  p.springKeep = static_cast<float>(c + decay * s);
  p.springDrift = static_cast<float>(s);
  p.springPull = static_cast<float>(-double{frequency} * frequency * s);
  p.springCarry = static_cast<float>(c - decay * s);
}

}  // namespace

IkPlan ikPlanFor(Solver solver) {
  if (solver == Solver::activeSet) return {shared::SOLVER_FABRIK, 4, 2};
  if (std::find(herdSolvers.begin(), herdSolvers.end(), solver) == herdSolvers.end())
    throw inputError(
        fmt::format("a herd's solver is {}, expected one of {}", nameOf(solver), namesOf(herdSolvers)));
  return {numberOf(solver), kComparedIterations, 0};
}

// Each value says its unit, and what breaks when it is wrong. L is the leg length.
shared::Parameters tuningFor(const Rig& rig, const IkPlan& ik, const Heightfield& terrain, float dt) {
  const float length = rig.legLength;
  shared::Parameters p{};
  p.dt = dt;
  p.legLength = length;
  for (const Leg& leg : rig.legs) p.homeRadius = std::max(p.homeRadius, std::hypot(leg.home.x, leg.home.z));
  p.bodyHeight = rig.bodyHeight;
  p.bodyRadius = rig.bodyRadius;

  p.originX = terrain.originX();
  p.originZ = terrain.originZ();
  p.inverseSpacingX = 1 / terrain.spacingX;
  p.inverseSpacingZ = 1 / terrain.spacingZ;
  p.halfExtentX = terrain.extentX() / 2;
  p.halfExtentZ = terrain.extentZ() / 2;

  p.edgeMargin = std::min(2 * length, 0.2f * std::min(terrain.extentX(), terrain.extentZ()));
  p.slowRadius = length;

  p.acceleration = 2.5f * length;  // m/s^2; more, and the feet are left behind at the start
  p.braking = 6 * length;          // m/s^2; less, and stretched legs are pulled off the ground
  p.turnRate = 1.5f;               // rad/s; more, and the outer feet cross before their group may step
  p.turnAcceleration = 8;          // rad/s^2
  p.turnGain = 4;                  // 1/s
  p.stretchSlow = 0.93f;           // of the reach
  p.stretchStop = 1.0f;            // of the reach; beyond 1 a planted foot would be torn off
  p.errorStop = 0.02f;             // of the reach
  p.followLeast = 0.1f;            // 0, and a body whose feet find no hold stands before a wall for ever
  p.heightBlend = 1 - std::exp(-dt / 0.10f);  // seconds; less bounces over every foothold, more lags in dips
  p.tiltBlend = 1 - std::exp(-dt / 0.15f);
  p.maxSlope = 2.75f;  // 70 degrees
  p.bellyClearance = 0.6f * rig.bodyHeight;
  p.ridge = 1e-4f * length * length;
  p.leanGain = 0.06f / length;  // s^2/m; 0.1 L is what a pendulum does
  p.leanMost = 0.12f;           // 7 degrees
  p.leanLevel = 0.08f;          // more, and legs on the low side stretch on steep ground
  p.breathHeight = 0.012f * length;

  p.halfStrideStill = 0.08f * length;  // less, and feet fidget at rest
  p.halfStrideMax = 0.30f * length;    // more, and side legs leave their reach
  p.dutyStill = 0.75f;                 // spiders: falling linearly with speed (Spagna et al. 2011)
  p.dutyGain = 0.05f / length;         // s/m
  p.dutyLeast = 0.55f;                 // less, and neighbours have no time to take turns
  p.lagShare = 1.2f;                   // over 1 groups overlap; far more, and neighbours wait for each other
  p.swingStill = 0.35f;                // s
  p.swingSpeed = 1.7f * length;        // m/s
  p.cycleMax = 1.2f;                   // s; longer, and a standing leg reacts too late to a start
  p.windowSlack = 1.1f;                // less, and a leg's landing delays its neighbours
  p.windowOpen = 0.5f;                 // of the window; more, and late lifts disturb the rhythm
  p.liftShare = 0.35f;                 // of the half stride; less, and feet fidget at low speed
  p.stretchLift = 0.95f;               // of the reach
  p.strayShare = 1.8f;                 // of the half stride; less, and a steady walk would trip over it
  p.errorLift = 1e-3f;                 // of the reach
  p.rootShare = 0.25f;                 // of the reach
  p.settleTime = 1;                    // s
  p.sleepTime = 2;                     // s; the last steps are over, and the joints at rest
  p.reaimDistance = 0.15f * length;    // less than a ladder's spacing, and steps are re-aimed for nothing
  p.reaimLatest = 0.7f;
  p.groundTolerance = 0.02f * length;  // less, and rounding of heights far from 0 would lift feet

  p.reachMost = 0.95f;  // of the reach: IK converges sublinearly beyond
  p.reachLeast = 0.30f;
  p.reachComfort = 0.85f;
  p.slopeLeast = 0.35f;  // cosine: 70 degrees from the body's up
  p.slopeWeight = 0.05f;
  p.reachWeight = 4;
  p.nearestOnly = 0;

  p.stepHeight = 0.12f * length;
  p.stepClearance = 0.03f * length;
  p.stepHeightMax = 0.5f * length;
  p.routeWidth = 0.08f * length;  // two to each side; more, and a leg swings through its neighbours

  p.clipFade = dt / 0.25f;  // seconds
  p.clipIdle = 0.05f * length;
  p.clipHysteresis = 0.25f;
  p.clipRateMost = 2.5f;  // more, and legs blur
  p.plantStray = 0.35f * length;
  p.plantKeep = std::exp(-dt / 0.08f);  // seconds; less snaps, more lands off the clip's place

  p.poseWalk = 0.1f * length;  // m/s; more, and the first steps are too short for the way
  // rad/s, and the damping that leaves slow movements as large as they are (Butterworth); slower softens the
  // poses, faster shows the keys.
  setSpring(p, 45, std::sqrt(0.5f));

  p.approachError = 0.25f;  // of the reach; less, and FABRIK bends a tracked leg more than it need be
  p.restPull = 0.05f;       // a step; more, and it fights the target near the limits
  p.pullError = 0.1f;       // of the reach: about a fast tick; out of reach no pull may act
  p.ikTolerance = 2e-5f;    // of the reach; a planted foot's slide is the sum of such errors
  p.missLeast = 2e-4f;      // of the reach; one planted leg of a thousand misses by more
  // Without a polish the approach goes all the way.
  if (ik.polish == 0) p.approachError = p.ikTolerance;

  p.deadZone = 0.005f * length;
  p.skateSpeed = 0.1f * length;  // m/s
  p.limitDeadZone = 1e-4f;       // radians; a clamped direction is within 1e-6
  p.jerkTicks = std::max(4.0f, std::floor(0.4f / dt + 0.5f));
  p.jerkPath = 0.05f * length;
  return p;
}

}  // namespace skitter::crowd
