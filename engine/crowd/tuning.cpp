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

// In metres where the unit has a length.
float scaled(float value, TuningUnit unit, const Rig& rig) {
  switch (unit) {
    case TuningUnit::legLengths:
    case TuningUnit::legLengthsPerSecond:
    case TuningUnit::legLengthsPerSecond2:
      return value * rig.legLength;
    case TuningUnit::legLengths2:
      return value * rig.legLength * rig.legLength;
    case TuningUnit::secondsPerLegLength:
    case TuningUnit::seconds2PerLegLength:
      return value / rig.legLength;
    case TuningUnit::bodyHeights:
      return value * rig.bodyHeight;
    default:
      return value;
  }
}

// E of a tick; damping below 1.
void setSpring(shared::Parameters& p) {
  const float frequency = p.springFrequency, damping = p.springDamping;
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

shared::Parameters tuningFor(const Tuning& tuning, const Rig& rig, const IkPlan& ik,
                             const Heightfield& terrain, float dt) {
  shared::Parameters p{};
#define SET_TUNED(name, unit, usual) p.name = scaled(tuning.name, TuningUnit::unit, rig);
#define SET_FIXED(name, unit, value) p.name = scaled(static_cast<float>(value), TuningUnit::unit, rig);
  TUNED_PARAMETERS(SET_TUNED)
  FIXED_PARAMETERS(SET_FIXED)
#undef SET_FIXED
#undef SET_TUNED

  p.dt = dt;
  p.legLength = rig.legLength;
  for (const Leg& leg : rig.legs) p.homeRadius = std::max(p.homeRadius, std::hypot(leg.home.x, leg.home.z));
  p.bodyHeight = rig.bodyHeight;
  p.bodyRadius = rig.bodyRadius;

  p.originX = terrain.originX();
  p.originZ = terrain.originZ();
  p.inverseSpacingX = 1 / terrain.spacingX;
  p.inverseSpacingZ = 1 / terrain.spacingZ;
  p.halfExtentX = terrain.extentX() / 2;
  p.halfExtentZ = terrain.extentZ() / 2;
  p.edgeMargin = std::min(p.edgeMargin, 0.2f * std::min(terrain.extentX(), terrain.extentZ()));

  p.heightBlend = 1 - std::exp(-dt / tuning.heightTime);
  p.tiltBlend = 1 - std::exp(-dt / tuning.tiltTime);
  p.clipFade = dt / tuning.fadeTime;
  p.plantKeep = std::exp(-dt / tuning.plantTime);
  setSpring(p);
  p.jerkTicks = std::max(4.0f, std::floor(0.4f / dt + 0.5f));
  // Without a polish the approach goes all the way.
  if (ik.polish == 0) p.approachError = p.ikTolerance;
  return p;
}

}  // namespace skitter::crowd
